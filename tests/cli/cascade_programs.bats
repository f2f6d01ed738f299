# Programs with the units of the cascade: the starter in Python, all of it or one of its units.

load common

setup_file() {
  export PYTHONDONTWRITEBYTECODE=1 # the starter's folder stays as it is
}

starter="$SOURCE/controller/starters/python_cascade"
both="proc:$PYTHON $starter/port.py"

# without FILE CLASS: makes ./without_FILE, the starter without that unit.
without() {
  cp -r "$starter" "without_$1"
  sed -i "/$2/d" "without_$1/port.py"
  rm "without_$1/$1.py"
}

@test "the starter of the cascade in Python keeps the rules of the exchange" {
  run "$ATTEST" smoke --verbose --port "$both"
  [ "$status" -eq 0 ]
  lacks FAIL
  [ "$(grep -c '^pass' <<<"$output")" -eq 61 ]
}

@test "it agrees with the recorded firmware to the bit, in all profiles" {
  run "$ATTEST" replay --level exact --port "$both" "$SOURCE"/golden/recorded/px4-v1.1[0-9]*/*.csv
  [ "$status" -eq 0 ]
  lacks "not compared"
  [[ $output =~ PASS\ ([0-9]+)\ of\ ([0-9]+) ]]
  [ "${BASH_REMATCH[1]}" -ge 38 ]
}

# Each group of each unit once, at 250 Hz if no rate is named.
cases=(acro/superexpo attitude/tilt_by_azimuth battery/clamped_after_scaling
  estimator_reset/locked_heading_turns_along i_factor/less_integral_with_more_error
  instances/two_together instances/rate_two_together integral_limit/each_axis_and_sign
  landed/disarmed_on_the_ground large_angle/upset_by_azimuth modes/own_replaces_external
  modes/rate_setpoint_is_latched_while_rates_are_off parameters/sticks_in_flight
  parameters/rate_acro_in_flight rate_limit/after_feed_forward
  rates/not_finite_setpoint_holds_the_measured_rate robustness/zero_quaternions
  robustness/rate_gyro@400hz saturation/negative_by_axis spool_up/hover_thrust_slews@50hz
  sticks/yaw_correction timing/jitter timing/rate_jitter yaw_filter/weight_follows_dt
  yaw_weight/beyond_one)

@test "it conforms at the level exact in a case of each group of each unit" {
  local filters=()
  for one in "${cases[@]}"; do
    [[ $one == *@* ]] || one+=@250hz
    filters+=(--filter "px4-v1.16.0/$one")
  done
  run "$ATTEST" run --level exact --port "$both" "${filters[@]}"
  [ "$status" -eq 0 ]
  has "PASS ${#cases[@]} vectors passed, 0 failed"
}

@test "a wrong unit of a program is found in open loop and in flight, and so is its stage" {
  cp -r "$starter" wrong
  sed -i 's/+ self.integral\[i\]$/- self.integral[i]/' wrong/rate_unit.py
  run cmp -s wrong/rate_unit.py "$starter/rate_unit.py"
  [ "$status" -eq 1 ]
  run "$ATTEST" run --port "proc:$PYTHON wrong/port.py" --filter px4-v1.16.0/rates/i_alone@250hz \
    --filter px4-v1.16.0/flight/tilt_step_30@100-400hz-iris-ode
  [ "$status" -eq 1 ]
  has "FAIL 2 of 2 vectors failed"
  has "look first at the rate law"
}

@test "programs with both units or one are flown, and the other unit is the reference's" {
  without attitude_unit AttitudeUnit
  without rate_unit RateUnit
  "$ATTEST" sim sticks --rate 100:400 --plant ode --out want.csv
  for port in "$both" "proc:$PYTHON without_attitude_unit/port.py" \
    "proc:$PYTHON without_rate_unit/port.py"; do
    run "$ATTEST" run --port "$port" --filter 'px4-v1.16.0/flight/sticks@100-400hz-iris-ode'
    [ "$status" -eq 0 ]
    has "PASS 1 vector passed, 0 failed"
    "$ATTEST" sim sticks --rate 100:400 --plant ode --out got.csv --port "$port"
    cmp got.csv want.csv
    cmp got.attitude_unit.csv want.attitude_unit.csv
  done
}

@test "a program that makes one unit at a time does not fly with half of itself" {
  cp -r "$starter" single
  sed -i 's/        if module not in MODULES/        if self.units or module not in MODULES/' \
    single/port.py
  local reason="the port makes no attitude unit while it has a rate unit: create() returned NULL"
  run "$ATTEST" run --port "proc:$PYTHON single/port.py" \
    --filter 'px4-v1.16.0/flight/hover@100-400hz-iris-ode' \
    --filter px4-v1.16.0/attitude/zero_error@250hz --json report.json
  [ "$status" -eq 0 ]
  has "1 vector passed, 0 failed; 1 unsupported"
  grep -q "$reason" report.json
  run "$ATTEST" sim hover --rate 100:400 --plant ode --out none.csv \
    --port "proc:$PYTHON single/port.py"
  [ "$status" -eq 2 ]
  has "$reason"
  run "$ATTEST" stress --case hover --rate 100:400 --duration 0.1 --no-cyclictest --policy other \
    --port "proc:$PYTHON single/port.py"
  [ "$status" -eq 2 ]
  has "$reason"
}

@test "both units of a program fly as scheduled, and a failure has its reason" {
  cascade_tasks 400 100
  run "$ATTEST" schedule tasks.toml --case tilt_step_30 --port "$both" --record-timing t.json
  [ "$status" -eq 0 ]
  run "$ATTEST" run --timing t.json --port "$both"
  [ "$status" -eq 0 ]
  has "PASS 1 vector passed, 0 failed"
  # The metrics hold with this gain.
  run "$ATTEST" schedule tasks.toml --case tilt_step_30 --port fault:cascade-i-of-this-step
  [ "$status" -eq 1 ]
  has "scheduled: fail: "
  has "look first at the rate law"
}

@test "the rate and the delay of a program with both units are searched" {
  run "$ATTEST" sweep-rate --case tilt_step_30 --rate 100:400 --vehicle iris --plant ode \
    --port "$both"
  [ "$status" -eq 0 ]
  [[ $output =~ iris\ +ode\ +[0-9]+\ Hz ]]
}

@test "both units of a program fly in real time, and their outputs agree" {
  run "$ATTEST" stress --case hover --rate 100:400 --duration 0.5 --policy other --no-cyclictest \
    --misses-per-million 1000000 --p99-latency 1000000 --port "$both"
  [ "$status" -eq 0 ] || [[ $output == *"does not step the plant"* ]]
  has "hover@100-400hz-iris-mujoco, rate unit"
  has "hover@100-400hz-iris-mujoco, attitude unit"
  [ "$(grep -c "outputs equal the reference's" <<<"$output")" -eq 2 ]
}
