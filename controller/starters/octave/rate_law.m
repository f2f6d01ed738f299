% SPDX-License-Identifier: BSD-3-Clause
function [torque, integral] = rate_law(integral, gains, rates, derivative, rates_sp, ...
                                       positive, negative, landed, dt)
  % The torque about body x, y, z from the rates [rad/s], and the next integral of each axis.
  %
  % gains has p, i, d, ff and integral_max. derivative is that of the rates [rad/s^2]. positive and
  % negative are flags: the motors cannot give more torque about that axis in that direction.
  % landed is a flag, dt is in s. All numbers are single. The order of each sum and product is part
  % of the law: another order changes the last bits.
  error_rate = rates_sp - rates;
  torque = gains.p .* error_rate + integral - gains.d .* derivative + gains.ff .* rates_sp;
  if landed
    return
  end
  % No integral against a saturated motor. A NaN becomes 0 here.
  error_rate(positive) = min(error_rate(positive), 0);
  error_rate(negative) = max(error_rate(negative), 0);
  ratio = error_rate / single(6.98131704);  % 400 deg/s: too large to integrate
  share = max(1 - ratio .* ratio, 0);       % the larger the error, the less integral
  total = integral + share .* gains.i .* error_rate * dt;
  limited = min(max(total, -gains.integral_max), gains.integral_max);
  integral(isfinite(total)) = limited(isfinite(total));
end
