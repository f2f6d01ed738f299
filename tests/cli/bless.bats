load common

golden=suite/golden/px4-v1.5.5/attitude/roll

@test "bless makes one self-contained trace a rate, and a provenance" {
  make_suite
  run "$ATTEST" --suite suite bless --yes --reason "first golden"
  [ "$status" -eq 0 ]
  has "roll: new, 11 traces"
  [ "$(ls $golden | wc -l)" -eq 12 ]
  grep -q "first golden" $golden/provenance.toml
  run "$ATTEST" --suite suite run --level exact
  [ "$status" -eq 0 ]
  cd $golden
  grep "hz.csv" provenance.toml | tr -d "'" | awk '{print $3 "  " $1}' | sha256sum -c
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
  before=$(cat $golden/*)
  run "$ATTEST" --suite suite bless --yes --reason "again"
  [ "$status" -eq 0 ]
  has "1 unchanged"
  [ "$before" = "$(cat $golden/*)" ]
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

@test "a comment in a case changes no value" {
  blessed_suite
  echo "# a remark" >>suite/cases/px4-v1.5.5/attitude/roll.toml
  run "$ATTEST" --suite suite bless --yes --reason "remark"
  has "no value changes, the case file did"
  run "$ATTEST" --suite suite run
  [ "$status" -eq 0 ]
}

@test "the answer no changes nothing" {
  blessed_suite
  sed -i 's/to = 20/to = 25/' suite/cases/px4-v1.5.5/attitude/roll.toml
  before=$(cat $golden/*)
  # script gives it a terminal to ask on
  run script -qec "\"$ATTEST\" --suite suite bless --reason r" /dev/null <<<"n"
  has "nothing was changed"
  [ "$before" = "$(cat $golden/*)" ]
  [ -z "$(find suite -name '*.new' -o -name '*.old')" ]
}

@test "nothing is blessed by a reference that differs from the firmware" {
  make_suite
  folder=suite/golden/recorded/px4-v1.5.5
  sed -i '2s/^5010000,0.99/5010000,0.98/' $folder/tracking_100hz.csv
  hash=$(sha256sum <$folder/tracking_100hz.csv | cut -d' ' -f1)
  sed -i "s/^\"tracking_100hz.csv\".*/\"tracking_100hz.csv\" = \"$hash\"/" $folder/provenance.toml
  run "$ATTEST" --suite suite bless --yes --reason "should not be"
  [ "$status" -eq 2 ]
  has "nothing is blessed"
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
