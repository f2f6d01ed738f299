// SPDX-License-Identifier: BSD-3-Clause
//! Recovery of a tailsitter from a large tilt. It replaces the attitude law if VT_TYPE is 0 and
//! VT_OPT_RECOV_EN is not 0. Leave this file out if your vehicle is no tailsitter.

use std::f32::consts::{FRAC_PI_2, PI};

use crate::law::AttitudeSetpoint;
use crate::parameters::{radians, Gains};
use crate::vector::{atan2, exp, limited, Quaternion, Vector};

/// Direction of the thrust in the body frame.
const THRUST_AXIS: Vector = Vector([0.0, 0.0, -1.0]);

/// Tilt errors [deg] at which the recovery begins and ends.
const BEGIN_TILT_DEG: f32 = 30.0;
const END_TILT_DEG: f32 = 5.0;

#[derive(Clone, Debug, Default)]
pub struct Recovery {
    active: bool,
}

impl Recovery {
    /// Returns the rates setpoint [rad/s]. `q` is the attitude, body FRD to world NED.
    pub fn attitude(
        &mut self,
        q: Quaternion,
        setpoint: &AttitudeSetpoint,
        gains: &Gains,
    ) -> Vector {
        let q_error = q * setpoint.q_d.conjugate();
        let thrust_direction = q_error.rotation() * THRUST_AXIS;
        let tilt = angle_of_cosine(thrust_direction.dot(THRUST_AXIS));
        self.select_mode(tilt);

        let r = q.rotation();
        let mut rates_sp = if self.active {
            let world_axis = if tilt.abs().min((tilt - PI).abs()) > 1e-5 {
                thrust_direction.cross(THRUST_AXIS)
            } else {
                THRUST_AXIS
            };
            recovery_rates(tilt, r.transposed() * world_axis)
        } else {
            small_tilt_rates(q, setpoint.q_d, gains)
        };

        let yaw_weight = limited(r.0[2][2].max(0.0), 0.0, 1.0);
        rates_sp[2] += setpoint.yaw_sp_move_rate * yaw_weight * gains.yaw_ff;
        rates_sp.limited(gains.rate_max)
    }

    /// Two thresholds: between them the mode stays as it is. A NaN tilt does not change it.
    fn select_mode(&mut self, tilt: f32) {
        if tilt.abs() > radians(BEGIN_TILT_DEG) {
            self.active = true;
        } else if tilt.abs() < radians(END_TILT_DEG) {
            self.active = false;
        }
    }
}

/// The angle [rad] of a cosine that may have been rounded beyond +-1.
fn angle_of_cosine(cosine: f32) -> f32 {
    if cosine >= 1.0 {
        0.0
    } else if cosine <= -1.0 {
        PI
    } else {
        f64::from(cosine).acos() as f32
    }
}

/// A proportional law on the error quaternion.
fn small_tilt_rates(q: Quaternion, q_sp: Quaternion, gains: &Gains) -> Vector {
    let q_error = q_sp.conjugate() * q;
    let sign = if q_error.0[0] > 0.0 { -2.0 } else { 2.0 };
    let mut rates = gains.attitude_p.times(q_error.imaginary() * sign);
    rates[2] = limited(rates[2], -1.0, 1.0);
    rates
}

/// Rates [rad/s] for a tilt error [rad] about `axis` in the body frame. The polynomials approximate
/// an optimal trajectory in one quadrant of directions; the signs unfold the other three.
fn recovery_rates(tilt: f32, axis: Vector) -> Vector {
    let (direction, signs) = first_quadrant(atan2(axis[0], axis[1]));
    let (x, y) = (tilt, FRAC_PI_2 - direction);
    let roll_share = y / FRAC_PI_2;

    let roll = -3.997 * x + roll_share * roll_share * times_sigmoid(3.997 * x, 4.013 * (2.133 - x));
    let at_pi = exp(2.642f32 * (0.3586 - PI));
    let pitch = (1.38 * y + 0.8725 * (y * y))
        * (times_sigmoid(-1.676 * x, 2.642 * (0.3586 - x))
            + times_sigmoid(1.676 * x * at_pi, 2.642 * (PI - 0.3586)));
    let yaw = (3.168 * y - 0.3913 * (y * y))
        * (times_sigmoid(2.726 * (x - PI), 2.298 * (x - 1.75))
            - times_sigmoid(2.726 * (x - PI), -1.75 * 2.298));

    Vector([roll, pitch, yaw]).times(Vector([-signs[0], -signs[1] * 1.5, -signs[2]]))
}

/// Folds a direction [rad] into the first quadrant. Returns it and the signs of the rates.
fn first_quadrant(direction: f32) -> (f32, Vector) {
    if direction < -FRAC_PI_2 {
        (direction + PI, Vector([-1.0, -1.0, 1.0]))
    } else if direction < 0.0 {
        (-direction, Vector([-1.0, 1.0, -1.0]))
    } else if direction < FRAC_PI_2 {
        (direction, Vector([1.0, 1.0, 1.0]))
    } else {
        (PI - direction, Vector([1.0, -1.0, -1.0]))
    }
}

/// A value times the logistic function of `v`. It is one division, as in the recorded firmware: a
/// product with 1 / (1 + exp(-v)) has other last bits.
fn times_sigmoid(value: f32, v: f32) -> f32 {
    value / (1.0 + exp(-v))
}
