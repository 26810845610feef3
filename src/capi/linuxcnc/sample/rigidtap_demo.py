#!/usr/bin/env python3
"""Taps M6, 25 mm deep, at four speeds in HAL alone, and prints a line for each hole."""
import sys
import time

import hal

SPEEDS = (1000, 3000, 5000, 7000)
PITCH_MM, DEPTH_MM = 1.0, 25.0
VERDICTS = ("ok", "warning", "fail")

pins = hal.component("rigidtap-demo")
for name in ("pitch", "depth", "speed"):
    pins.newpin(name, hal.HAL_FLOAT, hal.HAL_OUT)
for name in ("error-um", "true-error-um", "deepest", "peak-rpm", "cycle-time"):
    pins.newpin(name, hal.HAL_FLOAT, hal.HAL_IN)
for name in ("alarm", "verdict"):
    pins.newpin(name, hal.HAL_S32, hal.HAL_IN)
pins.newpin("start", hal.HAL_BIT, hal.HAL_OUT)
pins.newpin("finished", hal.HAL_BIT, hal.HAL_IN)
pins.ready()


def wait_until(reached, seconds=10.0):
    end = time.monotonic() + seconds
    while not reached():
        if time.monotonic() > end:
            print("rigidtap-demo: the hole does not end", flush=True)
            sys.exit(1)
        time.sleep(0.005)


pins["pitch"], pins["depth"] = PITCH_MM, DEPTH_MM
# The HAL file connects and starts everything once this component is ready.
time.sleep(1.0)
print("%5s %8s %9s %12s %13s %9s %8s" % ("S", "verdict", "e(k) um", "true e(k) um", "too deep um", "peak rpm", "time s"))
for speed in SPEEDS:
    pins["speed"] = speed
    pins["start"] = True
    wait_until(lambda: pins["finished"])
    verdict = "A%d" % pins["alarm"] if pins["alarm"] else VERDICTS[pins["verdict"]]
    too_deep_um = 1000.0 * (-DEPTH_MM - pins["deepest"])
    print("%5d %8s %9.2f %12.2f %13.2f %9.0f %8.3f" % (
        speed, verdict, pins["error-um"], pins["true-error-um"], too_deep_um, pins["peak-rpm"], pins["cycle-time"]),
        flush=True)
    pins["start"] = False
    wait_until(lambda: not pins["finished"])
    time.sleep(0.1)
