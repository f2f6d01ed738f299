load common

# For tests that need many cases: groups without flights, which take seconds (flight.bats).
open_loop=(--group anti_windup --group modes --group arming --group attitude --group robustness)

@test "a port that is a tick late is the same at the events level only" {
  run "$ATTEST" run --level events "${open_loop[@]}" --port fault:outputs-late
  [ "$status" -eq 0 ]
  run "$ATTEST" run "${open_loop[@]}" --port fault:outputs-late --no-diagnose -q
  [ "$status" -eq 1 ]
}

@test "an event that does not happen is named with its tick" {
  run "$ATTEST" run --level events --group anti_windup --rate 250 --port fault:gate-yaw-dropped \
    --no-diagnose
  [ "$status" -eq 1 ]
  has "yaw_rate_integ is moving, expected still within a tick"
}

@test "groups that a port declares not to do are counted apart, never as conformant" {
  run "$ATTEST" run --group tailsitter --group tpa --port "lib:$PORTS/port_no_tailsitter.so"
  [ "$status" -eq 0 ]
  has "unsupported: the port declares that it does not support tailsitter"
  has "partial: px4-v1.5.5, numeric, 11 rates, group tpa (missing: only --group"
}

@test "a mixer has no events: it is judged by its values at that level too" {
  run "$ATTEST" run --level events --group mixer --port fault:mixer-output-0-to-1 --no-diagnose
  [ "$status" -eq 1 ]
  run "$ATTEST" run --level events --group mixer --group battery_status
  [ "$status" -eq 0 ]
}

@test "the units of the cascade have no level events: no case is judged, and no claim is made" {
  cascade=(--level events --profile px4-v1.16.0 --group rates --rate 250)
  run "$ATTEST" run "${cascade[@]}"
  [ "$status" -eq 2 ]
  has "NONE 0 of"
  has "skip: the level events is not defined for the units of v1.14 to v1.16; use --level numeric"
  has "conformance: none"
  run "$ATTEST" run --level events --group rates --rate 250
  [ "$status" -eq 0 ]
  has "px4-v1.5.5, events"
  lacks "px4-v1.16.0, events"
  "$ATTEST" record px4-v1.16.0/rates/p_alone --rate 250 --out trace.csv
  run "$ATTEST" replay trace.csv --profile px4-v1.16.0 --level events
  [ "$status" -eq 2 ]
  has "no trace was compared"
  run "$ATTEST" compare trace.csv trace.csv --level events
  [ "$status" -eq 1 ]
  has "these outputs define no events"
}
