load common

@test "list shows the cases and why they exist" {
  run "$ATTEST" list
  [ "$status" -eq 0 ]
  has "px4-v1.5.5/attitude/"
  has "11 rates"
  run "$ATTEST" list --groups
  has "px4-v1.5.5/anti_windup"
}

@test "list prints the parameter table, the channels and the flight modes" {
  run "$ATTEST" list --parameters
  has "MC_ROLLRATE_P"
  has "0.15"
  run "$ATTEST" list --channels
  has "out/vehicle_rates_setpoint.roll"
  has "rad/s"
  run "$ATTEST" list --flight-modes
  has "RATTITUDE"
}

@test "doctor finds this tree in good health" {
  run "$ATTEST" doctor
  [ "$status" -eq 0 ]
  has "agrees with 17 of 17 traces recorded from the firmware"
  lacks "BAD"
}

@test "doctor says what is wrong with a port and with a suite" {
  run "$ATTEST" doctor --port "lib:$PORTS/port_wrong_abi.so"
  [ "$status" -eq 2 ]
  has "BAD"
  has "ABI version is 99"
  make_suite
  run "$ATTEST" --suite suite doctor
  [ "$status" -eq 2 ]
  has "1 missing or stale"
}

@test "the version is printed" {
  run "$ATTEST" --version
  [ "$status" -eq 0 ]
  has "attest 0."
}
