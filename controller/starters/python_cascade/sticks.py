# SPDX-License-Identifier: BSD-3-Clause
"""Stabilized mode: the sticks make an attitude setpoint.

Tilt is the same in all profiles except for its filter. Heading and throttle have a class for each
version of the law, which holds their state. `Vehicle` is the state of the vehicle.
"""

from binary32 import EPSILON, HALF, NAN, ONE, TWO, ZERO, Binary32, is_finite
from parameters import PX4_V114, PX4_V115, PX4_V116, PX4_V117, PX4_V118
from rotation import (
    DOWN,
    between,
    heading_of,
    heading_of_in_v114,
    inverse,
    norm,
    of_heading,
    of_rotation_vector,
    product,
    times,
    z_axis,
)
from scalar import (
    LowPass,
    LowPassOfV114,
    clamp,
    dead_zone,
    expo,
    line,
    radians,
    slewed,
    smaller,
    wrap,
)

IDLE_THROTTLE = Binary32(-0.9)
YAW_EXPO = Binary32(0.6)  # since v1.17
CONVERGED = Binary32(0.0174532924)  # [rad], a degree
LARGE_FOR_INT = Binary32(2.0**31)


class Vehicle:
    """From the latest samples. Before the first ones: a multicopter on the ground."""

    def __init__(self):
        self.is_rotary_wing = True
        self.is_vtol = self.is_tailsitter = self.is_in_transition = False
        self.has_spooled_up = False
        self.is_landed = True
        self.has_good_heading = True
        self.unaided_heading = NAN  # [rad] of the gyros alone; used if finite

    def flies_as_multicopter(self):
        if self.is_in_transition:
            return self.is_tailsitter
        return self.is_rotary_wing


def _resets_heading(throttle, parameters):
    """At idle the vehicle may be on the ground, and be turned by hand."""
    return throttle < IDLE_THROTTLE and parameters["MC_AIRMODE"] != TWO


class LockedHeading:
    """v1.16: locks the heading while the yaw stick is in its middle, corrected for the drift that
    the estimator's heading has against that of the gyros."""

    def __init__(self):
        self.setpoint = ZERO  # NaN if no heading is locked
        self.reference = self.correction = ZERO
        self.is_converging = False
        self.drift = LowPass()
        self.rate = LowPass()

    def update(self, sticks, vehicle, q, p, dt):
        """The heading to hold [rad], and the yaw rate [rad/s]."""
        if _resets_heading(sticks.throttle, p) or not vehicle.has_good_heading:
            self.setpoint = NAN
        heading = heading_of(q)
        before = self.correction
        self.correction = self._corrected(heading, vehicle.unaided_heading, dt)
        stick = self._stick(sticks.yaw, p)
        rate = self.rate.update(p["MPC_MAN_Y_TAU"], dt, stick * radians(p["MPC_MAN_Y_MAX"]))
        if abs(rate) > EPSILON:
            self.setpoint = NAN
        elif not is_finite(self.setpoint):
            self.setpoint = heading
        else:
            self.setpoint = wrap(self.setpoint - before + self.correction)
        return (self.setpoint if is_finite(self.setpoint) else heading), rate

    def _stick(self, yaw, p):
        return expo(dead_zone(yaw, p["MPC_HOLD_DZ"]), p["MPC_YAW_EXPO"])

    def _corrected(self, heading, unaided, dt):
        if not is_finite(unaided):
            return ZERO
        drift = wrap(heading - unaided)
        change = wrap(drift - self.drift.state)
        self.drift.update(ONE, dt, drift)
        was_converging = self.is_converging
        self.is_converging = abs(change) > CONVERGED
        if not self.is_converging:
            self.reference = drift
            if was_converging:
                self.setpoint = NAN
        return wrap(drift - self.reference)

    def rest(self, vehicle, q):
        """A step in which the sticks do not make the setpoint."""
        self.setpoint = NAN
        if is_finite(vehicle.unaided_heading):
            self.drift.state = wrap(heading_of(q) - vehicle.unaided_heading)

    def turn(self, rotation):
        """The estimator turned the attitude."""
        angle = heading_of(rotation)
        if is_finite(self.setpoint):
            self.setpoint = wrap(self.setpoint + angle)
        self.drift.state = wrap(self.drift.state + angle)
        self.reference = wrap(self.reference + angle)

    def end_step(self, has_used_sticks, vehicle):
        pass


class LockedHeadingOfV117(LockedHeading):
    """The dead zone has another name, and the curve of the stick is fixed."""

    def _stick(self, yaw, p):
        return expo(dead_zone(yaw, p["MAN_DEADZONE"]), YAW_EXPO)


class LockedHeadingOfV118(LockedHeadingOfV117):
    """The correction keeps its value while the heading of the gyros is lost, and starts anew when
    it is back: how the two headings changed without it is not known."""

    def __init__(self):
        super().__init__()
        self.is_lost = False  # in the last step that used the sticks

    def _corrected(self, heading, unaided, dt):
        was_lost = self.is_lost
        self.is_lost = not is_finite(unaided)
        if self.is_lost:
            return self.correction
        if not was_lost:
            return super()._corrected(heading, unaided, dt)
        self.drift.state = self.reference = wrap(heading - unaided)
        self.is_converging = False
        self.setpoint = NAN
        return ZERO


class IntegratedHeading:
    """v1.14 and v1.15: the integral of the yaw rate."""

    def __init__(self, heading_of):
        self.heading_of = heading_of
        self.heading = ZERO
        self.is_reset = True

    def update(self, sticks, vehicle, q, p, dt):
        """The heading to hold [rad], and the yaw rate [rad/s]."""
        rate = sticks.yaw * radians(p["MPC_MAN_Y_MAX"])
        if self.is_reset or _resets_heading(sticks.throttle, p):
            self.heading = self.heading_of(q)
        else:
            self.heading = wrap(self.heading + rate * dt)
        return self.heading, rate

    def rest(self, vehicle, q):
        pass

    def turn(self, rotation):
        """The estimator turned the attitude."""
        self.heading = wrap(self.heading + self.heading_of(rotation))

    def end_step(self, has_used_sticks, vehicle):
        in_transition = vehicle.is_vtol and vehicle.is_in_transition
        self.is_reset = not has_used_sticks or not vehicle.has_good_heading or in_transition


class Throttle:
    """Since v1.15 the limits of the thrust rise slowly after take-off and arming. Since v1.16 the
    hover thrust moves slowly, too. `estimate` is that of the hover thrust, NaN in v1.15."""

    def __init__(self):
        self.least = self.most = ZERO
        self.hover = None  # of the parameter, from the first reading on

    def read(self, p, estimate):
        if not is_finite(estimate):
            self.hover = p["MPC_THR_HOVER"]

    def thrust(self, stick, p):
        full = p["MPC_THR_MAX"]
        if p["MPC_THR_CURVE"] == ONE:
            return smaller(line(stick, -ONE, ONE, self.least, full), self.most)
        hover = p["MPC_THR_HOVER"] if p["MPC_THR_CURVE"] == TWO else self.hover
        if stick > ZERO:
            return smaller(line(stick, ZERO, ONE, hover, full), self.most)
        return smaller(line(stick, -ONE, ZERO, self.least, hover), self.most)

    def end_step(self, vehicle, p, estimate, dt):
        per_second = Binary32(0.05)
        least = ZERO if vehicle.is_landed else p["MPC_MANTHR_MIN"]
        self.least = slewed(self.least, per_second, dt, least)
        self.most = slewed(self.most, HALF, dt, ONE) if vehicle.has_spooled_up else ZERO
        if is_finite(estimate):
            self.hover = slewed(self.hover, per_second, dt, estimate)


class ThrottleOfV114:
    def read(self, p, estimate):
        pass

    def thrust(self, stick, p):
        least, hover, full = p["MPC_MANTHR_MIN"], p["MPC_THR_HOVER"], p["MPC_THR_MAX"]
        s = (stick + ONE) * HALF
        if p["MPC_THR_CURVE"] == ONE:
            return line(s, ZERO, ONE, least, full)
        # NaN and numbers too large for int use the lower line, as a conversion to int on x86.
        if ONE <= s * TWO < LARGE_FOR_INT:
            return line(s, HALF, ONE, hover, full)
        return line(s, ZERO, HALF, least, hover)

    def end_step(self, vehicle, p, estimate, dt):
        pass


_HEADINGS = {
    PX4_V114: lambda: IntegratedHeading(heading_of_in_v114),
    PX4_V115: lambda: IntegratedHeading(heading_of),
    PX4_V116: LockedHeading,
    PX4_V117: LockedHeadingOfV117,
    PX4_V118: LockedHeadingOfV118,
}


class Sticks:
    def __init__(self, profile):
        low_pass = LowPassOfV114 if profile == PX4_V114 else LowPass
        self.roll = low_pass()
        self.pitch = low_pass()
        self.throttle = ThrottleOfV114() if profile == PX4_V114 else Throttle()
        self.heading = _HEADINGS[profile]()

    def setpoint(self, sticks, vehicle, q, p, dt):
        """q_d, yaw rate and thrust for the attitude q. `p` are the parameters, dt is in s."""
        heading, yaw_rate = self.heading.update(sticks, vehicle, q, p, dt)
        tilt = self._tilt(sticks, p, dt)
        turn = of_heading(heading)
        if vehicle.is_vtol:
            tilt = _for_the_present_heading(tilt, turn, q)
        thrust = self.throttle.thrust(sticks.throttle, p)
        return product(turn, tilt), yaw_rate, (ZERO, ZERO, -thrust)

    def _tilt(self, sticks, p, dt):
        most = radians(p["MPC_MAN_TILT_MAX"])
        tau = p["MC_MAN_TILT_TAU"]
        v = (
            self.roll.update(tau, dt, sticks.roll * most),
            -self.pitch.update(tau, dt, sticks.pitch * most),
        )
        angle = norm(v)
        if angle > most:
            v = times(v, most / angle)
        return of_rotation_vector((*v, ZERO))

    def reset_tilt(self):
        self.roll.state = self.pitch.state = ZERO


def _for_the_present_heading(tilt, turn, q):
    """The tilt is relative to the present heading. Returns it relative to the heading `turn`."""
    present = product(inverse(between(DOWN, z_axis(q))), q)
    return between(DOWN, z_axis(product(product(inverse(turn), present), tilt)))
