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
