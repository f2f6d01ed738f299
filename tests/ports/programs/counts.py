#!/usr/bin/env python3
"""The starter in Python, which also counts a made-up cost of each step: it depends on the inputs
only, so it is the same in each run.

    counts.py [--batch] [--cost JSON] [--name NAME] [--slower PERCENT] [--noisy]

--cost is the member of the handshake. --slower makes the steps of large angles dearer. With --noisy
the costs also depend on the number of steps before.
"""

import argparse
import json
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "controller/starters/python"))
sys.dont_write_bytecode = True

import port  # noqa: E402  (the path had to be set first)

COST = port.struct.Struct("<2I")
Q_D = port.struct.Struct("<4f")  # vehicle_attitude_setpoint.q_d


class Counter(port.Program):
    """The requests of the starter, with a cost after each outputs struct."""

    def __init__(self, options):
        super().__init__()
        self.options, self.steps = options, 0

    def cost_of(self, inputs):
        """`inputs`: timestamp_sample, then attest_inputs."""
        self.steps += 1
        cost = 2000 + sum(inputs[16:]) % 191  # without the times
        w = Q_D.unpack_from(inputs, 48)[0]
        if abs(w) < 0.7:  # more than 90 degrees from level
            cost += cost * self.options.slower // 100
        if self.options.noisy:
            cost += self.steps % 7
        return COST.pack(cost, 800 + min(self.steps, 12))

    def step(self, unit, payload):
        return super().step(unit, payload) + self.cost_of(payload)

    def batch(self, unit, payload):
        answer = super().batch(unit, payload)
        head, outputs = port.BATCH_HEAD.size, port.OUTPUTS.size
        counted = answer[:head]
        for i in range((len(answer) - head) // outputs):
            counted += answer[head + i * outputs : head + (i + 1) * outputs]
            counted += self.cost_of(payload[head + i * port.INPUTS.size :][: port.INPUTS.size])
        return counted


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--batch", action="store_true")
    parser.add_argument("--cost", default='{"unit": "cycles", "clock_hz": 25000000}')
    parser.add_argument("--name", default="counts")
    parser.add_argument("--slower", type=int, default=0)
    parser.add_argument("--noisy", action="store_true")
    options = parser.parse_args()
    requests, answers = sys.stdin.buffer, sys.stdout.buffer
    requests.readline()
    hello = {"protocol": 1, "name": options.name, "version": "1", "frames": "binary"}
    hello |= {"profiles": port.PROFILES, "batch": options.batch, "cost": json.loads(options.cost)}
    answers.write(json.dumps(hello).encode() + b"\n")
    answers.flush()
    Counter(options).run(requests, answers)


if __name__ == "__main__":
    main()
