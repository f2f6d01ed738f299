load common

# ci/quality also runs the faults of parts of the law that a profile does not have: they must pass
# every case, which takes three times as long as all the others together.
@test "every detectable fault is caught, by a case of its own group" {
  for profile in $(cd "$SOURCE/cases" && ls -d px4-*); do
    run "$ATTEST" faults --profile "$profile" \
      $("$ATTEST" faults --list --profile "$profile" | cut -d " " -f 1)
    [ "$status" -eq 0 ]
    has "$profile: "
    has "are caught (100.0%)"
    lacks "survives"
  done
}

@test "a fault is judged in the profiles where it is detectable" {
  run "$ATTEST" faults --profile px4-v1.3.4 v1.3.4-ff-of-setpoint tpa-missing
  [ "$status" -eq 0 ]
  has "px4-v1.3.4: 2 faults; 1 of 1 detectable faults are caught"
  has "the profile does not have this"
  lacks "### px4-v1.5.5"
  run "$ATTEST" faults --profile px4-v1.5.5 v1.3.4-ff-of-setpoint tpa-missing
  [ "$status" -eq 0 ]
  has "px4-v1.5.5: 2 faults; 1 of 1 detectable faults are caught"
  run "$ATTEST" faults --profile px4-v1.4.0 tpa-missing
  [ "$status" -eq 2 ]
  has "there are px4-v1.5.5, px4-v1.3.4"
}

@test "two mistakes at once are both named" {
  for pair in "yaw-reversed dt-no-minimum" "tpa-missing gate-yaw-dropped" \
    "acro-pitch-reversed limit-missing" "battery-divides d-on-error"; do
    run "$ATTEST" run --port "fault:${pair/ /+}" --profile px4-v1.5.5 --rate 250 \
      --group attitude,rate_limit,rates,tpa,anti_windup,battery,modes,timing
    [ "$status" -eq 1 ]
    for one in $pair; do has "\`$one\`"; done
  done
}

@test "a port in fixed point has its own tolerances, which still catch wrong ports" {
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

@test "the laws with 16 fraction bits conform, and a gain that is 2 % off is found" {
  [ -e "$PORTS/right_pure_laws_16.so" ] || skip "built without right ports"
  local run=("$ATTEST" run --group attitude_law,rate_law --port)
  run "${run[@]}" "lib:$PORTS/right_pure_laws_16.so"
  [ "$status" -eq 0 ]
  has "conformant: attitude_law, rate_law of px4-v1.16.0, numeric for fixed point with 16 fraction"
  has "conformant: attitude_law, rate_law of px4-v1.5.5, numeric for fixed point with 16 fraction"
  run "${run[@]}" "lib:$PORTS/wrong_pure_laws_16.so"
  [ "$status" -eq 1 ]
  has "look first at the attitude law"
}
