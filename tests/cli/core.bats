# The core of the suite: few vectors that catch what all vectors catch.
load common

@test "the core names cases that the suite has" {
  "$ATTEST" list --core | grep -oE '^px4-[^ ]+' | sort >listed
  grep -v '^#' "$SOURCE/cases/CORE" | grep . | cut -d @ -f 1 | sort -u >named
  diff named listed
}

@test "a run of the core is partial, and catches wrong ports" {
  run "$ATTEST" run --core --profile px4-v1.5.5
  [ "$status" -eq 0 ]
  has "partial: px4-v1.5.5, "
  has "only --core"
  for fault in tpa-missing quat-order-setpoint battery-status-below-1 mixer-thrust-unclamped; do
    run "$ATTEST" run --core --profile px4-v1.5.5 --no-diagnose --port "fault:$fault"
    echo "$fault"
    [ "$status" -eq 1 ]
  done
}

@test "a suite without a core says how to make one, and gets one" {
  blessed_suite
  run "$ATTEST" --suite suite run --core
  [ "$status" -eq 2 ]
  has "suite/cases/CORE: the suite has no core; write this file with \`attest faults --core\`"
  "$ATTEST" --suite suite faults --core --profile px4-v1.5.5 >core
  grep -qx 'px4-v1.5.5/attitude/roll@250hz' core
  grep -q '^# px4-v1.5.5, mc_att_control: [1-9][0-9]* faults, ' core
  cp core suite/cases/CORE
  run "$ATTEST" --suite suite run --core
  [ "$status" -eq 0 ]
  has "PASS $(grep -c '^px4' core) passed, 0 failed"
  echo "px4-v1.5.5/attitude/roll@250hz" >suite/cases/CORE
  run "$ATTEST" --suite suite run --core --rate 50
  [ "$status" -eq 2 ]
  has "no selected vector is of the core; run without --core"
  echo "px4-v1.5.5/attitude/gone@250hz" >>suite/cases/CORE
  run "$ATTEST" --suite suite run --core
  [ "$status" -eq 2 ]
  has "the suite has no vector px4-v1.5.5/attitude/gone@250hz"
}

@test "a board gets the core as files" {
  run "$ATTEST" vectors --core --profile px4-v1.5.5 vectors
  [ "$status" -eq 0 ]
  vectors="$(grep -c '^px4-v1.5.5/' "$SOURCE/cases/CORE")"
  [ "$(find vectors -name '*hz.csv' | wc -l)" -ge $((vectors - 5)) ]
}
