load common

@test "list shows the cases and why they exist" {
  run "$ATTEST" list
  [ "$status" -eq 0 ]
  has "px4-v1.5.5/attitude/"
  has "11 rates"
  run "$ATTEST" list --groups
  has "px4-v1.5.5/anti_windup"
  has "px4-v1.17 is the law as of v1.17.0-beta1 (2026-01); the final release may differ"
  run "$ATTEST" list --groups --profile px4-v1.16.0
  lacks "the final release may differ"
}

@test "list prints the parameter table, the channels and the flight modes" {
  run "$ATTEST" list --parameters
  has "of attitude_unit:"
  has "of rate_unit:"
  has "MC_ROLLRATE_P"
  has "0.15"
  has "px4-v1.18 is the law as of branch release-1.18 (2026-08)"
  run "$ATTEST" list --channels
  has "out/vehicle_rates_setpoint.roll"
  has "rad/s"
  run "$ATTEST" list --flight-modes
  has "RATTITUDE"
}

@test "parameters are listed by profile, and an unknown profile is refused" {
  run "$ATTEST" list --parameters --profile px4-v1.3.4
  [ "$status" -eq 0 ]
  has "MC_ROLL_P"
  for name in MC_TPA_BREAK MC_TPA_SLOPE MC_BAT_SCALE_EN BAT_N_CELLS; do lacks "$name"; done
  run "$ATTEST" list --parameters --profile px4-v1.5.5
  for name in MC_TPA_BREAK MC_TPA_SLOPE MC_BAT_SCALE_EN BAT_N_CELLS; do has "$name"; done
  run "$ATTEST" list --parameters --profile px4-v1.5.6
  [ "$status" -eq 2 ]
  has 'did you mean `px4-v1.5.5`'
}

@test "doctor fits on a screen and ends with what works" {
  run "$ATTEST" doctor
  [ "$status" -eq 0 ]
  [ "${#lines[@]}" -le 22 ]
  ends 'PASS the machine, the suite, the reference and the port `builtin` work: * checks*'
  for line in "${lines[@]}"; do [ "${#line}" -le 200 ]; done
  has "pass   px4-v1.16.0 22 checks: steps, outputs, repeatable, parameters, instances, NaN"
  checks=$(grep -o '[0-9]* checks' <<<"${lines[-1]}")
  run "$ATTEST" doctor --verbose
  ends "*work: $checks*"
  has "100 of rate unit of px4-v1.16.0"
  run "$ATTEST" --quiet doctor
  [ "$status" -eq 0 ]
  [ -z "$output" ]
}

@test "doctor and smoke conclude with what does not work, and with its remedy" {
  make_suite
  run "$ATTEST" --suite suite doctor
  [ "$status" -eq 2 ]
  ends "FAIL the suite does not work: golden: 1 missing, stale *bless*; the * work"
  cp "$ATTEST" alone
  run ./alone doctor
  [ "$status" -eq 2 ]
  ends 'FAIL the suite does not work: suite: no suite found; name*; the machine and the port * work'
  run "$ATTEST" smoke "lib:$PORTS/port_step_fails.so"
  [ "$status" -eq 1 ]
  ends "FAIL the port * does not work: steps: 100 of px4-v1.5.5: step at tick *"
  run "$ATTEST" smoke --verbose "lib:$STARTER"
  [ "$status" -eq 0 ]
  has "100 of px4-v1.3.4"
  ends "PASS the port * works: 13 checks"
  run "$ATTEST" --quiet smoke "lib:$PORTS/port_step_fails.so"
  [ "$status" -eq 1 ]
  lacks "pass "
  has "FAIL   steps"
}

@test "doctor finds this tree in good health, and names the groups that no recording covers" {
  run "$ATTEST" doctor --verbose
  has "of a port's process: 10 s per answer"
  [ "$status" -eq 0 ]
  has "agrees with 81 of 81 traces recorded from the firmware"
  lacks "FAIL"
  has "px4-v1.3.4/flight, px4-v1.3.4/flight_timing, px4-v1.3.4/instances, px4-v1.3.4/rate_law"
  lacks "px4-v1.3.4/tpa"
  lacks "px4-v1.5.5/battery_status"
}

# damaged VALUE: ./damaged is attest, in whose constants a bit of VALUE has changed.
damaged() {
  "$PYTHON" - "$ATTEST" "$1" <<'SCRIPT'
import math, struct, sys

data = bytearray(open(sys.argv[1], "rb").read())
value = struct.pack("<d", eval(sys.argv[2]))
assert data.count(value) == 1, data.count(value)
data[data.index(value) + 5] ^= 1
open("damaged", "wb").write(data)
SCRIPT
  chmod +x damaged
}

@test "doctor finds an elementary function that is not correctly rounded" {
  blessed_suite
  run "$ATTEST" --suite suite doctor
  [ "$status" -eq 0 ]
  has "functions  sin, cos, tan, asin, acos, exp, atan2: correctly rounded"
  damaged 'math.atan(9 / 16)'
  run ./damaged --suite suite doctor
  [ "$status" -eq 2 ]
  has "FAIL   functions  atan2: not correctly rounded, so no verdict of this attest is valid"
}

# The port does not depend on the suite, and doctor examines a small one sooner.
@test "doctor lets a port do its first steps" {
  blessed_suite
  run "$ATTEST" --suite suite doctor --verbose --port "lib:$STARTER"
  [ "$status" -eq 0 ]
  has "100 of px4-v1.5.5"
  has "100 of px4-v1.3.4"
  for port in crash exits throws step_fails; do
    run "$ATTEST" --suite suite doctor --port "lib:$PORTS/port_$port.so"
    [ "$status" -eq 1 ]
    grep -q '^FAIL   steps .*100 of px4-v1.5.5: ' <<<"$output"
  done
}

@test "doctor says what is wrong with a port and with a suite" {
  make_suite
  run "$ATTEST" --suite suite doctor --port "lib:$PORTS/port_wrong_abi.so"
  [ "$status" -eq 2 ]
  has "FAIL"
  has "ABI version is 99"
  run "$ATTEST" --suite suite doctor
  [ "$status" -eq 2 ]
  has "1 missing, stale or without a case"
}

@test "the version is printed" {
  run "$ATTEST" --version
  [ "$status" -eq 0 ]
  has "attest 0."
}
