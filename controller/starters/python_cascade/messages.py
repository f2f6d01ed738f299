# SPDX-License-Identifier: BSD-3-Clause
"""The inputs and outputs of both units: the structs of `attest_cascade.h`.

The members have the names, units and frames of the header. A topic whose bit in `updated`
is clear holds its last sample, or zeros before the first one.
"""

import ctypes
from ctypes import c_uint8 as u8
from ctypes import c_uint32 as u32
from ctypes import c_uint64 as u64

from binary32 import Binary32 as f32

PARAMETER_UPDATE = 1 << 8  # the same bit in both units


def topic(**members):
    """The type of a nested struct."""
    return type("Topic", (ctypes.Structure,), {"_fields_": list(members.items())})


def flags(*names):
    """Bytes: any value but zero is true."""
    return topic(**{name: u8 for name in names})


STICKS = topic(roll=f32, pitch=f32, yaw=f32, throttle=f32)


class AttitudeInputs(ctypes.Structure):
    VEHICLE_ATTITUDE_SETPOINT = 1 << 0
    MANUAL_CONTROL_SETPOINT = 1 << 1
    VEHICLE_CONTROL_MODE = 1 << 2
    VEHICLE_STATUS = 1 << 3
    VEHICLE_LAND_DETECTED = 1 << 4
    VEHICLE_LOCAL_POSITION = 1 << 5
    HOVER_THRUST_ESTIMATE = 1 << 6
    AUTOTUNE_ATTITUDE_CONTROL_STATUS = 1 << 7

    _fields_ = (
        ("timestamp", u64),
        ("updated", u32),
        ("reserved", u32),
        (
            "vehicle_attitude",
            topic(
                timestamp=u64,
                timestamp_sample=u64,
                q=f32 * 4,
                delta_q_reset=f32 * 4,
                quat_reset_counter=u8,
            ),
        ),
        (
            "vehicle_attitude_setpoint",
            topic(timestamp=u64, q_d=f32 * 4, thrust_body=f32 * 3, yaw_sp_move_rate=f32),
        ),
        (
            "vehicle_status",
            topic(
                armed_time=u64,
                armed=u8,
                is_rotary_wing=u8,
                is_vtol=u8,
                in_transition_mode=u8,
                is_vtol_tailsitter=u8,
            ),
        ),
        ("autotune_attitude_control_status", topic(timestamp=u64, rate_sp=f32 * 3, state=u8)),
        ("manual_control_setpoint", STICKS),
        ("vehicle_local_position", topic(unaided_heading=f32, heading_good_for_control=u8)),
        ("hover_thrust_estimate", topic(hover_thrust=f32, valid=u8)),
        (
            "vehicle_control_mode",
            flags(
                "flag_control_manual_enabled",
                "flag_control_altitude_enabled",
                "flag_control_velocity_enabled",
                "flag_control_position_enabled",
                "flag_control_attitude_enabled",
            ),
        ),
        ("vehicle_land_detected", flags("landed")),
    )


class AttitudeOutputs(ctypes.Structure):
    _fields_ = (
        (
            "vehicle_rates_setpoint",
            topic(roll=f32, pitch=f32, yaw=f32, thrust_body=f32 * 3, published=u8),
        ),
        (
            "vehicle_attitude_setpoint",
            topic(q_d=f32 * 4, thrust_body=f32 * 3, yaw_sp_move_rate=f32, published=u8),
        ),
    )


class RateInputs(ctypes.Structure):
    VEHICLE_RATES_SETPOINT = 1 << 0
    MANUAL_CONTROL_SETPOINT = 1 << 1
    VEHICLE_CONTROL_MODE = 1 << 2
    VEHICLE_STATUS = 1 << 3
    VEHICLE_LAND_DETECTED = 1 << 4
    CONTROL_ALLOCATOR_STATUS = 1 << 5
    BATTERY_STATUS = 1 << 6

    _fields_ = (
        ("timestamp", u64),
        ("updated", u32),
        ("reserved", u32),
        (
            "vehicle_angular_velocity",
            topic(timestamp_sample=u64, xyz=f32 * 3, xyz_derivative=f32 * 3),
        ),
        ("vehicle_rates_setpoint", topic(roll=f32, pitch=f32, yaw=f32, thrust_body=f32 * 3)),
        ("manual_control_setpoint", STICKS),
        (
            "control_allocator_status",
            topic(unallocated_torque=f32 * 3, torque_setpoint_achieved=u8),
        ),
        ("battery_status", topic(scale=f32, connected=u8)),
        (
            "vehicle_control_mode",
            flags(
                "flag_armed",
                "flag_control_manual_enabled",
                "flag_control_attitude_enabled",
                "flag_control_rates_enabled",
            ),
        ),
        ("vehicle_status", flags("is_rotary_wing")),
        ("vehicle_land_detected", flags("maybe_landed", "landed")),
    )


class RateOutputs(ctypes.Structure):
    _fields_ = (
        ("vehicle_torque_setpoint", topic(xyz=f32 * 3, published=u8)),
        ("vehicle_thrust_setpoint", topic(xyz=f32 * 3, published=u8)),
        (
            "rate_ctrl_status",
            topic(rollspeed_integ=f32, pitchspeed_integ=f32, yawspeed_integ=f32, published=u8),
        ),
        (
            "vehicle_rates_setpoint",
            topic(roll=f32, pitch=f32, yaw=f32, thrust_body=f32 * 3, published=u8),
        ),
    )


# The sizes that attest_cascade.h asserts.
_structs = (AttitudeInputs, AttitudeOutputs, RateInputs, RateOutputs)
assert [ctypes.sizeof(struct) for struct in _structs] == [192, 64, 120, 76]
