load common

@test "the catalogue is listed, and a fault can be named" {
  run "$ATTEST" faults --list
  [ "$status" -eq 0 ]
  [ "${#lines[@]}" -ge 150 ]
  has "quat-order-xyzw"
  has "auto-by-velocity"
  run "$ATTEST" faults --list --profile px4-v1.3.4
  [ "$status" -eq 0 ]
  has "quat-order-xyzw"
  lacks "auto-by-velocity"
  run "$ATTEST" faults --profile px4-v1.5.5 yaw-dropped tpa-missing
  [ "$status" -eq 0 ]
  has "px4-v1.5.5: 2 faults; 2 of 2"
  run "$ATTEST" faults quat-order-xyz
  [ "$status" -eq 2 ]
  has "did you mean \`quat-order-xyzw\`?"
  run "$ATTEST" run --port fault:nothing
  [ "$status" -eq 2 ]
}

@test "a failure says what mistake it looks like" {
  run "$ATTEST" run --port fault:yaw-weight-dropped --rate 250 --group attitude --group rates \
    --json report.json
  [ "$status" -eq 1 ]
  has "it looks like:"
  has "\`yaw-weight-dropped\`: does not weigh the yaw error (wrong weight; in the stage yaw)"
  tail -n 4 <<<"$output" | grep -q '^  `yaw-weight-dropped`: '
  [[ ${lines[-1]} == "FAIL "* ]]
  grep -q '"fault": "yaw-weight-dropped"' report.json
  run "$ATTEST" run --port fault:yaw-weight-dropped --rate 250 --group attitude --no-diagnose
  lacks "it looks like"
}

@test "a mistake in the sticks is shown in the stage sticks" {
  for fault in acro-pitch-reversed cascade-sticks-exchanged cascade-acro-pitch-reversed; do
    run "$ATTEST" run --port "fault:$fault" --rate 250 --group sticks,acro,modes --no-diagnose \
      --exclude 'px4-v1.14.4/*' --exclude 'px4-v1.15.4/*' --verbose
    [ "$status" -eq 1 ]
    has "look first at the sticks"
    lacks "look first at the attitude law:"
    lacks "look first at the rate law:"
  done
}

@test "each report for CI has the purpose of the most specific failing case" {
  run "$ATTEST" run --port fault:acro-pitch-reversed --rate 250 --group modes --profile px4-v1.5.5 \
    --json report.json --junit report.xml --html report.html
  [ "$status" -eq 1 ]
  lacks "most specific failing case" # because the fault explains all
  why=$(python3 -c 'import json
print(json.load(open("report.json"))["diagnosis"]["specific_case"]["why"])')
  [ -n "$why" ]
  grep -qF "it tests: $why" report.xml
  grep -qF "It tests: $why" report.html
}

@test "a mistake that is in no catalogue is caught and its stage named" {
  run "$ATTEST" run --port "lib:$PORTS/port_blend_from_100.so" --rate 250 --group large_angle
  [ "$status" -eq 1 ]
  has "it looks like no fault of the catalogue"
  has "first stage to differ: attitude law in "
  has "most specific failing case: px4-v1.5.5/"
}

@test "a case file of several releases is named as such" {
  failing=(run --port fault:cascade-d-reversed --filter 'rates/d_alone@250hz' --no-diagnose)
  run "$ATTEST" "${failing[@]}" --profile v1.18
  has "cases/px4-v1.16.0/rates/d_alone.toml (also of px4-v1.18)"
  run "$ATTEST" "${failing[@]}" --profile v1.16
  lacks "also of"
}

@test "all mistakes of a port are listed, also those that act everywhere at once" {
  faults=cascade-rate-dt-fixed+cascade-rates-setpoint-late+cascade-i-of-this-step
  faults+=+cascade-yaw-ff-on-body-z
  run "$ATTEST" run --port "fault:$faults" --profile px4-v1.16.0 --rate 250 --json report.json \
    --group attitude,rate_limit,rates,i_factor,saturation,integral_limit
  [ "$status" -eq 1 ]
  for fault in ${faults//+/ }; do has "\`$fault\`: "; done
  lacks "unexplained"
  lacks "no fault of the catalogue"
  python3 - report.json <<'CHECK'
import json, os, sys
import jsonschema
schema = json.load(open(os.environ["SOURCE"] + "/harness/report/report.schema.json"))
report = json.load(open(sys.argv[1]))
jsonschema.Draft7Validator(schema).validate(report)
assert len(report["diagnosis"]["suspects"]) == 4
assert report["diagnosis"]["unexplained_vectors"] == 0
CHECK
}

@test "of a mistake that is in no catalogue the condition is named" {
  run "$ATTEST" run --port "lib:$PORTS/port_blend_from_100.so" --rate 250 --json report.json \
    --group large_angle,attitude
  [ "$status" -eq 1 ]
  has "in the attitude law: values deviate, only where the tilt error exceeds "
  python3 - report.json <<'CHECK'
import json, os, sys
import jsonschema
schema = json.load(open(os.environ["SOURCE"] + "/harness/report/report.schema.json"))
report = json.load(open(sys.argv[1]))
jsonschema.Draft7Validator(schema).validate(report)
assert report["diagnosis"]["patterns"][0]["stage"] == "attitude law"
CHECK
}

# A port of the cascade with four mistakes in three stages.
@test "mistakes of one stage and exchanged gains are each one line, and nothing is left" {
  faults=cascade-i-without-dt+cascade-roll-pitch-gains+cascade-i-reversed+cascade-d-missing
  run "$ATTEST" run --port "fault:$faults" --profile px4-v1.16.0 --rate 250 \
    --group attitude,rates,i_factor,integral_limit,parameters
  [ "$status" -eq 1 ]
  for fault in ${faults//+/ }; do has "\`$fault\`: "; done
  lacks "-of-roll"
  lacks "-of-pitch"
  lacks "do not explain"
}

# The port has rate gains that are 3% too low. It fails where a case sets them, which says nothing.
@test "a parameter that the failing cases set is not named as the condition" {
  run "$ATTEST" run --port "lib:$PORTS/port_gains_off.so" --rate 250 --profile px4-v1.5.5 \
    --group rates,parameters,anti_windup --json report.json
  [ "$status" -eq 1 ]
  has "failing vectors deviate first in the rate law"
  has "in the rate law: values about roll and pitch deviate"
  lacks "only where MC_"
  python3 - report.json <<'CHECK'
import json, sys
report = json.load(open(sys.argv[1]))
found = report["diagnosis"]
stages = {r["first"]["stage"] for r in report["results"] if "first" in r}
assert stages == {p["stage"] for p in found["patterns"]} == set(found["first_stages"])
CHECK
}

@test "a port that crashes is not diagnosed, and does not end the run" {
  run "$ATTEST" run --port "lib:$PORTS/port_crash.so" --rate 250 --group rates
  [ "$status" -eq 1 ]
  lacks "it looks like"
}

@test "two faults at once are a port, not a line of the table" {
  run "$ATTEST" faults tpa-missing+yaw-dropped
  [ "$status" -eq 2 ]
  has "attest run --port fault:tpa-missing+yaw-dropped"
  run "$ATTEST" faults --diagnose tpa-missing
  [ "$status" -eq 2 ]
}

@test "the schema of the report knows every stage" {
  for fault in mixer-roll-left battery-status-pack; do
    "$ATTEST" run --group mixer --group battery_status --port "fault:$fault" --no-diagnose \
      --json "$fault.json" || true
    python3 - "$fault.json" <<'CHECK'
import json, os, sys
import jsonschema
schema = json.load(open(os.environ["SOURCE"] + "/harness/report/report.schema.json"))
report = json.load(open(sys.argv[1]))
assert any("first" in result for result in report["results"])
jsonschema.Draft7Validator(schema).validate(report)
CHECK
  done
}

@test "the log of a flight shows some faults" {
  "$PYTHON" "$SOURCE/tests/cli/cascade_log.py" sparse.ulg --thin vehicle_angular_velocity=20 \
    --thin vehicle_torque_setpoint=20 --thin vehicle_thrust_setpoint=20
  run "$ATTEST" faults --log sparse.ulg cascade-d-reversed cascade-m-not-canonical \
    cascade-i-missing tpa-missing
  [ "$status" -eq 0 ]
  has '| `cascade-d-reversed` | adds D instead of subtracting it | rate unit |'
  has "without the canonical form of the quaternion | attitude unit |"
  has "sparse.ulg: of 3 faults of px4-v1.16.0, 2 fail (67%)"
  run "$ATTEST" faults --log sparse.ulg --level exact
  [ "$status" -eq 2 ]
  run "$ATTEST" faults --log nothing.ulg
  [ "$status" -eq 2 ]
  has "nothing.ulg"
}

@test "a log with which the reference does not agree shows the faults that agree with it" {
  "$ATTEST" sim gust --port fault:cascade-d-reversed --rate 250:1000 --out flown.ulg
  run "$ATTEST" faults --log flown.ulg cascade-d-reversed cascade-i-missing
  [ "$status" -eq 1 ]
  has "the reference does not agree with this log, so it does not show which faults a port can have"
  has "rate unit: differs from tick 1 on, first in out/vehicle_torque_setpoint.xyz[0]"
  has '| `cascade-d-reversed` | adds D instead of subtracting it |'
  lacks '`cascade-i-missing`'
  has "flown.ulg: of 2 faults of px4-v1.18, 1 agrees with the log"
  lacks "A port can have the others"
}

@test "a log of PX4 with which the reference does not agree shows the faults that do" {
  write() { "$PYTHON" "$SOURCE/tests/cli/cascade_log.py" "$@" --port fault:cascade-d-reversed; }
  local thin=(--thin vehicle_angular_velocity=20 --thin vehicle_torque_setpoint=20)
  write sparse.ulg "${thin[@]}" --thin vehicle_thrust_setpoint=20 --without vehicle_attitude
  write whole.ulg
  faults() { run "$ATTEST" faults --log "$1" cascade-d-reversed cascade-i-missing; }
  agrees() {
    has "  rate unit: only 0.0% of the reference's vehicle_torque_setpoint are within 0.0001 of the"
    has "| agrees with the log | what it does |"
    [ "${lines[-2]}" = '| `cascade-d-reversed` | adds D instead of subtracting it |' ]
    ends "$1: of 2 faults of px4-v1.16.0, 1 agrees with the log"
    lacks "A port can have the others"
  }
  faults sparse.ulg
  [ "$status" -eq 1 ]
  has "sparse.ulg: the reference does not agree with this log"
  agrees sparse.ulg
  # The attitude unit of the log is judged.
  faults whole.ulg
  [ "$status" -eq 0 ]
  has "whole.ulg: the reference does not agree with a unit of this log"
  agrees whole.ulg
}

@test "a log that judges no unit shows no fault" {
  "$PYTHON" "$SOURCE/tests/cli/cascade_log.py" short.ulg --thin vehicle_attitude=100 \
    --thin vehicle_angular_velocity=1000
  run "$ATTEST" faults --log short.ulg cascade-d-reversed
  [ "$status" -eq 2 ]
  has "short.ulg: shows no mistake of a port: attitude unit: the log has all inputs of only "
}

@test "hunts are compared with the suite, as attest hunt finds the faults" {
  compare() {
    "$ATTEST" -q faults --profile v1.16.0 --hunt 1,400000 "$@" cascade-d-reversed \
      cascade-tilt-filter-kept cascade-rate-infinite-kept
  }
  compare --jobs 1 >one.txt
  compare --jobs 2 >two.txt
  cmp one.txt two.txt
  output=$(cat one.txt)
  has "| fault | what it does | suite | hunt, 1 step | hunt, 400000 steps |"
  has "| adds D instead of subtracting it | rates/d_alone@250hz | found | found |"
  has "| does not clear the filter of the tilt in other modes |"
  has "| sticks/tilt_filter_starts_again@250hz | | found |"
  has "of 3 detectable faults the suite catches 3, a hunt of 1 step 1, a hunt of 400000 steps 2;"
  has 'Only by the suite: `cascade-rate-infinite-kept`.'
  hunt=("$ATTEST" -q hunt --profile v1.16.0 --port fault:cascade-tilt-filter-kept)
  "${hunt[@]}" --steps 1
  run "${hunt[@]}" --steps 400000 --fail-fast
  [ "$status" -eq 1 ]
  run "$ATTEST" faults --hunt 1 --level events
  [ "$status" -eq 2 ]
  has "--level events: a hunt compares values or bits"
}

# Of the faults that bound dt on one side only, one takes the place of the fault that has no bound.
@test "a fault is named although another one that takes its place explains a vector more" {
  cp "$SOURCE"/controller/starters/c/*.[ch] .
  sed -i '/dt = dt < 0.002f/d' unit.c
  cc -shared -fPIC -O2 -ffp-contract=off "-I$SOURCE/controller" ./*.c -lm -o port.so
  run "$ATTEST" run port.so --rate 100 --profile px4-v1.5.5
  [ "$status" -eq 1 ]
  has "\`dt-unclamped\`: does not bound dt"
}
