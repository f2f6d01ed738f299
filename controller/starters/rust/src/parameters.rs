// SPDX-License-Identifier: BSD-3-Clause
//! The parameters of the controller by their PX4 names, and the gains that the law uses.

use crate::law::Profile;
use crate::vector::Vector;

/// Declares a struct of f32, its defaults, and the access by PX4 name from one table.
macro_rules! parameters {
    ($($field:ident: $name:literal = $default:literal,)*) => {
        /// Every parameter is stored as f32. The host passes integer parameters as floats, too.
        #[derive(Clone, Debug)]
        pub struct Parameters { $(pub $field: f32,)* }

        impl Default for Parameters {
            fn default() -> Self {
                Parameters { $($field: $default,)* }
            }
        }

        impl Parameters {
            /// The parameter with this PX4 name, if the law has it.
            pub fn by_name(&mut self, name: &str) -> Option<&mut f32> {
                match name {
                    $($name => Some(&mut self.$field),)*
                    _ => None,
                }
            }
        }
    };
}

parameters! {
    // Attitude gains [1/s]. A time constant [s] scales P of the attitude, and P and D of the rates.
    roll_tc: "MC_ROLL_TC" = 0.2,
    pitch_tc: "MC_PITCH_TC" = 0.2,
    roll_p: "MC_ROLL_P" = 6.5,
    pitch_p: "MC_PITCH_P" = 6.5,
    yaw_p: "MC_YAW_P" = 2.8,
    yaw_ff: "MC_YAW_FF" = 0.5,
    // Rate gains: P [s/rad], I [1/rad], D [s^2/rad], FF [s/rad].
    rollrate_p: "MC_ROLLRATE_P" = 0.15,
    rollrate_i: "MC_ROLLRATE_I" = 0.05,
    rollrate_d: "MC_ROLLRATE_D" = 0.003,
    rollrate_ff: "MC_ROLLRATE_FF" = 0.0,
    pitchrate_p: "MC_PITCHRATE_P" = 0.15,
    pitchrate_i: "MC_PITCHRATE_I" = 0.05,
    pitchrate_d: "MC_PITCHRATE_D" = 0.003,
    pitchrate_ff: "MC_PITCHRATE_FF" = 0.0,
    yawrate_p: "MC_YAWRATE_P" = 0.2,
    yawrate_i: "MC_YAWRATE_I" = 0.1,
    yawrate_d: "MC_YAWRATE_D" = 0.0,
    yawrate_ff: "MC_YAWRATE_FF" = 0.0,
    // Limits of the rates setpoint, and the rates of full stick in acro [deg/s].
    rollrate_max: "MC_ROLLRATE_MAX" = 220.0,
    pitchrate_max: "MC_PITCHRATE_MAX" = 220.0,
    yawrate_max: "MC_YAWRATE_MAX" = 200.0,
    yawrauto_max: "MC_YAWRAUTO_MAX" = 45.0,
    acro_r_max: "MC_ACRO_R_MAX" = 360.0,
    acro_p_max: "MC_ACRO_P_MAX" = 360.0,
    acro_y_max: "MC_ACRO_Y_MAX" = 360.0,
    // Stick deflection, thrust and shares, all without unit.
    ratt_th: "MC_RATT_TH" = 1.0,
    tpa_break: "MC_TPA_BREAK" = 1.0,
    tpa_slope: "MC_TPA_SLOPE" = 1.0,
    wv_yawr_scl: "VT_WV_YAWR_SCL" = 0.15,
    // Integers.
    bat_scale_en: "MC_BAT_SCALE_EN" = 0.0,
    vt_type: "VT_TYPE" = 0.0,
    vt_opt_recov_en: "VT_OPT_RECOV_EN" = 0.0,
    cbrk_rate_ctrl: "CBRK_RATE_CTRL" = 0.0,
}

/// Parameters of px4-v1.5.5 that px4-v1.3.4 does not have.
const SINCE_V1_5_5: [&str; 3] = ["MC_TPA_BREAK", "MC_TPA_SLOPE", "MC_BAT_SCALE_EN"];

/// The value of CBRK_RATE_CTRL that suppresses the actuator controls.
const CBRK_RATE_CTRL_KEY: i32 = 140_253;

impl Parameters {
    /// Returns false if `profile` has no parameter of this name. Each value is allowed, NaN too.
    #[must_use]
    pub fn set(&mut self, profile: Profile, name: &str, value: f32) -> bool {
        if profile == Profile::V1_3_4 && SINCE_V1_5_5.contains(&name) {
            return false;
        }
        match self.by_name(name) {
            Some(parameter) => *parameter = value,
            None => return false,
        }
        true
    }

    /// True if the tailsitter recovery replaces the attitude law.
    pub fn tailsitter_recovery(&self) -> bool {
        self.vt_type as i32 == 0 && self.vt_opt_recov_en as i32 != 0
    }
}

/// What the law computes from the parameters. Vectors are {roll, pitch, yaw}, rates are rad/s.
#[derive(Clone, Debug)]
pub struct Gains {
    pub attitude_p: Vector,
    pub rate_p: Vector,
    pub rate_i: Vector,
    pub rate_d: Vector,
    pub rate_ff: Vector,
    /// Limit of the rates setpoint when a pilot flies.
    pub rate_max: Vector,
    /// Limit of the rates setpoint in autonomous modes.
    pub auto_rate_max: Vector,
    /// Rates at full stick in acro.
    pub acro_rate_max: Vector,
    pub yaw_ff: f32,
    pub rattitude_threshold: f32,
    pub tpa_break: f32,
    pub tpa_slope: f32,
    /// Limit of the yaw rate setpoint while weather-vaning.
    pub weathervane_rate_max: f32,
    pub battery_scaling: bool,
    pub actuators_blocked: bool,
}

impl From<&Parameters> for Gains {
    fn from(p: &Parameters) -> Self {
        // The firmware's gains hold for time constants of 0.2 s.
        let (roll, pitch) = (0.2 / p.roll_tc, 0.2 / p.pitch_tc);
        let (roll_max, pitch_max) = (radians(p.rollrate_max), radians(p.pitchrate_max));
        let auto_yaw_max = radians(p.yawrauto_max);
        Gains {
            attitude_p: Vector([p.roll_p * roll, p.pitch_p * pitch, p.yaw_p]),
            rate_p: Vector([p.rollrate_p * roll, p.pitchrate_p * pitch, p.yawrate_p]),
            rate_i: Vector([p.rollrate_i, p.pitchrate_i, p.yawrate_i]),
            rate_d: Vector([p.rollrate_d * roll, p.pitchrate_d * pitch, p.yawrate_d]),
            rate_ff: Vector([p.rollrate_ff, p.pitchrate_ff, p.yawrate_ff]),
            rate_max: Vector([roll_max, pitch_max, radians(p.yawrate_max)]),
            auto_rate_max: Vector([roll_max, pitch_max, auto_yaw_max]),
            acro_rate_max: Vector([p.acro_r_max, p.acro_p_max, p.acro_y_max].map(radians)),
            yaw_ff: p.yaw_ff,
            rattitude_threshold: p.ratt_th,
            tpa_break: p.tpa_break,
            tpa_slope: p.tpa_slope,
            weathervane_rate_max: auto_yaw_max * p.wv_yawr_scl,
            battery_scaling: p.bat_scale_en as i32 != 0,
            actuators_blocked: p.cbrk_rate_ctrl as i32 == CBRK_RATE_CTRL_KEY,
        }
    }
}

/// `f32::to_radians` multiplies by a rounded pi/180, which gives other last bits.
pub fn radians(degrees: f32) -> f32 {
    (degrees / 180.0) * std::f32::consts::PI
}
