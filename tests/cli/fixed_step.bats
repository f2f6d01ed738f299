load common

right() { echo "lib:$PORTS/port_fixed_step.so"; }

groups=(--group attitude --group rates --group timing --group mixer)

@test "a port with a fixed step passes at its rate, and the statement names the step" {
  run "$ATTEST" run "${groups[@]}" --port "$(right)" --json report.json --junit junit.xml
  [ "$status" -eq 0 ]
  has "fixed step of 250 Hz: cases begin one period after zero"
  has "the port has a fixed step of 250 Hz, and this runs at another rate"
  has "the port has a fixed step of 250 Hz, and this has late or missing ticks"
  has "the port has a fixed step of 250 Hz, and this has a start_s of its own"
  has "partial: px4-v1.5.5, numeric, fixed step of 250 Hz, groups attitude, rates"
  has "(because: fixed step of 250 Hz;"
  grep -q '"fixed_step": "250"' report.json
  grep -q 'name="port.fixed_step" value="250"' junit.xml
}

@test "its period being whole microseconds, it conforms to the bit" {
  run "$ATTEST" run --level exact --profile px4-v1.5.5 --group attitude --group rates --rate 250 \
    --port "$(right)"
  [ "$status" -eq 0 ]
  lacks "unsupported"
}

@test "a port with a fixed step flies" {
  run "$ATTEST" run --filter '*/hover@*-iris-mujoco' --filter '*/jitter_uniform@*-iris-mujoco' \
    --port "$(right)"
  [ "$status" -eq 0 ]
  has "PASS 2 vectors passed, 0 failed; 34 "
  has "has late or missing ticks"
}

@test "a fixed step does not hide a gain that is off" {
  wrong="lib:$PORTS/port_fixed_step_gain_off.so"
  run "$ATTEST" run --group rates --rate 250 --port "$wrong"
  [ "$status" -eq 1 ]
  has "out/actuator_controls_0.control[0]"
  run "$ATTEST" run --filter '*/flip_150_level@250hz-iris-mujoco' --port "$wrong"
  [ "$status" -eq 1 ]
}

@test "a golden that the reference does not agree with is not shifted" {
  blessed_suite
  golden=suite/golden/px4-v1.5.5/attitude/roll.csv
  awk -F, -v OFS=, 'NR > 1 && $1 != "" { $10 = 0.25 } 1' $golden >changed.csv
  mv changed.csv $golden
  accept_edit $golden
  run "$ATTEST" --suite suite run --rate 250 --port "$(right)"
  [ "$status" -eq 2 ]
  has "does not agree with the golden, so the expected outputs at other times"
}

@test "a trace that was recorded at other times is not given to it" {
  run "$ATTEST" replay --port "$(right)" "$SOURCE/golden/recorded/px4-v1.5.5/fuzz_250hz.csv"
  has "was not recorded at its steps"
}

@test "both units of the cascade keep a fixed step" {
  run "$ATTEST" run --port "lib:$PORTS/port_fixed_step_cascade.so" --profile px4-v1.16.0 \
    --group timing --group sticks --group rates --group instances
  [ "$status" -eq 0 ]
  has "the port has a fixed step of 250 Hz, and this has late or missing ticks"
  has "the port has a fixed step of 250 Hz, and this has samples that were taken at other times"
  has "the port has a fixed step of 250 Hz, and this has a start_s of its own"
  has "partial: px4-v1.16.0, numeric, fixed step of 250 Hz, groups instances, rates"
  run "$ATTEST" run --port "lib:$PORTS/port_fixed_step_cascade.so" --filter '*/hover@*-iris-ode' \
    --profile px4-v1.16.0
  has "the port has a fixed step of 250 Hz, and this does not run both units at each of these steps"
}

@test "a fixed step does not hide a gain of the rate unit that is off" {
  run "$ATTEST" run --group rates --rate 250 --port "lib:$PORTS/port_fixed_step_cascade_gain_off.so"
  [ "$status" -eq 1 ]
  has "out/vehicle_torque_setpoint.xyz[0]"
}

@test "vectors for a fixed step of the cascade begin one period after zero" {
  "$ATTEST" vectors vectors --fixed-step 250 --group rates --profile px4-v1.16.0 >/dev/null
  [ -z "$(find vectors -name '*.csv' ! -name 250hz.csv)" ]
  run cut -d , -f 1 vectors/px4-v1.16.0/rates/p_alone/250hz.csv
  [ "${lines[1]} ${lines[2]}" = "4000 8000" ]
}
