# The core of the suite: few vectors that catch what all vectors catch.
load common

@test "the core names cases that the suite has" {
  "$ATTEST" list --core --core-flights | grep -oE '^px4-[^ ]+' | sort >listed
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

# core_alone PROFILE: ./suite has only the cases in open loop of the core of that profile.
core_alone() {
  local profile=$1 name folder
  rm -rf suite
  mkdir -p suite/cases
  ln -s "$SOURCE/golden" "$SOURCE/models" suite/
  # A case of several versions is in the folder of one of them.
  while read -r name; do
    for folder in $(cd "$SOURCE/cases" && ls -d px4-*/"$name".toml | xargs dirname); do
      mkdir -p "suite/cases/$folder"
      cp "$SOURCE/cases/$folder/${name#*/}.toml" "suite/cases/$folder/"
    done
  done < <(grep "^$profile/.*hz$" "$SOURCE/cases/CORE" | sed 's|^[^/]*/||; s|@.*||' | sort -u)
}

# The core of the core is the core, with as many faults, if no case has lost its purpose.
@test "the core catches the faults that it claims" {
  for profile in px4-v1.5.5 px4-v1.16.0; do
    core_alone $profile
    "$ATTEST" --suite suite faults --core --profile $profile | grep "^# $profile, \|^px4" >found
    awk -v profile="# $profile, " \
      '/^# / { on = index($0, profile) == 1 && !/, flights: / } on && NF' \
      "$SOURCE/cases/CORE" >named
    diff named found
  done
}

@test "the flights of the core catch a wrong port in flight" {
  run "$ATTEST" list --core
  lacks "/flight/"
  run "$ATTEST" run --core-flights --profile px4-v1.18 --no-diagnose
  [ "$status" -eq 0 ]
  has "only --core-flights"
  run "$ATTEST" run --core-flights --profile px4-v1.18 --no-diagnose \
    --port fault:cascade-pitch-yaw-gains
  [ "$status" -eq 1 ]
  has "/flight/"
}

@test "a suite without a core says how to make one, and gets one" {
  make_suite
  ln -s "$SOURCE/models" suite/
  # Two flights of 0.4 s; the second one shows nothing that the first one does not.
  sed '/^duration_s/ s/3/0.4/; /^\[flight.metrics/,$ d' \
    "$SOURCE/cases/px4-v1.5.5/flight/tilt_step_30.toml" >tilt.toml
  printf '[flight.metrics.tilts]\nmeasure = "rms_attitude_error_deg"\nmax = 30\n' >>tilt.toml
  mkdir suite/cases/px4-v1.5.5/flight
  for name in one two; do cp tilt.toml suite/cases/px4-v1.5.5/flight/$name.toml; done
  "$ATTEST" --suite suite bless --yes --reason "a test" >/dev/null
  run "$ATTEST" --suite suite run --core
  [ "$status" -eq 2 ]
  has "suite/cases/CORE: the suite has no core; write this file with \`attest faults --core\`"
  "$ATTEST" --suite suite faults --core --profile px4-v1.5.5 >core
  grep -qx 'px4-v1.5.5/attitude/roll@250hz' core
  grep -q '^# px4-v1.5.5, mc_att_control: [1-9][0-9]* faults, ' core
  grep -q '^# px4-v1.5.5, flights: [1-9][0-9]* faults, 1 vectors, 100 ticks' core
  grep -qx 'px4-v1.5.5/flight/one@250hz-iris-ode' core
  cp core suite/cases/CORE
  run "$ATTEST" --suite suite run --core
  [ "$status" -eq 0 ]
  has "PASS $(grep -c 'hz$' core) vectors passed, 0 failed"
  run "$ATTEST" --suite suite run --core-flights
  [ "$status" -eq 0 ]
  has "PASS 1 vector passed, 0 failed"
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
  vectors="$(grep -c '^px4-v1.5.5/.*hz$' "$SOURCE/cases/CORE")"
  [ "$(find vectors -name '*hz.csv' | wc -l)" -ge $((vectors - 5)) ]
}
