load common

@test "a trace agrees with itself" {
  trace="$SOURCE"/golden/recorded/px4-v1.5.5/tracking_100hz.csv
  run "$ATTEST" compare "$trace" "$trace" --level exact
  [ "$status" -eq 0 ]
  has "PASS 300 ticks"
}

@test "a changed value is found: tick, channel, bits" {
  trace="$SOURCE"/golden/recorded/px4-v1.5.5/tracking_100hz.csv
  awk -F, -v OFS=, -v name=out/vehicle_rates_setpoint.yaw '
    NR == 1 { for (i = 1; i <= NF; ++i) if ($i == name) c = i }
    NR == 12 { $c = $c + 0.5 }
    1' "$trace" >changed.csv
  run "$ATTEST" compare changed.csv "$trace"
  [ "$status" -eq 1 ]
  has "first at tick 10"
  has "out/vehicle_rates_setpoint.yaw"
  has "0x"
  has "1 of 300 ticks deviate"
}

@test "other inputs and parameters are named, and the law is not blamed" {
  trace="$SOURCE"/golden/recorded/px4-v1.5.5/tracking_100hz.csv
  awk -F, -v OFS=, -v name=in/control_state.q[0] -v out=out/vehicle_rates_setpoint.roll '
    NR == 1 { for (i = 1; i <= NF; ++i) { if ($i == name) c = i; if ($i == out) o = i } }
    NR > 1 { $c = 9 }
    NR == 12 { $o = $o + 0.5 }
    1' "$trace" >changed.csv
  run "$ATTEST" compare changed.csv "$trace"
  [ "$status" -eq 1 ]
  has "inputs differ from tick 0 on: in/control_state.q[0] is 9 in changed.csv and "
  has "these traces do not tell whether the laws differ"
  has "attest replay $trace --port PORT"
  has "first at tick 10"
  lacks "look first at"
}

@test "traces of another unit or profile are named, and the law is not blamed" {
  "$ATTEST" record v1.18/rates/p_alone --out new.csv
  "$ATTEST" record v1.14/rates/p_alone --out old.csv
  "$ATTEST" record v1.5/rates/p_alone --out controller.csv
  run "$ATTEST" compare new.csv controller.csv
  [ "$status" -eq 1 ]
  has "got is a trace of rate_unit, want of mc_att_control"
  run "$ATTEST" compare old.csv new.csv
  [ "$status" -eq 1 ]
  has "the profile is px4-v1.14.4 in old.csv and px4-v1.18 in new.csv"
  lacks "look first at"
}

@test "traces of other length or rate are not compared" {
  trace="$SOURCE"/golden/recorded/px4-v1.5.5/tracking_100hz.csv
  head -n 100 "$trace" >short.csv
  run "$ATTEST" compare short.csv "$trace"
  [ "$status" -eq 1 ]
  has "99 ticks, expected 300"
  run "$ATTEST" compare "$trace" "$SOURCE"/golden/recorded/px4-v1.5.5/tracking_1000hz.csv
  [ "$status" -eq 1 ]
  has "tick 0 is at"
}

@test "mixer recordings are compared too" {
  trace=$SOURCE/golden/recorded/mixer-v1.5.5/4+.csv
  run "$ATTEST" compare "$trace" "$trace"
  [ "$status" -eq 0 ]
  sed 's/-0.60356307/-0.60356302/' "$SOURCE/golden/recorded/mixer-v1.5.5/4x.csv" >other.csv
  run "$ATTEST" compare other.csv "$SOURCE/golden/recorded/mixer-v1.5.5/4x.csv" --level exact
  [ "$status" -eq 1 ]
  has "output[1]"
}

@test "an unknown column and a pipe are refused, at every level" {
  trace="$SOURCE"/golden/recorded/px4-v1.5.5/fuzz_250hz.csv
  sed '1s/$/,roll_sp/;2,$s/$/,1/' "$trace" >extended.csv
  for level in exact numeric events; do
    run "$ATTEST" compare "$trace" extended.csv --level $level
    [ "$status" -eq 2 ]
    has 'unknown column `roll_sp`'
    run bash -c "cat '$trace' | '$ATTEST' compare /dev/stdin '$trace' --level $level"
    [ "$status" -eq 2 ]
    has "/dev/stdin: is a pipe"
  done
}

@test "a log and a CSV trace of the same flight agree, signal by signal" {
  for file in a.csv a.ulg; do "$ATTEST" sim gust --rate 250 --out $file; done
  run "$ATTEST" compare a.csv a.ulg --level exact
  [ "$status" -eq 0 ]
  has "82 of 82 common signals agree"
  has "only in the first: 24 signals"
  "$ATTEST" sim gust --rate 250 --port fault:quat-order-xyzw --out b.ulg || true
  run "$ATTEST" compare b.ulg a.csv
  [ "$status" -eq 1 ]
  has "FAIL b.ulg (got), a.csv (want)"
  has "vehicle_rates_setpoint.yaw: "
}

@test "a trace that lags is found out, and compared as it should be on request only" {
  printf 'timestamp,x\n' | tee a.csv >b.csv
  for i in $(seq 100); do
    echo "$((4000 * i)),$((i * i % 97))" >>a.csv
    echo "$((4000 * i + 8000)),$((i * i % 97))" >>b.csv
  done
  run "$ATTEST" compare b.csv a.csv --by-time
  [ "$status" -eq 1 ]
  has "the first lags behind the second by 8000 us"
  for shift in auto 8000; do
    run "$ATTEST" compare b.csv a.csv --by-time --shift $shift
    [ "$status" -eq 0 ]
    has "by time, shifted by 8000 us"
  done
  run "$ATTEST" compare b.csv a.csv --by-time --shift soon
  [ "$status" -eq 2 ]
  has "--shift soon: write a whole number of microseconds, or auto"
}

@test "files without a common signal, or that are no trace, are errors" {
  printf 'timestamp,x\n1,2\n' >a.csv
  printf 'timestamp,y\n1,2\n' >b.csv
  run "$ATTEST" compare a.csv b.csv --by-time
  [ "$status" -eq 2 ]
  has "have no signal in common"
  printf 'ULog' >c.ulg
  run "$ATTEST" compare c.ulg a.csv
  [ "$status" -eq 2 ]
  has "c.ulg"
}

@test "infinity, the sign of zero and signals without common times are differences" {
  printf 'timestamp,vehicle_rates_setpoint.roll,x\n1,inf,0\n2,1,0\n' >a.csv
  printf 'timestamp,vehicle_rates_setpoint.roll,x\n1,2,0\n2,1,0\n' >b.csv
  run "$ATTEST" compare b.csv a.csv --by-time
  [ "$status" -eq 1 ]
  has "got 2, want inf"
  sed 's/,0$/,-0/; s/inf/2/' a.csv >c.csv
  run "$ATTEST" compare c.csv b.csv --by-time
  [ "$status" -eq 0 ]
  run "$ATTEST" compare c.csv b.csv --by-time --level exact
  [ "$status" -eq 1 ]
  has "x: 2 of 2 samples deviate"
  printf 'timestamp,x\n3,0\n4,0\n' >d.csv
  run "$ATTEST" compare d.csv b.csv --by-time --html page.html
  [ "$status" -eq 2 ]
  has "d.csv and b.csv have no timestamp in common, so no sample was compared; --shift"
  [ ! -e page.html ]
}

@test "compare and plot write pages, and overwrite nothing that they read" {
  for file in a.csv a.ulg; do "$ATTEST" sim gust --rate 250 --out $file; done
  "$ATTEST" sim gust --rate 250 --port fault:yaw-dropped --out b.ulg
  run "$ATTEST" compare b.ulg a.csv --html c.html
  [ "$status" -eq 1 ]
  grep -q "common signals agree" c.html
  run "$ATTEST" compare a.csv a.csv --html c.html
  [ "$status" -eq 2 ]
  has "add --by-time"
  run "$ATTEST" plot a.csv b.ulg --channels 'control_state.*_rate,vehicle_rates_setpoint.yaw'
  [ "$status" -eq 0 ]
  has "a.html: 4 of "
  grep -q "control_state.pitch_rate" a.html
  run "$ATTEST" plot b.ulg
  [ "$status" -eq 0 ]
  has "b.html: 15 of 82 signals"
  run "$ATTEST" plot b.ulg --list
  has "control_state.q[0]"
  run "$ATTEST" plot b.ulg --channels control_stat.roll_rate
  [ "$status" -eq 2 ]
  has 'did you mean `control_state.roll_rate`'
  run "$ATTEST" plot b.ulg --html b.ulg
  [ "$status" -eq 2 ]
  has "would be overwritten"
}

@test "a shift that no file can have is refused" {
  printf 'timestamp,x\n1,2\n18446744073709551615,2\n' >a.csv
  for shift in -9223372036854775808 9223372036854775807 99999999999999999999; do
    run "$ATTEST" compare a.csv a.csv --by-time --shift=$shift
    [ "$status" -eq 2 ]
    has "--shift $shift: is beyond 4611686018427387903 us"
  done
  run "$ATTEST" compare a.csv a.csv --by-time --shift=4611686018427387903
  [ "$status" -eq 2 ]
  has "no timestamp in common"
  has "1 row left out, because the time is beyond"
}

@test "a trace of a unit has the signals of its log" {
  for vector in sticks/tilt_filter acro/sticks; do
    "$ATTEST" record "px4-v1.16.0/$vector" --rate 250 --out unit.csv
    "$ATTEST" record "px4-v1.16.0/$vector" --rate 250 --out unit.ulg
    run "$ATTEST" compare unit.csv unit.ulg --level exact
    [ "$status" -eq 0 ]
    has "common signals agree"
    lacks "left out"
  done
  run "$ATTEST" plot unit.ulg # of the rate unit in acro mode
  [ "$status" -eq 0 ]
  has "unit.html: 15 of"
}

@test "the first bytes of a file choose its format, and else its name" {
  local format
  for format in csv ulg ulog mat; do
    "$ATTEST" record px4-v1.5.5/rates/p_alone --rate 250 --out "a.$format"
  done
  cp a.ulog log.csv
  for format in ulg ulog; do
    run "$ATTEST" compare "a.$format" a.csv --level exact
    [ "$status" -eq 0 ]
    has "47 of 47 common signals agree"
  done
  run "$ATTEST" replay a.csv a.ulg a.ulog log.csv
  [ "$status" -eq 0 ]
  has "PASS 4 of 4 traces and logs agree"
  [ "$(head -c 6 a.mat)" = MATLAB ]
  cp a.mat table.csv
  for command in plot replay "compare a.csv"; do
    run "$ATTEST" $command table.csv
    [ "$status" -eq 2 ]
    has "table.csv: is a MAT file; this needs one of the format csv or ulg"
  done
}

# without FILE NAME: the trace FILE without its column NAME, on stdout.
without() {
  awk -F, -v OFS=, -v name="$2" '
    NR == 1 { for (i = 1; i <= NF; ++i) if ($i == name) c = i }
    { line = ""; for (i = 1; i <= NF; ++i) if (i != c) line = line (line == "" ? "" : OFS) $i
      print line }' "$1"
}

@test "an output that one of two traces lacks is named" {
  "$ATTEST" record px4-v1.5.5/rates/p_alone --rate 250 --out whole.csv
  without whole.csv out/actuator_controls_0.control[0] >less.csv
  run "$ATTEST" compare whole.csv less.csv
  [ "$status" -eq 0 ]
  has "; not compared, because less.csv does not have them: out/actuator_controls_0.control[0]"
  run "$ATTEST" -q compare whole.csv less.csv
  [ "$status" -eq 0 ]
  has "not compared, because less.csv does not have them"
  without less.csv out/actuator_controls_0.control[1] >least.csv
  run "$ATTEST" compare least.csv whole.csv
  [ "$status" -eq 1 ]
  has "got lacks out/actuator_controls_0.control[0], out/actuator_controls_0.control[1], which want"
  run "$ATTEST" -q replay least.csv
  [ "$status" -eq 0 ]
  has "  not compared, because the trace does not have them: out/actuator_controls_0.control[0], o"
  run "$ATTEST" -q replay whole.csv
  lacks "not compared"
}
