#!/usr/bin/env python3
"""A display that aborts a program in the thread, retracts the tap by one command, and taps again; then switches the machine
off in the thread, and asks where Z is."""
import os
import sys
import time

import linuxcnc

command, status, errors = linuxcnc.command(), linuxcnc.stat(), linuxcnc.error_channel()


def wait_until(reached, seconds=10):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        status.poll()
        if reached():
            return
        time.sleep(0.005)
    print("abort: LinuxCNC did not get there", flush=True)
    sys.exit(1)


def mdi(line):
    command.mode(linuxcnc.MODE_MDI)
    command.wait_complete()
    command.mdi(line)


def idle():
    return status.interp_state == linuxcnc.INTERP_IDLE and status.state != linuxcnc.RCS_EXEC


def busy():
    return status.din[2] != 0


def kept():
    """Bytes of the record in its file; 0 where there is none."""
    time.sleep(0.1)
    return os.path.getsize("rigidtap.record") if os.path.exists("rigidtap.record") else 0


def z_mm():
    return status.joint[2]["input"]


command.wait_complete(10)
for state in (linuxcnc.STATE_ESTOP_RESET, linuxcnc.STATE_ON):
    command.state(state)
    command.wait_complete()
command.mode(linuxcnc.MODE_MANUAL)
command.wait_complete()
command.teleop_enable(0)
command.home(-1)
wait_until(lambda: all(status.homed[: status.joints]))
for line in ("G21 G90 G94 M3 S1000", "G0 Z2"):
    mdi(line)
    command.wait_complete(10)
    wait_until(idle)
time.sleep(0.2)
mdi("G84.2 R2 Z-28 F1000")
wait_until(busy)
time.sleep(0.9)
command.abort()
command.wait_complete()
time.sleep(0.5)
status.poll()
print("abort: held at depth" if busy() else "abort: not held", flush=True)
records = [kept()]
mdi("o<rigidtap_retract> call")
wait_until(lambda: not busy())
wait_until(idle)
print("abort: back at R" if abs(z_mm() - 2.0) < 0.001 else "abort: Z is at %f" % z_mm(), flush=True)
records.append(kept())
mdi("G84.2 R2 Z-28 F1000")
wait_until(busy)
wait_until(lambda: not busy())
wait_until(idle)
mdi("G84.2 R2 Z-28 F1000")
wait_until(busy)
time.sleep(0.9)
command.state(linuxcnc.STATE_OFF)
wait_until(lambda: not busy())
time.sleep(0.1)
status.poll()
left_mm = z_mm()
records.append(kept())
command.state(linuxcnc.STATE_ON)
command.wait_complete()
mdi("G0 X1")
command.wait_complete(10)
wait_until(idle)
status.poll()
known = left_mm < -1.0 and abs(z_mm() - left_mm) < 0.001 and abs(status.actual_position[2] - left_mm) < 0.001
print("abort: Z is known" if known else "abort: Z was at %f, is at %f" % (left_mm, z_mm()), flush=True)
print("abort: record is kept" if records == [64, 0, 64] else "abort: record has %s bytes" % records, flush=True)
print("headless: done", flush=True)
