// SPDX-License-Identifier: BSD-3-Clause
//! The types of `attest_unit.h`, with the same names and layout. That header explains each signal.
//!
//! Flags are bytes: 0 is false, each other value is true.

use std::ffi::{c_char, c_int, c_void};
use std::mem::{offset_of, size_of};

pub const ABI_VERSION: u32 = 1;

/// Results, the same numbers in the library and in the program.
pub const OK: c_int = 0;
pub const UNSUPPORTED: c_int = 1;
pub const INVALID: c_int = 2;
pub const FAILED: c_int = 3;

/// The bits of `Inputs::updated`.
pub mod updated {
    pub const VEHICLE_ATTITUDE_SETPOINT: u32 = 1 << 0;
    pub const VEHICLE_RATES_SETPOINT: u32 = 1 << 1;
    pub const MANUAL_CONTROL_SETPOINT: u32 = 1 << 2;
    pub const VEHICLE_CONTROL_MODE: u32 = 1 << 3;
    pub const ACTUATOR_ARMED: u32 = 1 << 4;
    pub const VEHICLE_STATUS: u32 = 1 << 5;
    pub const MULTIROTOR_MOTOR_LIMITS: u32 = 1 << 6;
    pub const BATTERY_STATUS: u32 = 1 << 7;
    pub const PARAMETER_UPDATE: u32 = 1 << 8;
}

#[repr(C)]
#[derive(Clone, Copy, Debug, Default)]
pub struct ControlState {
    pub q: [f32; 4],
    pub roll_rate: f32,
    pub pitch_rate: f32,
    pub yaw_rate: f32,
}

#[repr(C)]
#[derive(Clone, Copy, Debug, Default)]
pub struct VehicleAttitudeSetpoint {
    pub q_d: [f32; 4],
    pub thrust: f32,
    pub yaw_sp_move_rate: f32,
    pub landing_gear: f32,
    pub disable_mc_yaw_control: u8,
}

#[repr(C)]
#[derive(Clone, Copy, Debug, Default)]
pub struct VehicleRatesSetpoint {
    pub roll: f32,
    pub pitch: f32,
    pub yaw: f32,
    pub thrust: f32,
}

#[repr(C)]
#[derive(Clone, Copy, Debug, Default)]
pub struct ManualControlSetpoint {
    pub x: f32,
    pub y: f32,
    pub z: f32,
    pub r: f32,
}

#[repr(C)]
#[derive(Clone, Copy, Debug, Default)]
pub struct BatteryStatus {
    pub scale: f32,
}

#[repr(C)]
#[derive(Clone, Copy, Debug, Default)]
pub struct VehicleControlMode {
    pub flag_control_manual_enabled: u8,
    pub flag_control_auto_enabled: u8,
    pub flag_control_rates_enabled: u8,
    pub flag_control_attitude_enabled: u8,
    pub flag_control_rattitude_enabled: u8,
    pub flag_control_velocity_enabled: u8,
}

#[repr(C)]
#[derive(Clone, Copy, Debug, Default)]
pub struct ActuatorArmed {
    pub armed: u8,
}

#[repr(C)]
#[derive(Clone, Copy, Debug, Default)]
pub struct VehicleStatus {
    pub is_rotary_wing: u8,
    pub is_vtol: u8,
}

#[repr(C)]
#[derive(Clone, Copy, Debug, Default)]
pub struct MultirotorMotorLimits {
    pub lower_limit: u8,
    pub upper_limit: u8,
    pub yaw: u8,
}

/// `attest_inputs`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default)]
pub struct Inputs {
    pub timestamp: u64,
    pub updated: u32,
    pub control_state: ControlState,
    pub vehicle_attitude_setpoint: VehicleAttitudeSetpoint,
    pub vehicle_rates_setpoint: VehicleRatesSetpoint,
    pub manual_control_setpoint: ManualControlSetpoint,
    pub battery_status: BatteryStatus,
    pub vehicle_control_mode: VehicleControlMode,
    pub actuator_armed: ActuatorArmed,
    pub vehicle_status: VehicleStatus,
    pub multirotor_motor_limits: MultirotorMotorLimits,
}

#[repr(C)]
#[derive(Clone, Copy, Debug, Default)]
pub struct RatesSetpointOutput {
    pub roll: f32,
    pub pitch: f32,
    pub yaw: f32,
    pub thrust: f32,
    pub published: u8,
}

#[repr(C)]
#[derive(Clone, Copy, Debug, Default)]
pub struct ActuatorControlsOutput {
    pub control: [f32; 8],
    pub published: u8,
}

#[repr(C)]
#[derive(Clone, Copy, Debug, Default)]
pub struct StatusOutput {
    pub roll_rate_integ: f32,
    pub pitch_rate_integ: f32,
    pub yaw_rate_integ: f32,
    pub published: u8,
}

/// `attest_outputs`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default)]
pub struct Outputs {
    pub vehicle_rates_setpoint: RatesSetpointOutput,
    pub actuator_controls_0: ActuatorControlsOutput,
    pub mc_att_ctrl_status: StatusOutput,
}

/// `attest_unit`, the table of functions.
#[repr(C)]
pub struct UnitTable {
    pub abi_version: u32,
    pub name: *const c_char,
    pub version: *const c_char,
    pub create: unsafe extern "C" fn(*const c_char) -> *mut c_void,
    pub destroy: unsafe extern "C" fn(*mut c_void),
    pub set_parameter: unsafe extern "C" fn(*mut c_void, *const c_char, f32) -> c_int,
    pub step: unsafe extern "C" fn(*mut c_void, *const Inputs, *mut Outputs) -> c_int,
    pub extension: Option<unsafe extern "C" fn(*const c_char) -> *const c_void>,
}

// SAFETY: the strings and functions that a table points to are static and never written.
unsafe impl Sync for UnitTable {}

const _: () = {
    assert!(offset_of!(Inputs, timestamp) == 0);
    assert!(offset_of!(Inputs, updated) == 8);
    assert!(offset_of!(Inputs, control_state) == 12);
    assert!(offset_of!(Inputs, vehicle_attitude_setpoint) == 40);
    assert!(offset_of!(Inputs, vehicle_rates_setpoint) == 72);
    assert!(offset_of!(Inputs, manual_control_setpoint) == 88);
    assert!(offset_of!(Inputs, battery_status) == 104);
    assert!(offset_of!(Inputs, vehicle_control_mode) == 108);
    assert!(offset_of!(Inputs, actuator_armed) == 114);
    assert!(offset_of!(Inputs, vehicle_status) == 115);
    assert!(offset_of!(Inputs, multirotor_motor_limits) == 117);
    assert!(size_of::<Inputs>() == 120);
    assert!(offset_of!(Outputs, vehicle_rates_setpoint) == 0);
    assert!(offset_of!(Outputs, actuator_controls_0) == 20);
    assert!(offset_of!(Outputs, mc_att_ctrl_status) == 56);
    assert!(size_of::<Outputs>() == 72);
};
