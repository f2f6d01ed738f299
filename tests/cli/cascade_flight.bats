# Flights of the cascade: the attitude unit and the rate unit together, each at its own rate.

load common

@test "a flight of the cascade is flown at a pair of rates, on both plants" {
  run "$ATTEST" sim hover --rate 250:1000 --plant all --html h.html
  [ "$status" -eq 0 ]
  has "px4-v1.18/flight/hover@250-1000hz-iris-mujoco  3000 ticks"
  has "px4-v1.18/flight/hover@250-1000hz-iris-ode  3000 ticks"
  grep -q "Torque setpoint" h.html
  run "$ATTEST" sim hover --rate 250:8000 --plant ode --out flown.csv
  [ "$status" -eq 0 ]
  has "24000 ticks"
}

@test "sim writes a trace of each unit, and replay agrees with both to the bit" {
  "$ATTEST" sim sticks --rate 100:400 --out flown.csv
  head -1 flown.csv | grep -q "out/rate_ctrl_status.rollspeed_integ"
  head -1 flown.attitude_unit.csv | grep -q "out/vehicle_attitude_setpoint.q_d"
  run "$ATTEST" replay --profile px4-v1.18 flown.csv
  has "the attitude unit of this flight is in flown.attitude_unit.csv; to judge both units"
  run "$ATTEST" replay --profile px4-v1.18 --level exact flown.csv flown.attitude_unit.csv
  lacks "to judge both units"
  [ "$status" -eq 0 ]
  "$ATTEST" sim sticks --rate 100:400 --out log.ulg
  run "$ATTEST" replay log.ulg
  [ "$status" -eq 0 ]
  has "the attitude unit of this flight is in log.attitude_unit.ulg; to judge both units"
  run "$ATTEST" replay log.ulg log.attitude_unit.ulg
  [ "$status" -eq 0 ]
  lacks "to judge both units"
}

@test "a pair selects its vectors, and so does the rate of the rate unit" {
  run "$ATTEST" run --filter 'px4-v1.16.0/flight/hover' --rate 250:1000
  [ "$status" -eq 0 ]
  has "PASS 10 vectors passed, 0 failed"
  run "$ATTEST" run --filter 'px4-v1.16.0/flight/hover' --rate 400
  has "PASS 4 vectors passed, 0 failed"
  run "$ATTEST" run --filter 'px4-v1.16.0/flight/hover@50-250hz-iris-ode'
  has "PASS 1 vector passed, 0 failed"
}

@test "a name of both laws is that of the law that flies at the rate" {
  run "$ATTEST" sim hover --rate 250 --out old.csv
  [ "$status" -eq 0 ]
  has "px4-v1.5.5/flight/hover@250hz-iris-mujoco"
  # Of the cascade, one rate is that of the rate unit.
  run "$ATTEST" sim px4-v1.16.0/flight/hover --rate 1000 --out old.csv
  [ "$status" -eq 0 ]
  has "px4-v1.16.0/flight/hover@250-1000hz-iris-mujoco"
  run "$ATTEST" sim hover --profile v1.16 --rate 100 --out old.csv
  [ "$status" -eq 0 ]
  has "px4-v1.16.0/flight/hover@100-100hz-iris-mujoco"
  run "$ATTEST" sim px4-v1.5.5/flight/hover --rate 250:1000 --out old.csv
  [ "$status" -eq 2 ]
  has "is a flight of the controller, which has one rate, as in 1000"
  run "$ATTEST" sim hover --rate 1000:250 --out old.csv
  [ "$status" -eq 2 ]
  has "the rate unit at 250 Hz is slower than the attitude unit at 1000 Hz"
}

@test "a wrong attitude unit is found in flight, with its traces" {
  run "$ATTEST" run --filter 'px4-v1.16.0/flight/tilt_step_30@250-1000hz-iris-*' \
    --port fault:cascade-error-is-angle --save-traces saved
  [ "$status" -eq 1 ]
  has "FAIL 2 of 2 vectors failed"
  has "look first at the attitude law"
  local saved=saved/px4-v1.16.0/flight/tilt_step_30/250-1000hz-iris-ode
  run "$ATTEST" compare $saved.attitude_unit.{got,want}.csv
  [ "$status" -eq 1 ]
  # The rate unit did right with the rates that it was given.
  run "$ATTEST" compare $saved.{got,want}.csv
  [ "$status" -eq 0 ]
}

@test "a wrong rate unit is found in flight" {
  run "$ATTEST" run --filter 'px4-v1.16.0/flight/tilt_step_30@250-1000hz-iris-*' \
    --port fault:cascade-d-reversed
  [ "$status" -eq 1 ]
  has "FAIL 2 of 2 vectors failed"
  has "look first at the rate law"
}

@test "a port of the rate unit flies with the reference's attitude unit" {
  rate_only right
  run "$ATTEST" run --group flight --profile px4-v1.16.0 --rate 50:250 --plant ode \
    --port lib:./right.so
  [ "$status" -eq 0 ]
  has "PASS 16 vectors passed, 0 failed"
  rate_only wrong 's/err\[i\] \/ 6/err[i] \/ 7/; s/6\.98/7.98/'
  run cmp -s right.so wrong.so
  [ "$status" -eq 1 ]
  run "$ATTEST" run --group flight --profile px4-v1.16.0 --rate 50:250 --plant ode \
    --port lib:./wrong.so
  [ "$status" -eq 1 ]
  # It has no unit that flies the controller's cases.
  run "$ATTEST" run --filter 'px4-v1.5.5/flight/hover@250hz-iris-ode' --port lib:./right.so
  [ "$status" -eq 2 ]
}

@test "both units fly as their tasks are scheduled, and the times can be flown again" {
  cascade_tasks 1000 250
  run "$ATTEST" schedule tasks.toml --case tilt_step_30 --record-timing timing.json
  [ "$status" -eq 0 ]
  has "attitude_unit"
  [[ $output =~ delays\ of\ the\ rate\ unit.*delays\ of\ the\ attitude\ unit ]]
  [[ $output =~ sample\ age\ at\ the\ command\ +60\ us\ +60\ us\ +60\ us ]]
  [[ $output =~ setpoint\ after\ the\ release\ +90\ us\ +90\ us\ +90\ us ]]
  [[ $output =~ sample\ age\ at\ the\ setpoint\ +890\ us\ +2\.41\ ms\ +2\.41\ ms ]]
  has "px4-v1.18/flight/tilt_step_30"
  run "$ATTEST" run --timing timing.json
  [ "$status" -eq 0 ]
  has "PASS 1 vector passed, 0 failed"
  run "$ATTEST" run --timing timing.json --port fault:cascade-error-is-angle
  [ "$status" -eq 1 ]
  run "$ATTEST" schedule tasks.toml --case px4-v1.5.5/flight/tilt_step_30
  [ "$status" -eq 2 ]
  has "has [task.attitude_unit], but px4-v1.5.5/flight/tilt_step_30 is a flight of v1.5.5"
  sed -i '/attitude_unit/,/^$/d' tasks.toml
  run "$ATTEST" schedule tasks.toml --case px4-v1.16.0/flight/tilt_step_30
  [ "$status" -eq 2 ]
  has "needs [task.attitude_unit] too"
}

@test "the lowest rate of the rate unit and the largest delay are searched" {
  run "$ATTEST" sweep-rate --case tilt_step_30 --rate 250:1000 --vehicle iris --plant ode
  [ "$status" -eq 0 ]
  has "at 250:1000 Hz"
  has " Hz "
  has " ms"
}

# Real time on a machine with other work: the budgets are wide, so that only outputs can fail.
open=(--duration 0.5 --policy other --no-cyclictest --misses-per-million 1000000
  --p99-latency 1000000)

@test "both units fly in real time, each with a result, and the times can be flown again" {
  run "$ATTEST" stress --case hover --rate 250:1000 "${open[@]}" --record-timing t.json \
    --json s.json --junit s.xml --html s.html
  [ "$status" -eq 0 ] || [[ $output == *"does not step the plant"* ]]
  has "px4-v1.18/flight/hover@250-1000hz-iris-mujoco, rate unit"
  has "px4-v1.18/flight/hover@250-1000hz-iris-mujoco, attitude unit"
  has "of 1 rate hold in real time"
  grep -q "250:1000, attitude unit" s.html
  xmllint --noout --schema "$SOURCE/tests/harness/report/junit.xsd" s.xml
  python3 - <<'CHECK'
import json, os
import jsonschema
report = json.load(open("s.json"))
schema = json.load(open(os.environ["SOURCE"] + "/harness/report/stress.schema.json"))
jsonschema.Draft7Validator(schema).validate(report)
found = [(r["module"], r["deadlines"]) for r in report["results"]]
assert found == [("rate_unit", 500), ("attitude_unit", 125)], found
assert all(r["result"]["deviating_ticks"] == 0 for r in report["results"])
timing = json.load(open("t.json"))
received = [tick[2] for tick in timing["attitude_ticks_ns"] if tick[2] is not None]
begins = {tick[1] for tick in timing["ticks_ns"]}
assert received and set(received) <= begins
CHECK
  run "$ATTEST" run --timing t.json
  [ "$status" -eq 0 ]
  has "PASS 1 vector passed, 0 failed"
  # On a machine that stalls, the recorded flight may miss its bounds.
  for out in one two; do
    run "$ATTEST" sim --timing t.json --out $out.csv
    [ "$status" -le 1 ]
  done
  cmp one.csv two.csv
  cmp one.attitude_unit.csv two.attitude_unit.csv
}

@test "a wrong attitude unit fails in real time" {
  run "$ATTEST" stress --case tilt_step_30 --rate 250:1000 "${open[@]}" \
    --port fault:cascade-error-is-angle --junit s.xml
  [ "$status" -eq 1 ]
  has "look first at the attitude law"
  has "FAIL 0 of 1 rate"
  grep -q "stress --port fault:cascade-error-is-angle --case .*tilt_step_30 --rate 250:1000" \
    s.xml
}

@test "in real time too a port of the rate unit flies with the reference's attitude unit" {
  rate_only right
  run "$ATTEST" stress --case hover --rate 250:1000 "${open[@]}" --port lib:./right.so
  [ "$status" -eq 0 ] || [[ $output == *"does not step the plant"* ]]
  has "hover@250-1000hz-iris-mujoco, rate unit"
  lacks "hover@250-1000hz-iris-mujoco, attitude unit"
  has "note: the attitude unit is that of the reference"
  rate_only wrong 's/err\[i\] \/ 6/err[i] \/ 7/; s/6\.98/7.98/'
  run "$ATTEST" stress --case tilt_step_30 --rate 250:1000 "${open[@]}" --port lib:./wrong.so
  [ "$status" -eq 1 ]
}

@test "a port of the cascade flies its newest release, at one rate or at a pair" {
  rate_only mine
  run "$ATTEST" sim hover mine.so --rate 1000
  [ "$status" -eq 0 ]
  has "px4-v1.18/flight/hover@250-1000hz-iris-mujoco"
  run "$ATTEST" sim hover mine.so --rate 1000 --profile v1.16
  [ "$status" -eq 0 ]
  has "px4-v1.16.0/flight/hover@250-1000hz-iris-mujoco"
  run "$ATTEST" sweep-rate hover mine.so --rate 250 --vehicle iris --plant ode
  [ "$status" -eq 0 ]
  has "delay at 250:250 Hz"
  for profile in v1.18 v1.16.0; do
    run "$ATTEST" stress mine.so --rate 1000 --profile $profile "${open[@]}"
    [ "$status" -eq 0 ] || [[ $output == *"not judged: 250:1000 Hz"* ]]
    has "px4-$profile/flight/hover@250-1000hz-iris-mujoco"
  done
}
