load common

# For tests that need many cases: groups without flights, which take seconds (flight.bats).
open_loop=(--group anti_windup --group modes --group arming --group attitude --group robustness
  --rate 50 --rate 333 --rate 1000)

@test "a port that is a tick late is the same at the events level only" {
  run "$ATTEST" run --level events "${open_loop[@]}" --port fault:outputs-late
  [ "$status" -eq 0 ]
  run "$ATTEST" run "${open_loop[@]}" --port fault:outputs-late --no-diagnose -q
  [ "$status" -eq 1 ]
}

@test "an event that does not happen is named with its tick" {
  run "$ATTEST" run --level events --group anti_windup --rate 250 --port fault:gate-yaw-dropped \
    --no-diagnose
  [ "$status" -eq 1 ]
  has "yaw_rate_integ is moving, expected still within a tick"
}

@test "at the level events the mistake of a port is named, also if the port is coarse" {
  run "$ATTEST" run --level events --profile px4-v1.5.5 --rate 250 --exclude '*/flight/*' \
    --port fault:tpa-missing
  [ "$status" -eq 1 ]
  has "\`tpa-missing\`"
  lacks "within about the bounds"
  # The C starter with outputs that are multiples of 1/1024, and the wrong sign of the yaw error.
  cp -r "$SOURCE/controller/starters/c" coarse
  sed -i -e 's|isfinite(u\[i\]) ? u\[i\]|isfinite(u[i]) ? roundf(u[i] * 1024) / 1024|' \
    -e 's|\(setpoint.[a-z]* = \)\(c->rates_sp\[.\]\);|\1roundf(\2 * 1024) / 1024;|' coarse/unit.c
  sed -i 's/dot(x_rp, x_sp)) \* yaw_w/dot(x_rp, x_sp)) * -yaw_w/' coarse/attitude.c
  cc -O2 -std=c11 -fPIC -shared -I"$SOURCE/controller" -o coarse.so coarse/*.c -lm
  run "$ATTEST" run --level events --port lib:./coarse.so --profile px4-v1.5.5 --rate 250 \
    --group attitude,rates,rate_limit
  [ "$status" -eq 1 ]
  has "\`yaw-reversed\`"
  has "a listed fault has the port's values within about the bounds of the level events only"
}

@test "groups that a port declares not to do are counted apart, never as conformant" {
  run "$ATTEST" run --group tailsitter --group tpa --port "lib:$PORTS/port_no_tailsitter.so"
  [ "$status" -eq 0 ]
  has "unsupported: the port declares that it does not support tailsitter"
  has "partial: px4-v1.5.5, numeric, 11 rates, group tpa (because: only --group"
}

@test "a case that is compared at the level exact only still judges crashes and failures" {
  for level in numeric events; do
    nan_limit() {
      run "$ATTEST" run --port "lib:$PORTS/port_nan_limit_$1.so" --level $level --no-diagnose \
        --filter 'px4-v1.5.5/robustness/parameters_limits@250hz' \
        --filter 'px4-v1.5.5/rates/*_alone@250hz' --json report.json
    }
    nan_limit aborts
    [ "$status" -eq 1 ]
    has "crash: the port's process was killed by signal 6 (Aborted) in step() at tick 4"
    nan_limit fails
    [ "$status" -eq 1 ]
    has "fail: step at tick 4 returned ATTEST_FAILED; it last printed: limit out of range"
    nan_limit refuses
    has "1 skip"
    grep -q '"exact_only": true' report.json
  done
  run "$ATTEST" run --port "lib:$PORTS/port_nan_limit_refuses.so" --level exact --no-diagnose \
    --filter 'px4-v1.5.5/robustness/parameters_limits@250hz'
  [ "$status" -eq 1 ]
  has "fail: set_parameter(MC_ROLLRATE_MAX) at tick 4 returned ATTEST_INVALID"
}

@test "a run at the level events does not say that a port conforms" {
  run "$ATTEST" run --level events --group mixer --json report.json --badge badge.svg
  [ "$status" -eq 0 ]
  has "partial: px4-v1.5.5, events"
  grep -q '"standing": "partial"' report.json
}

@test "the faults that a level catches are counted" {
  run "$ATTEST" faults --profile px4-v1.5.5 --level numeric yaw-weight-dropped tpa-missing
  [ "$status" -eq 0 ]
  has "px4-v1.5.5, level numeric: 2 of 2 detectable faults are caught"
}

@test "a mixer has no events: it is judged by its values at that level too" {
  run "$ATTEST" run --level events --group mixer --port fault:mixer-output-0-to-1 --no-diagnose
  [ "$status" -eq 1 ]
  run "$ATTEST" run --level events --group mixer --group battery_status
  [ "$status" -eq 0 ]
}

# In attest's process, because the judge is what is tested: a process for each vector takes longer.
units=(--level events --profile px4-v1.16.0 --exclude '*/flight/*' --rate 250 --no-diagnose
  --in-process)

@test "units of the cascade are judged by their events: right ones conform" {
  for port in builtin "lib:$PORTS/reference_double.so" "lib:$PORTS/reference_fma_gcc.so" \
    "lib:$(dirname "$STARTER")/../c_cascade/attest_starter_c_cascade.so"; do
    run "$ATTEST" run "${units[@]}" --port "$port"
    echo "$port: $output"
    [ "$status" -eq 0 ]
    has "px4-v1.16.0, events"
  done
}

@test "wrong units of the cascade do not conform at the events level" {
  for fault in m-not-canonical quat-order-xyzw error-reversed acro-not-published acro-in-each-step \
    integral-on-the-ground disarmed-keeps-integral d-reversed ff-reversed; do
    run "$ATTEST" run "${units[@]}" --fail-fast --port "fault:cascade-$fault"
    echo "$fault: $output"
    [ "$status" -eq 1 ]
  done
  run "$ATTEST" run --level events --profile px4-v1.16.0 --group landed --rate 250 --no-diagnose \
    --port fault:cascade-integral-on-the-ground
  has "_integ is rising, expected not rising within a tick"
}

@test "a trace of a unit is replayed and compared at the events level" {
  "$ATTEST" record px4-v1.16.0/rates/i_alone --rate 250 --out trace.csv
  run "$ATTEST" replay trace.csv --profile px4-v1.16.0 --level events
  [ "$status" -eq 0 ]
  run "$ATTEST" compare trace.csv trace.csv --level events
  [ "$status" -eq 0 ]
  "$ATTEST" record px4-v1.16.0/rates/i_alone --rate 250 --out wrong.csv \
    --port fault:cascade-rate-error-reversed
  run "$ATTEST" compare wrong.csv trace.csv --level events
  [ "$status" -eq 1 ]
}
