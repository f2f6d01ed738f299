#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Answers the vectors of the rate law of v1.14 to v1.18 in a folder, as a spreadsheet would.

    rate_law.py DIR

A row of an input file is a call of the law. Writes the file of answers next to each.
"""

import csv
import pathlib
import sys

OUTPUTS = [f"out/vehicle_torque_setpoint.xyz[{i}]" for i in range(3)]
OUTPUTS += [f"out/rate_ctrl_status.{axis}speed_integ" for axis in ("roll", "pitch", "yaw")]


def call(row, integral):
    """Moves the integral. Returns the torques."""

    def of(name, axis):
        return float(row[f"in/{name}[{axis}]"])

    if row["in/law.reset"] != "0":
        integral[:] = [0.0] * 3
    torque = []
    for i, axis in enumerate(("roll", "pitch", "yaw")):
        sp = float(row[f"in/vehicle_rates_setpoint.{axis}"])
        error = sp - of("vehicle_angular_velocity.xyz", i)
        d = of("rate_gains.d", i) * of("vehicle_angular_velocity.xyz_derivative", i)
        torque.append(of("rate_gains.p", i) * error + integral[i] - d + of("rate_gains.ff", i) * sp)
        if row["in/law.landed"] != "0":
            continue
        if of("saturation.positive", i):
            error = min(error, 0.0)
        if of("saturation.negative", i):
            error = max(error, 0.0)
        share = max(0.0, 1 - (error / 6.98131704) ** 2)
        most = of("rate_gains.integral_max", i)
        grown = integral[i] + share * of("rate_gains.i", i) * error * float(row["in/law.dt"])
        integral[i] = min(max(grown, -most), most)
    return torque


def main():
    for file in pathlib.Path(sys.argv[1]).rglob("*hz.csv"):
        integral = [0.0] * 3
        with open(file, newline="", encoding="utf-8") as given:
            answers = [call(row, integral) + integral for row in csv.DictReader(given)]
        with open(file.with_suffix(".out.csv"), "w", newline="", encoding="utf-8") as answered:
            writer = csv.writer(answered)
            writer.writerow(OUTPUTS)
            writer.writerows(answers)


if __name__ == "__main__":
    main()
