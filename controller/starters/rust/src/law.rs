// SPDX-License-Identifier: BSD-3-Clause
//! The control law of PX4 mc_att_control: attitude error to rates setpoint, rate error to controls.
//!
//! It has no clock, no topics and no ABI types. All arithmetic is f32, from left to right. Rust
//! never fuses `a * b + c`, so results have the same bits on every IEEE machine. `atan2`, `acos`
//! and `exp` are computed in f64 and rounded: the nearest f32 for nearly every argument.
//!
//! Frames: world is NED, body is FRD. Vectors are {roll, pitch, yaw} about the axes of the body.

use crate::parameters::Gains;
use crate::vector::{atan2, limited, Matrix, Quaternion, Vector};

/// The index of yaw in a vector.
const YAW: usize = 2;

/// The integrators stand still at or below this thrust [0..1].
const MIN_TAKEOFF_THRUST: f32 = 0.2;

/// An integrator stands still if its integral or its control would be at or beyond +- this limit.
const RATES_INTEGRAL_LIMIT: f32 = 0.3;

/// The version of the law.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Profile {
    V1_5_5,
    V1_3_4,
}

impl Profile {
    pub fn from_name(name: &str) -> Option<Self> {
        match name {
            "px4-v1.5.5" => Some(Profile::V1_5_5),
            "px4-v1.3.4" => Some(Profile::V1_3_4),
            _ => None,
        }
    }
}

/// The flags of vehicle_control_mode that the attitude law uses.
#[derive(Clone, Copy, Debug)]
pub struct Mode {
    pub manual: bool,
    pub auto: bool,
    pub velocity: bool,
}

impl Mode {
    /// True if no pilot flies: `auto_rate_max` then limits the rates, and weather-vaning is
    /// allowed. px4-v1.3.4 ignores the auto flag.
    fn autonomous(&self, profile: Profile) -> bool {
        let auto = self.auto && profile == Profile::V1_5_5;
        (self.velocity || auto) && !self.manual
    }
}

#[derive(Clone, Copy, Debug)]
pub struct AttitudeSetpoint {
    /// Desired attitude, body FRD to world NED.
    pub q_d: Quaternion,
    /// [rad/s] yaw rate commanded by the pilot.
    pub yaw_sp_move_rate: f32,
    /// The wind may turn the nose.
    pub weathervane: bool,
}

/// Saturation that the mixer reported.
#[derive(Clone, Copy, Debug)]
pub struct MotorLimits {
    pub lower: bool,
    pub upper: bool,
    pub yaw: bool,
}

/// Inputs of the rate law. Rates are [rad/s], thrust is [0..1], dt is [s].
#[derive(Clone, Copy, Debug)]
pub struct RateInputs {
    pub rates: Vector,
    pub rates_sp: Vector,
    pub thrust_sp: f32,
    pub limits: MotorLimits,
    pub dt: f32,
}

/// The state of the law between two steps.
#[derive(Clone, Debug)]
pub struct Law {
    pub profile: Profile,
    pub gains: Gains,
    rates_prev: Vector,
    rates_sp_prev: Vector,
    rates_integral: Vector,
}

impl Law {
    pub fn new(profile: Profile, gains: Gains) -> Self {
        Law {
            profile,
            gains,
            rates_prev: Vector::default(),
            rates_sp_prev: Vector::default(),
            rates_integral: Vector::default(),
        }
    }

    /// The integral parts of the controls.
    pub fn rates_integral(&self) -> Vector {
        self.rates_integral
    }

    pub fn reset_integrals(&mut self) {
        self.rates_integral = Vector::default();
    }

    /// The attitude law: returns the rates setpoint [rad/s]. `q` is the attitude, body to world.
    pub fn attitude(&mut self, q: Quaternion, setpoint: &AttitudeSetpoint, mode: Mode) -> Vector {
        let r_sp = setpoint.q_d.rotation();
        let yaw_weight = r_sp.0[2][2] * r_sp.0[2][2];
        let error = attitude_error(&q.rotation(), &r_sp, yaw_weight);

        let autonomous = mode.autonomous(self.profile);
        let gains = &self.gains;
        let limit = if autonomous { gains.auto_rate_max } else { gains.rate_max };
        let mut rates_sp = gains.attitude_p.times(error).limited(limit);

        let feed_forward = setpoint.yaw_sp_move_rate * yaw_weight * gains.yaw_ff;
        let weathervane = autonomous && setpoint.weathervane;
        // px4-v1.3.4 limits before and after the feed-forward.
        if weathervane && self.profile == Profile::V1_3_4 {
            self.weathervane(&mut rates_sp);
        }
        rates_sp[YAW] += feed_forward;
        if weathervane {
            self.weathervane(&mut rates_sp);
        }
        rates_sp
    }

    /// Leaves little authority to yaw, so that the wind can turn the nose.
    fn weathervane(&mut self, rates_sp: &mut Vector) {
        let limit = self.gains.weathervane_rate_max;
        rates_sp[YAW] = limited(rates_sp[YAW], -limit, limit);
        self.rates_integral[YAW] = 0.0;
    }

    /// The rate law: returns the controls of roll, pitch and yaw.
    pub fn rate(&mut self, inputs: &RateInputs) -> Vector {
        let gains = &self.gains;
        let error = inputs.rates_sp - inputs.rates;
        let damping = gains.rate_d.times(self.rates_prev - inputs.rates) / inputs.dt;
        let control = gains.rate_p.times(error * self.attenuation(inputs.thrust_sp))
            + damping
            + self.rates_integral
            + self.feed_forward(inputs);
        self.rates_prev = inputs.rates;
        self.rates_sp_prev = inputs.rates_sp;
        self.integrate(error, control, inputs);
        control
    }

    /// The factor on the proportional part at high thrust: thrust-based PID attenuation (TPA).
    /// `min` and `max` ignore NaN, as fminf and fmaxf do, so a NaN thrust gives 1. `clamp` keeps
    /// NaN.
    #[allow(clippy::manual_clamp)]
    fn attenuation(&self, thrust: f32) -> f32 {
        match self.profile {
            Profile::V1_3_4 => 1.0,
            Profile::V1_5_5 => {
                let reduction = self.gains.tpa_slope * (thrust.abs() - self.gains.tpa_break);
                (1.0 - reduction).min(1.0).max(0.0)
            }
        }
    }

    /// px4-v1.5.5 feeds the rates setpoint forward, px4-v1.3.4 its derivative.
    fn feed_forward(&self, inputs: &RateInputs) -> Vector {
        let gain = self.gains.rate_ff;
        match self.profile {
            Profile::V1_5_5 => gain.times(inputs.rates_sp),
            Profile::V1_3_4 => gain.times(inputs.rates_sp - self.rates_sp_prev) / inputs.dt,
        }
    }

    /// Integrates the rate error of each axis that is far from saturation.
    fn integrate(&mut self, error: Vector, control: Vector, inputs: &RateInputs) {
        let limits = inputs.limits;
        let flying = inputs.thrust_sp > MIN_TAKEOFF_THRUST;
        if !flying || limits.lower || limits.upper {
            return;
        }
        // px4-v1.3.4 ignores the yaw flag.
        let yaw_frozen = limits.yaw && self.profile == Profile::V1_5_5;
        for axis in 0..3 {
            let integral =
                self.rates_integral[axis] + self.gains.rate_i[axis] * error[axis] * inputs.dt;
            if control[axis].abs() < inputs.thrust_sp
                && within_integral_limit(integral)
                && within_integral_limit(control[axis])
                && !(axis == YAW && yaw_frozen)
            {
                self.rates_integral[axis] = integral;
            }
        }
    }
}

/// False for NaN too.
fn within_integral_limit(value: f32) -> bool {
    -RATES_INTEGRAL_LIMIT < value && value < RATES_INTEGRAL_LIMIT
}

/// The rotation vector [rad] in body axes that turns `r` into `r_sp`: the thrust axis first, then
/// yaw. `yaw_weight` is the weight of the yaw part. It falls with the tilt of `r_sp`.
fn attitude_error(r: &Matrix, r_sp: &Matrix, yaw_weight: f32) -> Vector {
    let (z, z_sp) = (r.column(2), r_sp.column(2));
    let mut error = r.transposed() * z.cross(z_sp);
    let sine = error.length();
    let cosine = z.dot(z_sp);

    let mut r_tilted = *r;
    if sine > 0.0 {
        let axis = error / sine;
        error = axis * atan2(sine, cosine);
        r_tilted = *r * rodrigues(axis, sine, cosine);
    }

    let (x_sp, x_tilted) = (r_sp.column(0), r_tilted.column(0));
    let yaw_sine = x_tilted.cross(x_sp).dot(z_sp);
    error[YAW] = atan2(yaw_sine, x_tilted.dot(x_sp)) * yaw_weight;

    if cosine < 0.0 {
        let direct_weight = cosine * cosine * yaw_weight;
        error = error * (1.0 - direct_weight) + direct_error(r, r_sp) * direct_weight;
    }
    error
}

/// The rotation matrix about `axis` by the angle of this sine and cosine.
fn rodrigues(axis: Vector, sine: f32, cosine: f32) -> Matrix {
    let k = Matrix::cross_product(axis);
    (Matrix::IDENTITY + k * sine) + (k * k) * (1.0 - cosine)
}

/// Twice the imaginary part of the quaternion of the shortest rotation from `r` to `r_sp`.
fn direct_error(r: &Matrix, r_sp: &Matrix) -> Vector {
    let q = Quaternion::from_rotation(&(r.transposed() * *r_sp));
    if q.0[0] >= 0.0 {
        q.imaginary() * 2.0
    } else {
        -q.imaginary() * 2.0
    }
}
