// SPDX-License-Identifier: BSD-3-Clause
//! Binary frames to Rust values and back. All numbers are little-endian.

use std::io::{self, BufRead, Write};

use attest_starter_rust::abi::{
    ActuatorArmed, BatteryStatus, ControlState, Inputs, ManualControlSetpoint,
    MultirotorMotorLimits, Outputs, VehicleAttitudeSetpoint, VehicleControlMode,
    VehicleRatesSetpoint, VehicleStatus,
};

/// The header of a request or of an answer.
#[derive(Clone, Copy, Debug)]
pub struct Header {
    /// The size of the payload [bytes].
    pub size: u32,
    pub kind: u32,
    pub unit: u32,
    pub sequence: u32,
}

impl Header {
    /// Returns None if the input ended before the header: the normal end of the program.
    pub fn read(input: &mut impl BufRead) -> io::Result<Option<Self>> {
        if input.fill_buf()?.is_empty() {
            return Ok(None);
        }
        let mut bytes = [0; 16];
        input.read_exact(&mut bytes)?;
        let word = |i: usize| u32::from_le_bytes(std::array::from_fn(|k| bytes[4 * i + k]));
        Ok(Some(Header { size: word(0), kind: word(1), unit: word(2), sequence: word(3) }))
    }

    /// The header of the answer to this request.
    pub fn answered_with(self, payload: &[u8]) -> Self {
        Header { size: payload.len() as u32, ..self }
    }

    pub fn write(&self, output: &mut impl Write) -> io::Result<()> {
        for word in [self.size, self.kind, self.unit, self.sequence] {
            output.write_all(&word.to_le_bytes())?;
        }
        Ok(())
    }
}

/// Reads a payload from its start to its end. Each function returns None if too few bytes are left.
pub struct Reader<'a> {
    rest: &'a [u8],
}

impl<'a> Reader<'a> {
    pub fn new(payload: &'a [u8]) -> Self {
        Reader { rest: payload }
    }

    /// The number of bytes that are left.
    pub fn remaining(&self) -> usize {
        self.rest.len()
    }

    fn bytes(&mut self, count: usize) -> Option<&'a [u8]> {
        if count > self.rest.len() {
            return None;
        }
        let (taken, rest) = self.rest.split_at(count);
        self.rest = rest;
        Some(taken)
    }

    fn array<const N: usize>(&mut self) -> Option<[u8; N]> {
        self.bytes(N)?.try_into().ok()
    }

    pub fn text(&mut self, count: usize) -> Option<&'a str> {
        std::str::from_utf8(self.bytes(count)?).ok()
    }

    pub fn u32(&mut self) -> Option<u32> {
        self.array().map(u32::from_le_bytes)
    }

    pub fn u64(&mut self) -> Option<u64> {
        self.array().map(u64::from_le_bytes)
    }

    pub fn f32(&mut self) -> Option<f32> {
        self.array().map(f32::from_le_bytes)
    }

    fn u8(&mut self) -> Option<u8> {
        self.array().map(u8::from_le_bytes)
    }

    fn quaternion(&mut self) -> Option<[f32; 4]> {
        Some([self.f32()?, self.f32()?, self.f32()?, self.f32()?])
    }

    /// `attest_inputs`, 120 bytes. The fields are in the order of the struct, and Rust evaluates
    /// them in the order written here.
    pub fn inputs(&mut self) -> Option<Inputs> {
        Some(Inputs {
            timestamp: self.u64()?,
            updated: self.u32()?,
            control_state: ControlState {
                q: self.quaternion()?,
                roll_rate: self.f32()?,
                pitch_rate: self.f32()?,
                yaw_rate: self.f32()?,
            },
            vehicle_attitude_setpoint: self.attitude_setpoint()?,
            vehicle_rates_setpoint: VehicleRatesSetpoint {
                roll: self.f32()?,
                pitch: self.f32()?,
                yaw: self.f32()?,
                thrust: self.f32()?,
            },
            manual_control_setpoint: ManualControlSetpoint {
                x: self.f32()?,
                y: self.f32()?,
                z: self.f32()?,
                r: self.f32()?,
            },
            battery_status: BatteryStatus { scale: self.f32()? },
            vehicle_control_mode: self.control_mode()?,
            actuator_armed: ActuatorArmed { armed: self.u8()? },
            vehicle_status: VehicleStatus { is_rotary_wing: self.u8()?, is_vtol: self.u8()? },
            multirotor_motor_limits: MultirotorMotorLimits {
                lower_limit: self.u8()?,
                upper_limit: self.u8()?,
                yaw: self.u8()?,
            },
        })
    }

    fn attitude_setpoint(&mut self) -> Option<VehicleAttitudeSetpoint> {
        let setpoint = VehicleAttitudeSetpoint {
            q_d: self.quaternion()?,
            thrust: self.f32()?,
            yaw_sp_move_rate: self.f32()?,
            landing_gear: self.f32()?,
            disable_mc_yaw_control: self.u8()?,
        };
        self.bytes(3)?; // padding
        Some(setpoint)
    }

    fn control_mode(&mut self) -> Option<VehicleControlMode> {
        Some(VehicleControlMode {
            flag_control_manual_enabled: self.u8()?,
            flag_control_auto_enabled: self.u8()?,
            flag_control_rates_enabled: self.u8()?,
            flag_control_attitude_enabled: self.u8()?,
            flag_control_rattitude_enabled: self.u8()?,
            flag_control_velocity_enabled: self.u8()?,
        })
    }
}

/// Appends `attest_outputs`, 72 bytes.
pub fn write_outputs(outputs: &Outputs, bytes: &mut Vec<u8>) {
    let setpoint = &outputs.vehicle_rates_setpoint;
    let values = [setpoint.roll, setpoint.pitch, setpoint.yaw, setpoint.thrust];
    write_topic(&values, setpoint.published, bytes);
    let controls = &outputs.actuator_controls_0;
    write_topic(&controls.control, controls.published, bytes);
    let status = &outputs.mc_att_ctrl_status;
    let values = [status.roll_rate_integ, status.pitch_rate_integ, status.yaw_rate_integ];
    write_topic(&values, status.published, bytes);
}

/// Appends the values, the flag `published`, and 3 bytes of padding.
fn write_topic(values: &[f32], published: u8, bytes: &mut Vec<u8>) {
    for value in values {
        bytes.extend_from_slice(&value.to_le_bytes());
    }
    bytes.extend_from_slice(&[published, 0, 0, 0]);
}
