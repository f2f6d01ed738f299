% SPDX-License-Identifier: BSD-3-Clause
function rates_sp = attitude_law(q, q_d, yaw_rate, p, rate_max, yaw_weight)
  % The rates setpoint [rad/s] from an attitude and its setpoint, which may have any norm.
  %
  % World is NED, body is FRD. Quaternions are [w x y z], body to world; the others are about body
  % x, y, z. yaw_rate [rad/s] is about the world's z, and is added to the result. It is ignored if
  % it is not finite. p is in 1/s, rate_max in rad/s. yaw_weight (0 .. 1) says how much yaw counts
  % compared with roll and pitch. All numbers are single. The order of each sum and product is part
  % of the law: another order changes the last bits.
  q_d = unit(q_d);
  weight = clamp(yaw_weight, 0, 1);
  % Tilt first, then as much of the yaw error as the weight says.
  reduced = tilted(q, q_d);
  mix = clamp(canonical(product(inverse(reduced), q_d)), -1, 1);
  % In double and then rounded, a function has the nearest single.
  half_angle = weight * single(acos(double(mix(1))));
  half_angle_z = weight * single(asin(double(mix(4))));
  yaw = single([cos(double(half_angle)) 0 0 sin(double(half_angle_z))]);
  error_q = canonical(product(inverse(q), product(reduced, yaw)));
  % The weight made the yaw error smaller. This gain makes up for it.
  if weight > single(1e-4)
    p(3) = p(3) / weight;
  end
  rates_sp = error_q(2:4) * 2 .* p;
  if isfinite(yaw_rate)
    rates_sp = rates_sp + z_axis(inverse(q)) * yaw_rate;  % the world's z in the body frame
  end
  rates_sp = clamp(rates_sp, -rate_max, rate_max);
end

function r = tilted(q, q_d)
  % The attitude that has the thrust direction of q_d, and the heading of q as far as it can.
  tilt = between(z_axis(q), z_axis(q_d));
  if any(abs(tilt(2:3)) > single(0.999989986))  % opposite
    r = q_d;
  else
    r = product(tilt, q);
  end
end

function r = between(a, b)
  % The shortest rotation that turns a into b. If they are opposite, half a turn about an axis.
  axis_ab = cross_product(a, b);
  w = sum(a .* b);
  if sqrt(sum(axis_ab .* axis_ab)) < single(1e-5) && w < 0
    [~, least] = min(abs(a([3 2 1])));  % the last of equal ones
    e = zeros(1, 3, 'single');
    e(4 - least) = 1;
    r = unit([0 cross_product(a, e)]);
  else
    r = unit([w + sqrt(sum(a .* a) * sum(b .* b)), axis_ab]);
  end
end

function z = z_axis(q)
  % The z axis of the rotated frame: of body to world, the direction opposite to thrust.
  z = [2 * (q(1) * q(3) + q(2) * q(4)), 2 * (q(3) * q(4) - q(1) * q(2)), ...
       q(1) * q(1) - q(2) * q(2) - q(3) * q(3) + q(4) * q(4)];
end

function q = canonical(q)
  % Of the two quaternions of a rotation, the one whose first component other than 0 is positive.
  first = find(abs(q) > single(2)^-23, 1);
  if ~isempty(first) && q(first) < 0
    q = -q;
  end
end

function q = unit(q)
  q = q * (1 / sqrt(sum(q .* q)));
end

function r = inverse(q)
  r = [q(1) -q(2:4)] / sum(q .* q);
end

function r = product(q, p)
  r = [q(1)*p(1) - q(2)*p(2) - q(3)*p(3) - q(4)*p(4), ...
       q(2)*p(1) + q(1)*p(2) - q(4)*p(3) + q(3)*p(4), ...
       q(3)*p(1) + q(4)*p(2) + q(1)*p(3) - q(2)*p(4), ...
       q(4)*p(1) - q(3)*p(2) + q(2)*p(3) + q(1)*p(4)];
end

function c = cross_product(a, b)
  c = [a(2)*b(3) - a(3)*b(2), -a(1)*b(3) + a(3)*b(1), a(1)*b(2) - a(2)*b(1)];
end

function r = clamp(x, low, high)
  % Passes NaN.
  r = min(max(x, low), high);
  r(isnan(x)) = NaN;
end
