#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Answers the vectors of a folder as a board would: it knows only their CSV files.

    board.py STARTER DIR [--mistake NAME]

Steps the law of the Python starter with the rows of each input file PROFILE/GROUP/NAME/RATE.csv,
and writes RATE.out.csv next to it. A mistake is one that people make when they record outputs.
"""

import argparse
import csv
import math
import pathlib
import sys

OUTPUTS = (
    ["out/vehicle_rates_setpoint." + name for name in ("roll", "pitch", "yaw", "thrust")]
    + ["out/vehicle_rates_setpoint.published"]
    + [f"out/actuator_controls_0.control[{i}]" for i in range(8)]
    + ["out/actuator_controls_0.published"]
    + ["out/mc_att_ctrl_status." + name + "_rate_integ" for name in ("roll", "pitch", "yaw")]
    + ["out/mc_att_ctrl_status.published"]
)
# In the order of their bits.
UPDATED = (
    "vehicle_attitude_setpoint vehicle_rates_setpoint manual_control_setpoint vehicle_control_mode "
    "actuator_armed vehicle_status multirotor_motor_limits battery_status parameter_update"
).split()
PROFILES = ("px4-v1.5.5", "px4-v1.3.4")  # the board has the controller of these
PARAMETER = "in/parameter."


def inputs_of(row, Inputs):
    def numbers(topic, *fields):
        return tuple(float(row[f"in/{topic}.{field}"]) for field in fields)

    def flags(topic, *fields):
        return tuple(int(row[f"in/{topic}.{field}"]) for field in fields)

    quaternion = ("q[0]", "q[1]", "q[2]", "q[3]")
    setpoint = "vehicle_attitude_setpoint"
    mode = ("manual", "auto", "rates", "attitude", "rattitude", "velocity")
    return Inputs(
        int(row["timestamp"]),
        sum(int(row["in/updated." + name]) << bit for bit, name in enumerate(UPDATED)),
        numbers("control_state", *quaternion),
        numbers("control_state", "roll_rate", "pitch_rate", "yaw_rate"),
        (
            numbers(setpoint, "q_d[0]", "q_d[1]", "q_d[2]", "q_d[3]"),
            *numbers(setpoint, "thrust", "yaw_sp_move_rate", "landing_gear"),
            *flags(setpoint, "disable_mc_yaw_control"),
        ),
        numbers("vehicle_rates_setpoint", "roll", "pitch", "yaw", "thrust"),
        numbers("manual_control_setpoint", "x", "y", "z", "r"),
        *numbers("battery_status", "scale"),
        flags("vehicle_control_mode", *(f"flag_control_{name}_enabled" for name in mode)),
        *flags("actuator_armed", "armed"),
        *flags("vehicle_status", "is_rotary_wing", "is_vtol"),
        flags("multirotor_motor_limits", "lower_limit", "upper_limit", "yaw"),
    )


def answers(file, profile, controller_module):
    """A list of rows: the time, and the outputs in the order of OUTPUTS."""
    controller = controller_module.Controller(profile)
    is_set = {}
    rows = []
    for row in csv.DictReader(file):
        for name in row:
            is_due = not rows or row["in/updated.parameter_update"] == "1"
            if name.startswith(PARAMETER) and is_due and is_set.get(name) != row[name]:
                is_set[name] = row[name]
                controller.set_parameter(name[len(PARAMETER) :], float(row[name]))
        out = controller.step(inputs_of(row, controller_module.Inputs))
        values = [*out.rates_setpoint, int(out.rates_setpoint_published)]
        values += [*out.controls, int(out.controls_published)]
        values += [*out.integrals, int(out.integrals_published)]
        rows.append([int(row["timestamp"]), *values])
    return rows


def with_mistake(mistake, header, rows):
    """The table of a board whose author made the mistake."""
    rates = slice(1, 4)
    if mistake == "degrees":
        for row in rows:
            row[rates] = [math.degrees(value) for value in row[rates]]
    elif mistake == "milliseconds":
        for row in rows:
            row[0] = row[0] / 1000
    elif mistake == "exchanged":
        for row in rows:
            row[1], row[2] = row[2], row[1]
    elif mistake == "late":
        rows = [[row[0], *before[1:]] for row, before in zip(rows, [rows[0], *rows])]
    elif mistake == "cut":
        rows = rows[: len(rows) // 2]
    elif mistake == "gap":
        del rows[len(rows) // 2]
    elif mistake == "unsorted":
        rows = [*rows[1:], rows[0]]
    elif mistake == "no-integrals":
        header, rows = header[:15], [row[:15] for row in rows]
    elif mistake == "other-names":
        header = [name.removeprefix("out/") for name in header]
        header[1] = "vehicle_p_sp"
    elif mistake == "law":  # the port is wrong, not the recording
        for row in rows:
            row[3] = -row[3]
    return header, rows


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("starter")
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--mistake")
    arguments = parser.parse_args()
    sys.path.insert(0, arguments.starter)
    import controller  # noqa: PLC0415  (the path is an argument)

    for path in sorted(arguments.folder.glob("*/*/*/*.csv")):
        if path.name.endswith(".out.csv"):
            continue
        profile = path.relative_to(arguments.folder).parts[0]
        if profile not in PROFILES:
            continue
        with path.open(newline="") as file:
            rows = answers(file, profile, controller)
        header, rows = with_mistake(arguments.mistake, ["timestamp", *OUTPUTS], rows)
        with path.with_suffix(".out.csv").open("w", newline="") as file:
            csv.writer(file).writerows([header, *rows])


main()
