// SPDX-License-Identifier: BSD-3-Clause
//! One controller: its latched topics, its parameters, and the order of one step.

use crate::abi::{self, updated, Inputs, Outputs};
use crate::law::{AttitudeSetpoint, Law, Mode, MotorLimits, Profile, RateInputs};
use crate::parameters::{Gains, Parameters};
use crate::tailsitter::Recovery;
use crate::vector::{limited, Quaternion, Vector};

/// Bounds of the law's dt [s]. Above 500 Hz and below 50 Hz the law uses the bound.
const DT_MIN: f32 = 0.002;
const DT_MAX: f32 = 0.02;

/// Largest thrust in acro [0..1]: it leaves some room for control.
const ACRO_THRUST_MAX: f32 = 0.9;

/// Where the unit publishes its rates setpoint and its controls.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Topics {
    Standard,
    /// Those of a VTOL, which another module reads.
    Virtual,
}

/// What the outer loop hands to the inner loop. The result of the outer loop and the external
/// vehicle_rates_setpoint are one variable, as in the firmware.
#[derive(Clone, Copy, Debug, Default)]
struct RatesSetpoint {
    rates: Vector, // [rad/s]
    thrust: f32,   // [0..1]
}

pub struct Unit {
    parameters: Parameters,
    law: Law,
    /// Decided in the first step. If None, the attitude law is used.
    recovery: Option<Recovery>,
    started: bool,
    last_timestamp: u64, // [us]
    /// Bits of topics that were published and are not copied yet.
    pending: u32,
    topics: Option<Topics>,
    rates_setpoint: RatesSetpoint,
    attitude_setpoint: abi::VehicleAttitudeSetpoint,
    manual: abi::ManualControlSetpoint,
    battery: abi::BatteryStatus,
    mode: abi::VehicleControlMode,
    armed: abi::ActuatorArmed,
    status: abi::VehicleStatus,
    motor_limits: abi::MultirotorMotorLimits,
}

fn is_set(flag: u8) -> bool {
    flag != 0
}

fn finite_or_zero(value: f32) -> f32 {
    if value.is_finite() {
        value
    } else {
        0.0
    }
}

impl Unit {
    pub fn new(profile: Profile) -> Self {
        let parameters = Parameters::default();
        Unit {
            law: Law::new(profile, Gains::from(&parameters)),
            parameters,
            recovery: None,
            started: false,
            last_timestamp: 0,
            pending: 0,
            topics: None,
            rates_setpoint: RatesSetpoint::default(),
            attitude_setpoint: Default::default(),
            manual: Default::default(),
            battery: Default::default(),
            mode: Default::default(),
            armed: Default::default(),
            status: abi::VehicleStatus { is_rotary_wing: 1, is_vtol: 0 },
            motor_limits: Default::default(),
        }
    }

    /// Stores a parameter. The law reads it in the first step and in each step with
    /// PARAMETER_UPDATE. Returns false if the profile has no parameter of this name.
    #[must_use]
    pub fn set_parameter(&mut self, name: &str, value: f32) -> bool {
        self.parameters.set(self.law.profile, name, value)
    }

    /// One control step. It writes to `out` what it publishes, and every `published`.
    pub fn step(&mut self, inputs: &Inputs, out: &mut Outputs) {
        out.vehicle_rates_setpoint.published = 0;
        out.actuator_controls_0.published = 0;
        out.mc_att_ctrl_status.published = 0;

        let dt = self.advance(inputs.timestamp);
        self.pending |= inputs.updated;
        self.read_parameters();
        self.latch(inputs);
        self.leave_rattitude();
        self.outer_loop(inputs, out);
        if is_set(self.mode.flag_control_rates_enabled) {
            self.inner_loop(inputs, dt, out);
        }
    }

    /// Returns the law's dt [s]. The first one counts from time 0, so it is usually DT_MAX.
    fn advance(&mut self, timestamp: u64) -> f32 {
        let elapsed_us = timestamp.wrapping_sub(self.last_timestamp);
        self.last_timestamp = timestamp;
        limited(elapsed_us as f32 / 1e6, DT_MIN, DT_MAX)
    }

    fn take_pending(&mut self, bit: u32) -> bool {
        let was_set = self.pending & bit != 0;
        self.pending &= !bit;
        was_set
    }

    fn read_parameters(&mut self) {
        if self.take_pending(updated::PARAMETER_UPDATE) || !self.started {
            self.law.gains = Gains::from(&self.parameters);
        }
        if !self.started {
            self.recovery = self.parameters.tailsitter_recovery().then(Recovery::default);
            self.started = true;
        }
    }

    /// Copies the topics that every mode latches. The setpoints are latched by the modes that use
    /// them.
    fn latch(&mut self, inputs: &Inputs) {
        if self.take_pending(updated::MANUAL_CONTROL_SETPOINT) {
            self.manual = inputs.manual_control_setpoint;
        }
        if self.take_pending(updated::VEHICLE_CONTROL_MODE) {
            self.mode = inputs.vehicle_control_mode;
        }
        if self.take_pending(updated::ACTUATOR_ARMED) {
            self.armed = inputs.actuator_armed;
        }
        if self.take_pending(updated::MULTIROTOR_MOTOR_LIMITS) {
            self.motor_limits = inputs.multirotor_motor_limits;
        }
        if self.take_pending(updated::BATTERY_STATUS) {
            self.battery = inputs.battery_status;
        }
        if self.take_pending(updated::VEHICLE_STATUS) {
            self.status = inputs.vehicle_status;
            let is_vtol = is_set(self.status.is_vtol);
            let topics = if is_vtol { Topics::Virtual } else { Topics::Standard };
            // The first sample decides permanently.
            self.topics.get_or_insert(topics);
        }
    }

    /// In rattitude, a stick beyond the threshold ends attitude control. The flag in the copy stays
    /// cleared until the next sample of vehicle_control_mode.
    fn leave_rattitude(&mut self) {
        let threshold = self.law.gains.rattitude_threshold;
        let beyond = self.manual.y.abs() > threshold || self.manual.x.abs() > threshold;
        if is_set(self.mode.flag_control_rattitude_enabled) && beyond {
            self.mode.flag_control_attitude_enabled = 0;
        }
    }

    fn outer_loop(&mut self, inputs: &Inputs, out: &mut Outputs) {
        if is_set(self.mode.flag_control_attitude_enabled) {
            self.attitude_mode(inputs);
            self.publish_rates_setpoint(out);
        } else if is_set(self.mode.flag_control_manual_enabled) {
            self.acro_mode();
            self.publish_rates_setpoint(out);
        } else {
            self.offboard_rates_mode(inputs);
        }
    }

    fn attitude_mode(&mut self, inputs: &Inputs) {
        if self.take_pending(updated::VEHICLE_ATTITUDE_SETPOINT) {
            self.attitude_setpoint = inputs.vehicle_attitude_setpoint;
        }
        let setpoint = AttitudeSetpoint {
            q_d: Quaternion(self.attitude_setpoint.q_d),
            yaw_sp_move_rate: self.attitude_setpoint.yaw_sp_move_rate,
            weathervane: is_set(self.attitude_setpoint.disable_mc_yaw_control),
        };
        let mode = Mode {
            manual: is_set(self.mode.flag_control_manual_enabled),
            auto: is_set(self.mode.flag_control_auto_enabled),
            velocity: is_set(self.mode.flag_control_velocity_enabled),
        };
        let q = Quaternion(inputs.control_state.q);
        let rates = match &mut self.recovery {
            Some(recovery) => recovery.attitude(q, &setpoint, &self.law.gains),
            None => self.law.attitude(q, &setpoint, mode),
        };
        self.rates_setpoint = RatesSetpoint { rates, thrust: self.attitude_setpoint.thrust };
    }

    /// The sticks command rates. No rate limit applies.
    fn acro_mode(&mut self) {
        let sticks = Vector([self.manual.y, -self.manual.x, self.manual.r]);
        // This comparison turns a NaN throttle into the maximum, as the firmware does.
        let z = self.manual.z;
        self.rates_setpoint = RatesSetpoint {
            rates: sticks.times(self.law.gains.acro_rate_max),
            thrust: if z < ACRO_THRUST_MAX { z } else { ACRO_THRUST_MAX },
        };
    }

    fn offboard_rates_mode(&mut self, inputs: &Inputs) {
        if self.take_pending(updated::VEHICLE_RATES_SETPOINT) {
            let sample = inputs.vehicle_rates_setpoint;
            self.rates_setpoint = RatesSetpoint {
                rates: Vector([sample.roll, sample.pitch, sample.yaw]),
                thrust: sample.thrust,
            };
        }
    }

    /// Publishes only after the first vehicle_status, which selects the topic.
    fn publish_rates_setpoint(&mut self, out: &mut Outputs) {
        let Some(topics) = self.topics else { return };
        if topics == Topics::Standard {
            // The publication supersedes an external sample on the same topic.
            self.take_pending(updated::VEHICLE_RATES_SETPOINT);
        }
        let [roll, pitch, yaw] = self.rates_setpoint.rates.0;
        let thrust = self.rates_setpoint.thrust;
        out.vehicle_rates_setpoint =
            abi::RatesSetpointOutput { roll, pitch, yaw, thrust, published: 1 };
    }

    fn inner_loop(&mut self, inputs: &Inputs, dt: f32, out: &mut Outputs) {
        if !is_set(self.armed.armed) || !is_set(self.status.is_rotary_wing) {
            self.law.reset_integrals();
        }
        let state = &inputs.control_state;
        let control = self.law.rate(&RateInputs {
            rates: Vector([state.roll_rate, state.pitch_rate, state.yaw_rate]),
            rates_sp: self.rates_setpoint.rates,
            thrust_sp: self.rates_setpoint.thrust,
            limits: MotorLimits {
                lower: is_set(self.motor_limits.lower_limit),
                upper: is_set(self.motor_limits.upper_limit),
                yaw: is_set(self.motor_limits.yaw),
            },
            dt,
        });
        self.publish_controls(control, out);
        self.publish_status(out);
    }

    fn publish_controls(&self, control: Vector, out: &mut Outputs) {
        if self.topics.is_none() || self.law.gains.actuators_blocked {
            return;
        }
        let [roll, pitch, yaw] = control.0;
        let mut controls = [roll, pitch, yaw, self.rates_setpoint.thrust].map(finite_or_zero);
        if self.law.gains.battery_scaling && self.battery.scale > 0.0 {
            controls = controls.map(|value| value * self.battery.scale);
        }
        let published = &mut out.actuator_controls_0;
        published.control = [0.0; 8];
        published.control[..4].copy_from_slice(&controls);
        if self.law.profile == Profile::V1_5_5 {
            published.control[7] = self.attitude_setpoint.landing_gear;
        }
        published.published = 1;
    }

    /// The integrals are published even while the controls are not.
    fn publish_status(&self, out: &mut Outputs) {
        let [roll_rate_integ, pitch_rate_integ, yaw_rate_integ] = self.law.rates_integral().0;
        out.mc_att_ctrl_status =
            abi::StatusOutput { roll_rate_integ, pitch_rate_integ, yaw_rate_integ, published: 1 };
    }
}
