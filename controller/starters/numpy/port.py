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

import numpy as np

from controller import PROFILES, Controller
from messages import INPUTS, OUTPUTS

NAME = "starter-numpy"
VERSION = "1.0"

CREATE, DESTROY, SET_PARAMETER, STEP, BATCH = 1, 2, 3, 4, 5
OK, UNSUPPORTED, INVALID = 0, 1, 2
MODULE_CONTROLLER = 0

HEADER = struct.Struct("<4I")  # size of the payload, kind, unit, sequence number
RESULT = struct.Struct("<I")
CREATE_HEAD = struct.Struct("<2I")  # module, length of the profile
PARAMETER_HEAD = struct.Struct("<f")  # value
BATCH_HEAD = struct.Struct("<2I")  # request: steps, 0; answer: result, steps done
SAMPLE = np.dtype([("timestamp_sample", "<u8"), ("inputs", INPUTS)])


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

    def outputs_of(self, unit, payload, offset):
        """The outputs of the samples that begin at `offset`, a step for each."""
        samples = np.frombuffer(payload, SAMPLE, offset=offset)
        outputs = np.zeros(len(samples), OUTPUTS)
        for i in range(len(samples)):
            self.units[unit].step(samples[i]["inputs"], outputs[i])
        return outputs

    def step(self, unit, payload):
        return RESULT.pack(OK) + self.outputs_of(unit, payload, 0).tobytes()

    def batch(self, unit, payload):
        outputs = self.outputs_of(unit, payload, BATCH_HEAD.size)
        return BATCH_HEAD.pack(OK, len(outputs)) + outputs.tobytes()

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
    # Inputs may be NaN, infinite or huge. The results are then those of IEEE 754, without warnings.
    np.seterr(all="ignore")
    shake_hands(sys.stdin.buffer, sys.stdout.buffer)
    Program().run(sys.stdin.buffer, sys.stdout.buffer)


if __name__ == "__main__":
    main()
