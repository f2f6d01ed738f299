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
