load common

@test "the catalogue is listed, and a fault can be named" {
  run "$ATTEST" faults --list
  [ "$status" -eq 0 ]
  [ "${#lines[@]}" -ge 150 ]
  has "quat-order-xyzw"
  run "$ATTEST" faults yaw-dropped tpa-missing
  [ "$status" -eq 0 ]
  has "px4-v1.5.5: 2 faults; 2 of 2"
  run "$ATTEST" faults quat-order-xyz
  [ "$status" -eq 2 ]
  has "did you mean \`quat-order-xyzw\`?"
  run "$ATTEST" run --port fault:nothing
  [ "$status" -eq 2 ]
}

@test "a fault is judged by the profiles that can tell it" {
  run "$ATTEST" faults --profile px4-v1.3.4 v1.3.4-ff-of-setpoint tpa-missing
  [ "$status" -eq 0 ]
  has "px4-v1.3.4: 2 faults; 1 of 1 that can be told from the law are caught"
  has "the profile does not have this"
  lacks "### px4-v1.5.5"
  run "$ATTEST" faults --profile px4-v1.5.5 v1.3.4-ff-of-setpoint tpa-missing
  [ "$status" -eq 0 ]
  has "px4-v1.5.5: 2 faults; 1 of 1 that can be told from the law are caught"
  run "$ATTEST" faults --profile px4-v1.4.0 tpa-missing
  [ "$status" -eq 2 ]
  has "there are px4-v1.5.5, px4-v1.3.4"
}

@test "a failure says what mistake it looks like" {
  run "$ATTEST" run --port fault:yaw-weight-dropped --rate 250 --group attitude --group rates \
    --json report.json
  [ "$status" -eq 1 ]
  has "it looks like:"
  has "\`yaw-weight-dropped\`: does not weigh the yaw error (wrong weight; in the stage yaw)"
  grep -q '"fault": "yaw-weight-dropped"' report.json
  run "$ATTEST" run --port fault:yaw-weight-dropped --rate 250 --group attitude --no-diagnose
  lacks "it looks like"
}

@test "two mistakes at once are both named" {
  for pair in "yaw-reversed dt-no-minimum" "tpa-missing gate-yaw-dropped" \
    "acro-pitch-reversed limit-missing" "battery-divides d-on-error"; do
    run "$ATTEST" run --port "fault:${pair/ /+}" --rate 250,1000 --group attitude \
      --group rate_limit --group rates --group tpa --group anti_windup --group battery \
      --group modes --group timing
    [ "$status" -eq 1 ]
    for one in $pair; do has "\`$one\`"; done
  done
}

@test "a mistake that is in no catalogue is caught and its stage named" {
  run "$ATTEST" run --port "lib:$PORTS/port_blend_from_100.so" --rate 250 --group large_angle \
    --group attitude
  [ "$status" -eq 1 ]
  has "blend"
  [[ $output == *"in the stage blend"* ]]
}

@test "a port that crashes is not diagnosed, and does not end the run" {
  run "$ATTEST" run --port "lib:$PORTS/port_crash.so" --rate 250 --group attitude
  [ "$status" -eq 1 ]
  lacks "it looks like"
}

@test "a port in fixed point is judged as one, and wrong ones are caught all the same" {
  [ -e "$PORTS/right_fixed_22.so" ] || skip "built without right ports"
  run "$ATTEST" run --port "lib:$PORTS/right_fixed_22.so" --rate 250 --group rates \
    --group large_angle --json report.json
  [ "$status" -eq 0 ]
  has "numeric for fixed point with 22 fraction bits"
  grep -q '"fraction_bits": 22' report.json
  run "$ATTEST" faults --fraction-bits 22 yaw-dropped tpa-missing battery-divides
  [ "$status" -eq 0 ]
  has "px4-v1.5.5: 3 faults; 3 of 3"
  run "$ATTEST" faults --fraction-bits 12
  [ "$status" -eq 2 ]
}

@test "two faults at once are a port, not a line of the table" {
  run "$ATTEST" faults tpa-missing+yaw-dropped
  [ "$status" -eq 2 ]
  has "attest run --port fault:tpa-missing+yaw-dropped"
  run "$ATTEST" faults --diagnose tpa-missing
  [ "$status" -eq 2 ]
}
