# SPDX-License-Identifier: BSD-3-Clause
"""The program that attest starts. Requests and answers are lines of JSON: PROTOCOL.md."""

import json
import math
import os
import sys

from binary32 import Binary32
from law import RateLaw, attitude_law

PROFILES = ["px4-v1.14.4", "px4-v1.15.4", "px4-v1.16.0", "px4-v1.17", "px4-v1.18"]
AXES = ("roll", "pitch", "yaw")


def attitude_step(_, number, vector):
    rates_sp = attitude_law(
        vector("vehicle_attitude.q", 4),
        vector("vehicle_attitude_setpoint.q_d", 4),
        number("vehicle_attitude_setpoint.yaw_sp_move_rate"),
        vector("attitude_gains.p"),
        vector("attitude_gains.rate_max"),
        number("attitude_gains.yaw_weight"),
    )
    return {f"vehicle_rates_setpoint.{axis}": rate for axis, rate in zip(AXES, rates_sp)}


def rate_step(law, number, vector):
    if number("law.reset"):
        law.reset()
    torque = law.torque(...)
