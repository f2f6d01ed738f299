#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The program: the protocol of `harness/port/PROTOCOL.md`, with binary frames, on stdin and stdout.

A port of another law replaces the units, and keeps this file except for NAME, VERSION and MODULES.
An exception ends the program; attest then reports the last line of the traceback.
"""

import ctypes
import json
import os
import struct
import sys

from attitude_unit import AttitudeUnit
from parameters import PROFILES
from rate_unit import RateUnit

NAME = "starter-python-cascade"
VERSION = "1.0"
# The units of this port by the number of their module. To leave out a unit, delete its row.
MODULES = {
    3: AttitudeUnit,
    4: RateUnit,
}

CREATE, DESTROY, SET_PARAMETER, STEP, BATCH = 1, 2, 3, 4, 5
OK, UNSUPPORTED, INVALID = 0, 1, 2

HEADER = struct.Struct("<4I")  # size of the payload, kind, unit, sequence number
RESULT = struct.Struct("<I")
CREATE_HEAD = struct.Struct("<2I")  # module, length of the profile
PARAMETER_HEAD = struct.Struct("<f")  # value
BATCH_HEAD = struct.Struct("<2I")  # request: steps, 0; answer: result, steps done
SAMPLE_HEAD = struct.Struct("<Q")  # timestamp_sample, which these units have in their inputs


def stepped(unit, payload, offset):
    """The outputs of a step with the inputs at `offset`."""
    outputs = unit.OUTPUTS()
    unit.step(unit.INPUTS.from_buffer_copy(payload, offset + SAMPLE_HEAD.size), outputs)
    return bytes(outputs)


class Program:
    """The units by their number, and a function for each kind of request: it takes the number of
    the unit and the payload of the request, and returns the payload of the answer."""

    def __init__(self):
        self.units = {}
        self.functions = {
            CREATE: self.create,
            DESTROY: self.destroy,
            SET_PARAMETER: self.set_parameter,
            STEP: self.step,
            BATCH: self.batch,
        }

    def create(self, unit, payload):
        module, length = CREATE_HEAD.unpack_from(payload)
        profile = payload[CREATE_HEAD.size : CREATE_HEAD.size + length].decode()
        if module not in MODULES or profile not in PROFILES:
            return RESULT.pack(UNSUPPORTED)
        self.units[unit] = MODULES[module](profile)
        return RESULT.pack(OK)

    def destroy(self, unit, _payload):
        del self.units[unit]
        return RESULT.pack(OK)

    def set_parameter(self, unit, payload):
        (value,) = PARAMETER_HEAD.unpack_from(payload)
        name = payload[PARAMETER_HEAD.size :].decode()
        is_known = self.units[unit].parameters.set(name, value)
        return RESULT.pack(OK if is_known else INVALID)

    def step(self, unit, payload):
        return RESULT.pack(OK) + stepped(self.units[unit], payload, 0)

    def batch(self, unit, payload):
        steps, _ = BATCH_HEAD.unpack_from(payload)
        size = SAMPLE_HEAD.size + ctypes.sizeof(self.units[unit].INPUTS)
        answer = [BATCH_HEAD.pack(OK, steps)]
        for i in range(steps):
            answer.append(stepped(self.units[unit], payload, BATCH_HEAD.size + i * size))
        return b"".join(answer)

    def run(self, requests, answers):
        """Answers requests until their stream ends."""
        while len(header := requests.read(HEADER.size)) == HEADER.size:
            size, kind, unit, sequence = HEADER.unpack(header)
            payload = self.functions[kind](unit, requests.read(size))
            answers.write(HEADER.pack(len(payload), kind, unit, sequence) + payload)
            answers.flush()


def files_of_program():
    """The modules next to this file, as paths from the folder in which the program runs. The hash
    of the port covers them, and attest notices when one of them changes during a run."""
    folder = os.path.dirname(os.path.abspath(__file__))
    files = [getattr(module, "__file__", None) for module in sys.modules.values()]
    own = [file for file in files if file and os.path.dirname(os.path.abspath(file)) == folder]
    return sorted(os.path.relpath(file) for file in own)


def shake_hands(requests, answers):
    if json.loads(requests.readline())["protocol"] != 1:
        sys.exit(f"{NAME} speaks version 1 of the protocol only")
    greeting = {
        "protocol": 1,
        "name": NAME,
        "version": VERSION,
        "profiles": PROFILES,
        "modules": [unit.MODULE for unit in MODULES.values()],
        "frames": "binary",
        "batch": True,
        "files": files_of_program(),
    }
    answers.write(json.dumps(greeting).encode() + b"\n")
    answers.flush()


def main():
    shake_hands(sys.stdin.buffer, sys.stdout.buffer)
    Program().run(sys.stdin.buffer, sys.stdout.buffer)


if __name__ == "__main__":
    main()
