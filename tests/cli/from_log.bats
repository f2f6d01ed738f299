load common

# Half a second of a flight, in the suite ./ours.
suite_of_log() {
  "$ATTEST" sim gust --rate 250 --out gust.ulg >/dev/null
  "$ATTEST" vectors ours --from-log gust.ulg --from 1 --to 1.5 >out.txt 2>/dev/null
}
from_log=ours/cases/px4-v1.5.5/from_log/gust_from_1s_to_1_5s.toml

@test "a part of a log becomes a case that judges ports at all rates" {
  suite_of_log
  grep -q "$from_log: 0.5 s, 125 samples of control_state" out.txt
  grep -q 'attest --suite ours bless --group from_log --yes --reason' out.txt
  "$ATTEST" --suite ours bless --group from_log --yes --reason "a flight"
  run "$ATTEST" --suite ours run --group from_log
  [ "$status" -eq 0 ]
  has "11 vectors passed, 0 failed"
  has "custom suite"
  run "$ATTEST" --suite ours run --group from_log --port fault:quat-order-xyzw
  [ "$status" -eq 1 ]
  has "FAIL 11 of 11 vectors failed"
}

@test "a case of a log overwrites no file, and is in no released suite" {
  suite_of_log
  before=$(sha256sum $from_log)
  echo ../other >ours/BASE
  run "$ATTEST" vectors ours --from-log gust.ulg --from 1 --to 1.5
  [ "$status" -eq 2 ]
  has "$from_log: exists, and is not overwritten"
  [ "$(sha256sum $from_log)" = "$before" ]
  [ "$(cat ours/BASE)" = ../other ]
  run "$ATTEST" vectors "$SOURCE" --from-log gust.ulg
  [ "$status" -eq 2 ]
  has "is in a suite"
}

@test "a part that the log does not have is an error, and no folder is made" {
  "$ATTEST" sim gust --rate 250 --out gust.ulg >/dev/null
  for wrong in "--from 9" "--to 9" "--from 2 --to 1" "--from 1 --to 1.001" "--profile px4-v1.9" \
    "--group tpa" "--rate 250"; do
    run "$ATTEST" vectors ours --from-log gust.ulg $wrong
    [ "$status" -eq 2 ]
    [ ! -e ours ]
  done
  run "$ATTEST" vectors ours --from-log gust.ulg --from 9
  has "gust.ulg: the part is beyond the log, whose samples of control_state are from 0 to 4 s"
  run "$ATTEST" vectors ours --from 1
  [ "$status" -eq 2 ]
  has "--from-log"
}

units_log() {
  "$PYTHON" "$SOURCE/tests/cli/cascade_log.py" "$@"
}

@test "a log of v1.14 to v1.18 becomes a case of each unit, at the rates of the unit" {
  units_log flight.ulg
  "$ATTEST" vectors ours --from-log flight.ulg --from 0.9 --to 2.9 >out.txt 2>/dev/null
  made=ours/cases/px4-v1.16.0/from_log/flight_from_0_9s_to_2_9s
  grep -q "${made}_attitude_unit.toml: 2 s, 500 samples of vehicle_attitude" out.txt
  grep -q "${made}_rate_unit.toml: 2 s, 2000 samples of vehicle_angular_velocity" out.txt
  "$ATTEST" --suite ours bless --group from_log --yes --reason "a flight"
  for port in builtin "lib:$(dirname "$STARTER")/../c_cascade/attest_starter_c_cascade.so"; do
    run "$ATTEST" --suite ours run --group from_log --level exact --port "$port"
    [ "$status" -eq 0 ]
    has "16 vectors passed, 0 failed"
  done
  run "$ATTEST" --suite ours run --group from_log --no-diagnose --port fault:cascade-m-not-canonical
  [ "$status" -eq 1 ]
  has "FAIL 5 of 16 vectors failed"
  run "$ATTEST" --suite ours run --group from_log --no-diagnose --port fault:cascade-d-reversed
  [ "$status" -eq 1 ]
  has "FAIL 11 of 16 vectors failed"
}

@test "a log that is too sparse for the rate unit becomes a case of its single steps" {
  sparse=(--thin vehicle_angular_velocity=20 --thin vehicle_torque_setpoint=20
    --thin vehicle_thrust_setpoint=20)
  units_log sparse.ulg "${sparse[@]}"
  run "$ATTEST" vectors ours --from-log sparse.ulg
  [ "$status" -eq 0 ]
  has "the rate unit has 198 single steps, of 4000 that the log has outputs of"
  has "sparse_rate_unit.toml: 3.9801 s, 198 samples of vehicle_angular_velocity"
  "$ATTEST" --suite ours bless --group from_log --yes --reason "a flight"
  for port in builtin "lib:$(dirname "$STARTER")/../c_cascade/attest_starter_c_cascade.so"; do
    run "$ATTEST" --suite ours run --group from_log --level exact --port "$port"
    [ "$status" -eq 0 ]
  done
  run "$ATTEST" --suite ours run --group from_log --no-diagnose --port fault:cascade-d-reversed
  [ "$status" -eq 1 ]
  units_log sparser.ulg "${sparse[@]}" --without rate_ctrl_status
  run "$ATTEST" vectors other --from-log sparser.ulg
  [ "$status" -eq 0 ]
  has "no case of the rate unit: the log has a gyro sample every 20 ms"
  [ "$(ls other/cases/px4-v1.16.0/from_log)" = sparser_attitude_unit.toml ]
}

# answer VECTOR PORT: the outputs of the port, without its inputs, as the answer in ./inputs.
answer() {
  "$ATTEST" --suite ours record "$1" --rate 250 --port "$2" --out answer.csv
  "$PYTHON" - "inputs/$1/250hz.out.csv" <<'ANSWER'
import csv, pathlib, sys
lines = [line for line in pathlib.Path("answer.csv").read_text().splitlines() if line[0] != "#"]
rows = list(csv.DictReader(lines))
columns = [name for name in rows[0] if name == "timestamp" or name.startswith("out/")]
with open(sys.argv[1], "w", newline="", encoding="utf-8") as out:
    writer = csv.DictWriter(out, columns, extrasaction="ignore")
    writer.writeheader()
    writer.writerows(rows)
ANSWER
}

@test "a port that cannot be called answers the cases of both units in files" {
  units_log flight.ulg
  "$ATTEST" vectors ours --from-log flight.ulg --from 0.9 --to 2.9 2>/dev/null
  "$ATTEST" --suite ours bless --group from_log --yes --reason "a flight"
  "$ATTEST" --suite ours vectors inputs --group from_log --rate 250
  for port in "lib:$(dirname "$STARTER")/../c_cascade/attest_starter_c_cascade.so" \
    fault:cascade-d-reversed; do
    for unit in attitude_unit rate_unit; do
      answer "px4-v1.16.0/from_log/flight_from_0_9s_to_2_9s_$unit" "$port"
    done
    run "$ATTEST" --suite ours run --group from_log --rate 250 --port recorded:inputs --no-diagnose
    if [[ $port == lib:* ]]; then
      [ "$status" -eq 0 ]
      has "PASS 2 vectors passed, 0 failed"
    else
      [ "$status" -eq 1 ]
      has "FAIL 1 of 2 vectors failed, 1 passed"
    fi
  done
}
