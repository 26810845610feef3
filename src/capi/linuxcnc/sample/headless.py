#!/usr/bin/env python3
"""A display without a display: machine on, homed, then RIGIDTAP_PROGRAM (a file) or RIGIDTAP_MDI (lines) is run."""
import os
import sys
import time

import linuxcnc

command, status, errors = linuxcnc.command(), linuxcnc.stat(), linuxcnc.error_channel()


def tell_errors():
    """Prints what LinuxCNC has to say; whether any of it was an error."""
    failed = False
    while message := errors.poll():
        failed |= message[0] in (linuxcnc.NML_ERROR, linuxcnc.OPERATOR_ERROR)
        print(message[1], flush=True)
    return failed


def wait_until(reached, seconds):
    end = time.monotonic() + seconds
    failed = False
    while True:
        status.poll()
        failed |= tell_errors()
        if reached() or failed:
            return not failed
        if time.monotonic() > end:
            print("headless: LinuxCNC did not get there in %g s" % seconds, flush=True)
            return False
        time.sleep(0.01)


def idle():
    return status.interp_state == linuxcnc.INTERP_IDLE and status.state != linuxcnc.RCS_EXEC


def main():
    command.wait_complete(10)
    command.state(linuxcnc.STATE_ESTOP_RESET)
    command.wait_complete()
    command.state(linuxcnc.STATE_ON)
    command.wait_complete()
    command.mode(linuxcnc.MODE_MANUAL)
    command.wait_complete()
    command.teleop_enable(0)
    command.wait_complete()
    command.home(-1)
    if not wait_until(lambda: all(status.homed[:status.joints]), 10):
        return 1
    seconds = float(os.environ.get("RIGIDTAP_SECONDS", "600"))
    if mdi := os.environ.get("RIGIDTAP_MDI"):
        command.mode(linuxcnc.MODE_MDI)
        command.wait_complete()
        for line in mdi.split(";"):
            command.mdi(line.strip())
            command.wait_complete(seconds)
            if not wait_until(idle, seconds):
                return 1
    if program := os.environ.get("RIGIDTAP_PROGRAM"):
        command.mode(linuxcnc.MODE_AUTO)
        command.wait_complete()
        command.program_open(os.path.abspath(program))
        command.auto(linuxcnc.AUTO_RUN, 0)
        if not wait_until(lambda: status.interp_state != linuxcnc.INTERP_IDLE, 5) or not wait_until(idle, seconds):
            return 1
    print("headless: done", flush=True)
    return 0


sys.exit(main())
