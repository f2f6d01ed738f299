#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The program: the protocol of `harness/port/PROTOCOL.md`, with binary frames, on stdin and stdout.

A port of another law replaces `controller.py`, and keeps this file except for NAME and VERSION.
An exception ends the program; attest then reports the last line of the traceback.
"""

import json
import os
import struct
import sys

from controller import PROFILES, Controller, Inputs
from vector import LARGEST_BINARY32

NAME = "starter-python"
VERSION = "1.0"

CREATE, DESTROY, SET_PARAMETER, STEP, BATCH = 1, 2, 3, 4, 5
OK, UNSUPPORTED, INVALID = 0, 1, 2
MODULE_CONTROLLER = 0

HEADER = struct.Struct("<4I")  # size of the payload, kind, unit, sequence number
RESULT = struct.Struct("<I")
CREATE_HEAD = struct.Struct("<2I")  # module, length of the profile
PARAMETER_HEAD = struct.Struct("<f")  # value
BATCH_HEAD = struct.Struct("<2I")  # request: steps, 0; answer: result, steps done
# timestamp_sample (not needed here), then attest_inputs
INPUTS = struct.Struct("<8x QI 4f 3f 4f3fB3x 4f 4f f 6B B 2B 3B")
OUTPUTS = struct.Struct("<4fB3x 8fB3x 3fB3x")  # attest_outputs


def read_inputs(payload, offset):
    (
        timestamp, updated, qw, qx, qy, qz, p, q, r,
        dw, dx, dy, dz, thrust, yaw_sp_move_rate, landing_gear, disable_mc_yaw_control,
        *rest,
    ) = INPUTS.unpack_from(payload, offset)  # fmt: skip
    return Inputs(
        timestamp,
        updated,
        (qw, qx, qy, qz),
        (p, q, r),
        ((dw, dx, dy, dz), thrust, yaw_sp_move_rate, landing_gear, disable_mc_yaw_control),
        rest[0:4],
        rest[4:8],
        rest[8],
        rest[9:15],
        *rest[15:18],
        rest[18:21],
    )


def as_binary32(value):
    """The value, or infinity if it is too large for binary32."""
    return value if abs(value) <= LARGEST_BINARY32 else value * float("inf")


def write_outputs(answer, offset, outputs):
    rates, rates_published, controls, controls_published, integrals, integrals_published = outputs
    fields = (
        *rates, rates_published, *controls, controls_published, *integrals, integrals_published,
    )  # fmt: skip
    try:
        OUTPUTS.pack_into(answer, offset, *fields)
    except OverflowError:  # `pack` refuses numbers that C would round to infinity
        OUTPUTS.pack_into(answer, offset, *map(as_binary32, fields))


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
        if module != MODULE_CONTROLLER or profile not in PROFILES:
            return RESULT.pack(UNSUPPORTED)
        self.units[unit] = Controller(profile)
        return RESULT.pack(OK)

    def destroy(self, unit, _payload):
        del self.units[unit]
        return RESULT.pack(OK)

    def set_parameter(self, unit, payload):
        (value,) = PARAMETER_HEAD.unpack_from(payload)
        name = payload[PARAMETER_HEAD.size :].decode()
        known = self.units[unit].set_parameter(name, value)
        return RESULT.pack(OK if known else INVALID)

    def step(self, unit, payload):
        answer = bytearray(RESULT.size + OUTPUTS.size)
        RESULT.pack_into(answer, 0, OK)
        write_outputs(answer, RESULT.size, self.units[unit].step(read_inputs(payload, 0)))
        return answer

    def batch(self, unit, payload):
        controller = self.units[unit]
        steps, _ = BATCH_HEAD.unpack_from(payload)
        answer = bytearray(BATCH_HEAD.size + steps * OUTPUTS.size)
        BATCH_HEAD.pack_into(answer, 0, OK, steps)
        for i in range(steps):
            inputs = read_inputs(payload, BATCH_HEAD.size + i * INPUTS.size)
            write_outputs(answer, BATCH_HEAD.size + i * OUTPUTS.size, controller.step(inputs))
        return answer

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
