# SPDX-License-Identifier: BSD-3-Clause
"""`attest_inputs` and `attest_outputs` of `attest_unit.h` as structured dtypes of numpy.

The members have the names of the header, except that `rates` and `rate_integrals` are arrays of
roll, pitch and yaw. Units and frames are those of the header.
"""

import numpy as np


def struct(*members):
    """A dtype with the padding of a C struct."""
    return np.dtype(list(members), align=True)


INPUTS = struct(
    ("timestamp", "<u8"),
    ("updated", "<u4"),  # a bit for each of TOPICS
    ("control_state", struct(("q", "<f4", 4), ("rates", "<f4", 3))),
    (
        "vehicle_attitude_setpoint",
        struct(
            ("q_d", "<f4", 4),
            ("thrust", "<f4"),
            ("yaw_sp_move_rate", "<f4"),
            ("landing_gear", "<f4"),
            ("disable_mc_yaw_control", "u1"),
        ),
    ),
    ("vehicle_rates_setpoint", struct(("rates", "<f4", 3), ("thrust", "<f4"))),
    ("manual_control_setpoint", struct(("x", "<f4"), ("y", "<f4"), ("z", "<f4"), ("r", "<f4"))),
    ("battery_status", struct(("scale", "<f4"))),
    (
        "vehicle_control_mode",
        struct(
            ("flag_control_manual_enabled", "u1"),
            ("flag_control_auto_enabled", "u1"),
            ("flag_control_rates_enabled", "u1"),
            ("flag_control_attitude_enabled", "u1"),
            ("flag_control_rattitude_enabled", "u1"),
            ("flag_control_velocity_enabled", "u1"),
        ),
    ),
    ("actuator_armed", struct(("armed", "u1"))),
    ("vehicle_status", struct(("is_rotary_wing", "u1"), ("is_vtol", "u1"))),
    (
        "multirotor_motor_limits",
        struct(("lower_limit", "u1"), ("upper_limit", "u1"), ("yaw", "u1")),
    ),
)

OUTPUTS = struct(
    (
        "vehicle_rates_setpoint",
        struct(("rates", "<f4", 3), ("thrust", "<f4"), ("published", "u1")),
    ),
    ("actuator_controls_0", struct(("control", "<f4", 8), ("published", "u1"))),
    ("mc_att_ctrl_status", struct(("rate_integrals", "<f4", 3), ("published", "u1"))),
)

# The topics by their bit in `updated`, from bit 0.
TOPICS = (
    "vehicle_attitude_setpoint",
    "vehicle_rates_setpoint",
    "manual_control_setpoint",
    "vehicle_control_mode",
    "actuator_armed",
    "vehicle_status",
    "multirotor_motor_limits",
    "battery_status",
    "parameter_update",
)

# The offsets that attest_unit.h asserts.
_offsets = [INPUTS.fields[member][1] for member in INPUTS.names]
assert _offsets == [0, 8, 12, 40, 72, 88, 104, 108, 114, 115, 117] and INPUTS.itemsize == 120
_offsets = [OUTPUTS.fields[member][1] for member in OUTPUTS.names]
assert _offsets == [0, 20, 56] and OUTPUTS.itemsize == 72
