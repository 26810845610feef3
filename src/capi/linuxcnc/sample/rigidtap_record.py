#!/usr/bin/env python3
"""Keeps the record of the hole under way in a file, and offers it after a power cut:  rigidtap_record.py FILE

The file is there from a hole's first synchronous period to its end, whole on the disk before it takes its place. One that is
found at the start is of a hole in which the power left the tap. What the file holds is offered to the component."""
import os
import struct
import sys
import time

import hal

WORDS = 16
PERIOD_S = 0.002


def kept(path):
    """The words of the file; none where there is none of its length."""
    try:
        with open(path, "rb") as file:
            content = file.read()
    except FileNotFoundError:
        return None
    return struct.unpack("<%dI" % WORDS, content) if len(content) == 4 * WORDS else None


def keep(path, words):
    new = path + ".new"
    with open(new, "wb") as file:
        file.write(struct.pack("<%dI" % WORDS, *words))
        file.flush()
        os.fsync(file.fileno())
    os.replace(new, path)
    sync_folder(path)


def forget(path):
    if os.path.exists(path):
        os.remove(path)
        sync_folder(path)


def sync_folder(path):
    folder = os.open(os.path.dirname(os.path.abspath(path)), os.O_RDONLY)
    os.fsync(folder)
    os.close(folder)


def main(path):
    component = hal.component("rigidtap-record")
    names = ["%02d" % word for word in range(WORDS)]
    for name in names:
        component.newpin("record-" + name, hal.HAL_U32, hal.HAL_IN)
        component.newpin("saved-" + name, hal.HAL_U32, hal.HAL_OUT)
    component.newpin("record-valid", hal.HAL_BIT, hal.HAL_IN)
    component.newpin("saved-valid", hal.HAL_BIT, hal.HAL_OUT)

    def offer(words):
        for name, word in zip(names, words or []):
            component["saved-" + name] = word
        component["saved-valid"] = words is not None

    written, was_valid = kept(path), False
    offer(written)
    component.ready()
    while True:
        words = tuple(component["record-" + name] for name in names)
        valid = component["record-valid"]
        if valid and words != written:
            keep(path, words)
            offer(words)
            written = words
        if was_valid and not valid:
            # The hole is over: there is nothing to be led out of.
            forget(path)
            offer(None)
            written = None
        was_valid = valid
        time.sleep(PERIOD_S)


if __name__ == "__main__":
    try:
        main(sys.argv[1] if len(sys.argv) > 1 else "rigidtap.record")
    except KeyboardInterrupt:
        pass
