# Flight logs as they are: with messages that attest did not expect, wrong bits, other endings.
load common

setup_file() {
  cd "$BATS_FILE_TMPDIR"
  "$ATTEST" record px4-v1.5.5/rates/p_alone --rate 250 --out own.ulg
  odd own.ulg flight.ulg --by-px4
}

# odd LOG OUT [OPTION...]: of odd_log.py.
odd() {
  "$PYTHON" "$SOURCE/tests/cli/odd_log.py" "$@"
}

# flight OUT [OPTION...]: a log of 48 control_state with every step, changed by odd_log.py.
flight() {
  odd "$BATS_FILE_TMPDIR/flight.ulg" "$@"
}

@test "an empty text among the info messages is no damage" {
  flight empty.ulg --info "char[0] perf_top_preflight="
  run "$ATTEST" replay empty.ulg
  [ "$status" -eq 0 ]
  has "actuator_controls_0: 48 of 48 logged samples paired"
  lacks "not judged"
  lacks "damaged"
}

@test "a bad info message takes no step away" {
  flight bad.ulg --info "point x=12"
  run "$ATTEST" replay bad.ulg
  [ "$status" -eq 0 ]
  has "damaged: byte"
  lacks "not judged"
}

@test "a wrong bit in a time removes one sample" {
  for place in 0:40 0:22 5:30 20:63 47:18; do
    flight wrong.ulg --flip "control_state=$place"
    run "$ATTEST" replay wrong.ulg
    has "1 sample of control_state left out, because the time"
    has "47 ticks"
    has "actuator_controls_0: 47 of 48 logged samples paired"
  done
  flight wrong.ulg --flip control_state=5:30 --flip control_state=6:30 --flip control_state=30:50
  run "$ATTEST" replay wrong.ulg
  has "3 samples of control_state left out"
  has "45 ticks"
}

@test "a wrong bit in the log of a unit removes one step, and a wrong port still fails" {
  "$ATTEST" sim gust --rate 250 --out gust.ulg >/dev/null
  odd gust.ulg wrong.ulg --by-px4 --flip control_state=99:40
  run "$ATTEST" replay wrong.ulg
  [ "$status" -eq 0 ]
  has "vehicle_rates_setpoint: 999 of 1000 logged samples paired"
  run "$ATTEST" replay wrong.ulg --port fault:quat-order-xyzw
  [ "$status" -eq 1 ]
}

@test "compare and plot leave a sample with an absurd time out, too" {
  flight wrong.ulg --flip control_state=5:40
  run "$ATTEST" compare wrong.ulg "$BATS_FILE_TMPDIR/flight.ulg"
  [ "$status" -eq 0 ]
  has "1 sample of control_state left out, because the time does not fit"
  has "0 in the first, "
}

@test "the build that wrote a log is shown, and a build that is no release is no release" {
  local kind
  for kind in 3f:dev 40:alpha 80:beta c0:rc; do
    flight build.ulg --info "uint32_t ver_sw_release=hex:${kind%:*}050501" \
      --info "char[4] ver_sw_branch=main"
    run "$ATTEST" replay build.ulg
    [ "$status" -eq 0 ]
    has "logged by anyone v1.5.5-${kind#*:}, branch main"
    has "the profile is px4-v1.5.5, because PX4 v1.5.5-${kind#*:} wrote the log"
    has " ${kind#*:} build of the branch main, whose law may differ from px4-v1.5.5"
  done
  flight build.ulg --info "uint32_t ver_sw_release=hex:ff050501"
  run "$ATTEST" replay build.ulg
  has "because PX4 v1.5.5 wrote the log"
  lacks "may differ"
  run "$ATTEST" replay build.ulg --profile v1.5.5
  lacks "wrote the log"
  run "$ATTEST" replay build.ulg --profile v1.3.4
  has "PX4 v1.5.5 wrote the log, whose profile is px4-v1.5.5, but --profile is px4-v1.3.4"
}

@test "a release without a profile is named, with the nearest one" {
  local pair
  for pair in 0600:1.6.0:1.5.5 0c00:1.12.0:1.5.5 0200:1.2.0:1.3.4; do
    IFS=: read -r bytes release profile <<<"$pair"
    flight release.ulg --info "uint32_t ver_sw_release=hex:ff${bytes:2}${bytes:0:2}01"
    run "$ATTEST" replay release.ulg
    has "PX4 v$release wrote the log, and attest has no profile of this release"
    has "the nearest, px4-v$profile, whose law may differ (--profile)"
  done
  flight release.ulg
  run "$ATTEST" replay release.ulg
  has "is taken to be px4-v1.5.5, because the log does not say which release of PX4 wrote it"
}

@test "a log is known by its first bytes, whatever its ending" {
  cp "$BATS_FILE_TMPDIR/flight.ulg" FLIGHT.ULG
  cp FLIGHT.ULG flight
  run "$ATTEST" replay FLIGHT.ULG flight
  [ "$status" -eq 0 ]
  has "PASS 2 of 2"
  "$ATTEST" record px4-v1.5.5/rates/p_alone --rate 250 --out NEW.ULG
  [ "$(head -c 4 NEW.ULG)" = ULog ]
}

@test "a file that is no whole log is named as what it is" {
  printf 'version https://git-lfs.github.com/spec/v1\noid sha256:1234\nsize 99\n' >pointer.ulg
  cp pointer.ulg pointer.csv
  cp pointer.ulg pointer
  for file in pointer.ulg pointer.csv pointer; do
    for command in replay plot "compare $BATS_FILE_TMPDIR/flight.ulg"; do
      run "$ATTEST" $command $file
      [ "$status" -eq 2 ]
      has "$file: is a pointer of Git LFS, not the file itself; fetch it with \`git lfs pull\`"
    done
  done
  echo "a text of any kind, without a sample" >TEXT.ULG
  run "$ATTEST" replay TEXT.ULG
  [ "$status" -eq 2 ]
  has "TEXT.ULG: is a text, and not a ULog; name a .ulg file of PX4's logger"
  : >empty.ulg
  run "$ATTEST" replay empty.ulg
  has "empty.ulg: is empty; copy the log again"
  head -c 300 "$BATS_FILE_TMPDIR/flight.ulg" >cut.ulg
  run "$ATTEST" replay cut.ulg
  [ "$status" -eq 2 ]
  has "cut.ulg: has no sample of any topic, as if it was cut off in its definitions; copy the log"
}

@test "a log that cannot be judged is skipped, and the others are judged" {
  cp "$BATS_FILE_TMPDIR/flight.ulg" flight.ulg
  sed 's/control_state/another_topic/g' flight.ulg >strange.ulg
  run "$ATTEST" replay strange.ulg flight.ulg --json result.json
  [ "$status" -eq 0 ]
  has "skip        strange.ulg: attitude unit"
  has "  the log has no sample of the topic vehicle_attitude"
  has "PASS 1 of 3 traces and units agree, 2 not compared"
  grep -q '"verdict": "skip"' result.json
  grep -q '"verdict": "pass"' result.json
  run "$ATTEST" replay strange.ulg flight.ulg --port fault:outputs-late
  [ "$status" -eq 1 ]
  run "$ATTEST" replay strange.ulg
  [ "$status" -eq 2 ]
  has "has too little to replay: for the controller of PX4 v1.5.5 and v1.3.4: no sample of the"
  run "$ATTEST" faults --log strange.ulg
  [ "$status" -eq 2 ]
  has "strange.ulg: has too little to replay"
  # An unreadable file is an error, after the others are judged.
  echo "no log" >text.ulg
  run "$ATTEST" replay text.ulg flight.ulg --json result.json
  [ "$status" -eq 2 ]
  has "text.ulg: is a text"
  grep -q '"verdict": "pass"' result.json
}

@test "what has no common time is one line, and a chance hit is no comparison" {
  flight shifted.ulg --shift control_state=1 --shift actuator_controls_0=1
  run "$ATTEST" compare shifted.ulg "$BATS_FILE_TMPDIR/flight.ulg"
  [ "$status" -eq 1 ]
  [ "$(grep -c "no timestamp in common" <<<"$output")" -eq 1 ]
  has "no timestamp in common, so no sample was compared: 15 signals: actuator_controls_0"
  lacks "may be two flights"
  printf 'timestamp,x\n' | tee a.csv >b.csv
  for i in $(seq 200); do
    echo "$((4000 * i)),1" >>a.csv
    echo "$((4000 * i + (i > 1 ? 1 : 0))),2" >>b.csv
  done
  run "$ATTEST" compare b.csv a.csv --by-time
  [ "$status" -eq 1 ]
  has "only 1 of 200 samples in the second have a time of the first; these may be two flights"
}

@test "a single tick is no ticks" {
  "$ATTEST" record px4-v1.5.5/rates/p_alone --rate 250 --out own.csv
  head -n "$(($(grep -n ^timestamp own.csv | cut -d: -f1) + 1))" own.csv >one.csv
  run "$ATTEST" replay one.csv
  has "  1 tick, numeric"
}
