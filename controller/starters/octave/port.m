% SPDX-License-Identifier: BSD-3-Clause
% The program that attest starts. Requests and answers are lines of JSON: PROTOCOL.md.
1;  % a script, although it begins with functions

function [out, integral] = attitude_step(in, integral)
  rates_sp = attitude_law(in('vehicle_attitude.q', 4), ...
                          in('vehicle_attitude_setpoint.q_d', 4), ...
                          in('vehicle_attitude_setpoint.yaw_sp_move_rate'), ...
                          in('attitude_gains.p', 3), ...
                          in('attitude_gains.rate_max', 3), in('attitude_gains.yaw_weight'));
  out = sprintf(',"out/vehicle_rates_setpoint.%s":%.8e', with_axes(rates_sp){:});
end

function [out, integral] = rate_step(in, integral)
  for name = {'p', 'i', 'd', 'ff', 'integral_max'}
    gains.(name{1}) = in(['rate_gains.' name{1}], 3);
  end
  if in('law.reset')
    integral(:) = 0;
  end
  rates_sp = [in('vehicle_rates_setpoint.roll'), in('vehicle_rates_setpoint.pitch'), ...
              in('vehicle_rates_setpoint.yaw')];
  [torque, integral] = rate_law(integral, gains, in('vehicle_angular_velocity.xyz', 3), ...
                                in('vehicle_angular_velocity.xyz_derivative', 3), ...
                                rates_sp, in('saturation.positive', 3) > 0, ...
                                in('saturation.negative', 3) > 0, in('law.landed'), ...
                                in('law.dt'));
  out = [sprintf(',"out/vehicle_torque_setpoint.xyz[%d]":%.8e', [0:2; torque]), ...
         sprintf(',"out/rate_ctrl_status.%sspeed_integ":%.8e', with_axes(integral){:})];
end

function pairs = with_axes(values)
  pairs = [{'roll', 'pitch', 'yaw'}; num2cell(values)];
end

function values = input_of(request, name, count)
  % An input by its name in attest_law.h, or the first `count` elements of it.
  if nargin < 3
    values = number(request.(['in/' name]));
    return
  end
  values = zeros(1, count, 'single');
  for i = 1:count
    values(i) = number(request.(sprintf('in/%s[%d]', name, i - 1)));
  end
end

function value = number(value)
  if ischar(value)  % "nan" or "inf"
    value = str2double(value);
  end
  value = single(value);
end

folder = fileparts(mfilename('fullpath'));
addpath(folder);
laws = {'attitude_law', 'rate_law'};
profiles = {'px4-v1.14.4', 'px4-v1.15.4', 'px4-v1.16.0', 'px4-v1.17', 'px4-v1.18'};
% fgetl returns a line when the byte after it has arrived. So the handshake comes first, and asks
% for this byte.
hello = struct('protocol', 1, 'name', 'attest-starter-octave', 'version', '1.0', ...
               'frames', 'text', 'byte_after_line', true, 'modules', {laws}, ...
               'profiles', {profiles}, 'files', {strcat(folder, '/', laws, '.m')});
disp(jsonencode(hello));
fflush(stdout);
fgetl(stdin);  % the handshake of attest
steps = {};    % of each unit: the function of its law, and its integrals
integrals = {};
while ischar(line = fgetl(stdin)) && any(line == '{')
  request = jsondecode(line, 'makeValidName', false);
  unit = request.unit;
  result = 'ok';
  out = '';
  if strcmp(request.do, 'create')
    integrals{unit} = zeros(1, 3, 'single');
    if strcmp(request.module, 'rate_law')
      steps{unit} = @rate_step;
    elseif strcmp(request.module, 'attitude_law') && ~strcmp(request.profile, 'px4-v1.18')
      steps{unit} = @attitude_step;  % that of v1.18 has a reference model
    else
      result = 'unsupported';
    end
  elseif strcmp(request.do, 'step')
    in = @(varargin) input_of(request, varargin{:});
    [out, integrals{unit}] = steps{unit}(in, integrals{unit});
    out = regexprep(lower(out), ':(-?inf|nan)', ':"$1"');  % JSON has no such numbers
  end
  printf('{"sequence":%d,"result":"%s"%s}\n', request.sequence, result, out);
  fflush(stdout);
end
