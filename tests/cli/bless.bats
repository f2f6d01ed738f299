load common

golden=suite/golden/px4-v1.5.5/attitude/roll.csv
provenance=suite/golden/px4-v1.5.5/provenance.toml

# sha256_of_profile PROFILE: of the golden of this profile, as golden/README.md says.
sha256_of_profile() {
  awk -F, -v profile="$1" 'NR == 1 { keep = 1 } NR > 1 && $1 != "" { keep = index($1, profile) }
    keep { sub(/^[^,]*,/, ""); print }' $golden | sha256sum | cut -d' ' -f1
}

@test "bless makes one file for each case file, and a provenance for each profile" {
  make_suite
  run "$ATTEST" --suite suite bless --yes --reason "first golden"
  [ "$status" -eq 0 ]
  has "roll: new, 11 traces"
  [ "$(cd suite/golden && find px4-* -type f | sort | xargs)" = \
    "px4-v1.5.5/attitude/roll.csv px4-v1.5.5/provenance.toml" ]
  grep -q "first golden" $provenance
  run "$ATTEST" --suite suite run --level exact
  [ "$status" -eq 0 ]
  grep -q "^sha256 = '$(sha256_of_profile px4-v1.5.5)'" $provenance
}

@test "nothing is blessed without a reason, nor unasked" {
  make_suite
  run "$ATTEST" --suite suite bless --yes
  [ "$status" -eq 2 ]
  has "--reason"
  run "$ATTEST" --suite suite bless --reason "why not" </dev/null
  [ "$status" -eq 2 ]
  has "--yes"
  [ ! -e $golden ]
}

@test "what did not change is left alone" {
  blessed_suite
  before=$(cat $golden $provenance)
  run "$ATTEST" --suite suite bless --yes --reason "again"
  [ "$status" -eq 0 ]
  has "1 unchanged"
  [ "$before" = "$(cat $golden $provenance)" ]
}

@test "a change is shown: how many traces, which channel, how much" {
  blessed_suite
  sed -i 's/to = 20/to = 25/' suite/cases/px4-v1.5.5/attitude/roll.toml
  run "$ATTEST" --suite suite bless --yes --reason "larger tilt"
  [ "$status" -eq 0 ]
  has "11 of 11 traces"
  has "out/vehicle_rates_setpoint.roll"
  [ -z "$(find suite -name '*.new' -o -name '*.old')" ]
}

@test "a golden stays current when the case file says the same in other words" {
  blessed_suite
  file=suite/cases/px4-v1.5.5/attitude/roll.toml
  echo "# a remark" >>$file
  sed -i 's/^why = .*/why = "Another reason."/; s/duration_ticks = 30/duration_ticks = 0x1E/' $file
  sed -i '/^roll_rate/{h;d};/^pitch_rate/G' $file
  run "$ATTEST" --suite suite run --level exact
  [ "$status" -eq 0 ]
  run "$ATTEST" --suite suite bless --yes --reason "remark"
  has "1 unchanged"
}

@test "a key without an effect on the outputs makes the golden stale" {
  blessed_suite
  printf '[tolerance]\nwhy = "a test"\n"vehicle_rates_setpoint" = { absolute = 1e-3 }\n' \
    >>suite/cases/px4-v1.5.5/attitude/roll.toml
  run "$ATTEST" --suite suite run
  [ "$status" -eq 2 ]
  has "the golden is stale"
  run "$ATTEST" --suite suite bless --yes --reason "tolerance"
  has "no value changes, the case file did"
  run "$ATTEST" --suite suite run
  [ "$status" -eq 0 ]
}

@test "the answer no changes nothing" {
  blessed_suite
  sed -i 's/to = 20/to = 25/' suite/cases/px4-v1.5.5/attitude/roll.toml
  before=$(cat $golden $provenance)
  # script gives attest a terminal to ask on.
  run script -qec "\"$ATTEST\" --suite suite bless --reason r" /dev/null <<<"n"
  has "no golden was changed"
  [ "$before" = "$(cat $golden $provenance)" ]
  [ -z "$(find suite -name '*.new')" ]
}

@test "nothing is blessed by a reference that differs from the firmware" {
  make_suite
  folder=suite/golden/recorded/px4-v1.5.5
  sed -i '2s/^5010000,0.99/5010000,0.98/' $folder/tracking_100hz.csv
  hash=$(sha256sum <$folder/tracking_100hz.csv | cut -d' ' -f1)
  sed -i "s/^\"tracking_100hz.csv\".*/\"tracking_100hz.csv\" = \"$hash\"/" $folder/provenance.toml
  run "$ATTEST" --suite suite bless --yes --reason "should not be"
  [ "$status" -eq 2 ]
  has "no golden is blessed"
  [ ! -e $golden ]
}

@test "an edited recording is no judge" {
  make_suite
  echo >>suite/golden/recorded/px4-v1.5.5/tracking_100hz.csv
  run "$ATTEST" --suite suite bless --yes --reason "should not be"
  [ "$status" -eq 2 ]
  has "is not what was recorded"
}

@test "a golden with infinities is unchanged when nothing changed" {
  make_suite
  cp "$SOURCE/cases/px4-v1.5.5/battery/non_finite_scale.toml" .
  mkdir -p suite/cases/px4-v1.5.5/battery
  mv non_finite_scale.toml suite/cases/px4-v1.5.5/battery/
  "$ATTEST" --suite suite bless --yes --reason "first" >/dev/null
  run "$ATTEST" --suite suite bless --yes --reason "again"
  has "2 unchanged"
}

@test "the profiles of a case file share a golden" {
  make_suite
  sed -i 's/profiles = .*/since = "px4-v1.3.4"/' suite/cases/*/attitude/roll.toml
  "$ATTEST" --suite suite bless --yes --reason "first" >/dev/null
  [ "$(cd suite/golden && find px4-* -type f | sort | xargs)" = \
    "px4-v1.3.4/provenance.toml px4-v1.5.5/attitude/roll.csv px4-v1.5.5/provenance.toml" ]
  grep -q "^px4-v1.3.4 px4-v1.5.5,50hz" $golden
  for profile in px4-v1.3.4 px4-v1.5.5; do
    grep -q "^sha256 = '$(sha256_of_profile $profile)'" suite/golden/$profile/provenance.toml
  done
  run "$ATTEST" --suite suite run --level exact
  [ "$status" -eq 0 ]
  has "22 vectors passed, 0 failed"
  # A filter that names one profile blesses that one.
  sed -i 's/to = 20/to = 25/' suite/cases/px4-v1.5.5/attitude/roll.toml
  run "$ATTEST" --suite suite bless --filter 'px4-v1.3.4/*' --yes --reason "larger tilt"
  has "blessed 1"
  run "$ATTEST" --suite suite run --level exact --profile px4-v1.3.4
  [ "$status" -eq 0 ]
  run "$ATTEST" --suite suite run --level exact --profile px4-v1.5.5
  [ "$status" -eq 2 ]
  has "stale"
  # The golden of the other profile stays in the file.
  sed -i 's/to = 25/to = 20/' suite/cases/px4-v1.5.5/attitude/roll.toml
  run "$ATTEST" --suite suite run --level exact --profile px4-v1.5.5
  [ "$status" -eq 0 ]
  # When the case is no longer of a profile, the golden of that profile goes.
  sed -i 's/^since = .*/profiles = ["px4-v1.5.5"]/' suite/cases/px4-v1.5.5/attitude/roll.toml
  cp -r suite/cases/px4-v1.5.5 suite/cases/px4-v1.3.4
  sed -i 's/px4-v1.5.5/px4-v1.3.4/' suite/cases/px4-v1.3.4/attitude/roll.toml
  run "$ATTEST" --suite suite bless --yes --reason "two files"
  [ "$status" -eq 0 ]
  has "px4-v1.3.4/attitude/roll: new"
  has "px4-v1.3.4/attitude/roll: removed, because its case is gone"
  has "blessed 2"
  must_fail grep -q px4-v1.3.4 $golden
  run "$ATTEST" --suite suite run --level exact
  [ "$status" -eq 0 ]
  has "22 vectors passed, 0 failed"
}

# A killed bless has written the provenance, and no golden is in its place yet.
@test "a golden that a killed bless has not moved is used, and the next bless moves it" {
  blessed_suite
  cp $golden old.csv
  sed -i 's/to = 20/to = 25/' suite/cases/px4-v1.5.5/attitude/roll.toml
  "$ATTEST" --suite suite bless --yes --reason "larger tilt" >/dev/null
  mv $golden $golden.new
  mv old.csv $golden
  run "$ATTEST" --suite suite run --level exact
  [ "$status" -eq 0 ]
  run "$ATTEST" --suite suite bless --yes --reason "again"
  has "1 unchanged"
  [ -z "$(find suite/golden -name '*.new')" ]
  run "$ATTEST" --suite suite run --level exact
  [ "$status" -eq 0 ]
}

@test "a golden whose case is gone is named by doctor, and removed by bless" {
  make_suite
  cases=suite/cases/px4-v1.5.5/attitude
  sed 's/= 30/= 40/' $cases/roll.toml >$cases/gone.toml
  "$ATTEST" --suite suite bless --yes --reason "both" >/dev/null
  rm $cases/gone.toml
  run "$ATTEST" --suite suite doctor
  has "px4-v1.5.5/attitude/gone has no case; \`attest bless\` removes it"
  run "$ATTEST" --suite suite bless --yes --reason "one is gone"
  [ "$status" -eq 0 ]
  has "px4-v1.5.5/attitude/gone: removed, because its case is gone"
  [ "$(ls suite/golden/px4-v1.5.5/attitude)" = roll.csv ]
  must_fail grep -q gone $provenance
  run "$ATTEST" --suite suite run --level exact
  [ "$status" -eq 0 ]
}

@test "an edited provenance is not blessed over" {
  blessed_suite
  sed -i 's/a test/no test/' $provenance
  cp $provenance edited
  run "$ATTEST" --suite suite bless --yes --reason "again"
  [ "$status" -eq 2 ]
  has "provenance.toml: was changed after it was blessed"
  cmp edited $provenance
}

@test "of a long case some ticks are kept, and all are judged" {
  make_suite
  sed -i 's/duration_ticks = 30/duration_ticks = 1200/' suite/cases/*/attitude/roll.toml
  "$ATTEST" --suite suite bless --yes --reason "long" >/dev/null
  [ "$(wc -l <$golden)" -lt 660 ] # of 11 rates
  run "$ATTEST" --suite suite run --level exact
  [ "$status" -eq 0 ]
  run "$ATTEST" --suite suite run --rate 250 --port "lib:$PORTS/port_sign_flip.so"
  [ "$status" -eq 1 ]
  has "of 1200"
}

# A suite of several cases, so that blessing takes a while.
make_large_suite() {
  make_suite
  for i in 1 2 3 4 5 6; do
    cp suite/cases/px4-v1.5.5/attitude/roll.toml suite/cases/px4-v1.5.5/attitude/roll$i.toml
  done
  sed -i 's/duration_ticks = 30/duration_ticks = 1200/' suite/cases/px4-v1.5.5/attitude/*.toml
}

# being_written: waits until a golden is being written.
being_written() {
  for _ in $(seq 500); do
    [ -z "$(find suite/golden -name '*.new')" ] || return 0
    sleep 0.01
  done
  return 1
}

nothing_half_done() {
  [ -z "$(find suite/golden -name '*.new' -o -name '.bless.lock')" ]
}

@test "two at once: the second is refused with the name of the lock" {
  make_large_suite
  "$ATTEST" --suite suite bless --yes --reason "first" >/dev/null &
  first=$!
  being_written
  kill -STOP $first # so that it cannot end before the second one begins
  run "$ATTEST" --suite suite bless --yes --reason "second"
  kill -CONT $first
  [ "$status" -eq 2 ]
  has "suite/golden/.bless.lock: another \`attest bless\` holds this lock"
  wait $first
  nothing_half_done
  run "$ATTEST" --suite suite run
  [ "$status" -eq 0 ]
}

@test "an interrupt removes what is half done and changes no golden" {
  make_large_suite
  for signal in INT TERM; do
    # A job of a script ignores SIGINT.
    env --default-signal=INT "$ATTEST" --suite suite bless --yes --reason r >out.txt 2>&1 &
    being_written
    kill -$signal $!
    code=0
    wait $! || code=$?
    [ "$code" -eq 130 ]
    grep -q "interrupted; no golden was changed" out.txt
    [ -z "$(find suite/golden -mindepth 1 -not -path '*/recorded*')" ]
  done
}

@test "after a kill every golden is whole, and the next bless cleans up" {
  make_large_suite
  "$ATTEST" --suite suite bless --yes --reason "first" >/dev/null
  sed -i 's/to = 20/to = 25/' suite/cases/px4-v1.5.5/attitude/*.toml
  "$ATTEST" --suite suite bless --yes --reason "second" >/dev/null &
  being_written
  kill -KILL $!
  wait $! || true
  [ -n "$(find suite/golden -name '*.new')" ]
  must_fail grep -q "second" $provenance
  run "$ATTEST" --suite suite bless --yes --reason "third"
  [ "$status" -eq 0 ]
  has "blessed 7"
  nothing_half_done
  run "$ATTEST" --suite suite run
  [ "$status" -eq 0 ]
}

@test "an exclusion cannot split a file, so bless refuses it" {
  run "$ATTEST" bless --exclude 'px4-v1.3.4/*' --yes --reason x
  [ "$status" -eq 2 ]
  has "select with --filter, --group or --profile"
}
