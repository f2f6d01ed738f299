load common

@test "vectors writes the inputs, complete in each file, and no outputs" {
  blessed_suite
  run "$ATTEST" --suite suite vectors out --rate 250,333
  [ "$status" -eq 0 ]
  has "2 input traces"
  file=out/px4-v1.5.5/attitude/roll/333hz.csv
  head -1 $file | grep -q '^timestamp,in/control_state.q\[0\]'
  head -1 $file | grep -vq 'out/'
  [ "$(wc -l <$file)" -eq 31 ]
}

@test "a golden has a row for each input, and can be read by four lines" {
  blessed_suite
  "$ATTEST" --suite suite vectors out --rate 250 >/dev/null
  python3 - <<'READ'
import csv
rows, row = [], {}
for cells in csv.DictReader(open("suite/golden/px4-v1.5.5/attitude/roll.csv")):
    row = {name: cell or row[name] for name, cell in cells.items()}
    if "px4-v1.5.5" in row["profiles"].split() and "250hz" in row["configurations"].split():
        rows.append(row)
inputs = list(csv.DictReader(open("out/px4-v1.5.5/attitude/roll/250hz.csv")))
assert [int(row["tick"]) for row in rows] == list(range(len(inputs))), rows
assert all(float(row["out/vehicle_rates_setpoint.roll"]) == 0 for row in rows[:1]), rows[0]
READ
}

@test "a folder that cannot be made is an error" {
  echo >file
  make_suite
  run "$ATTEST" --suite suite vectors file/below --rate 250
  [ "$status" -eq 2 ]
  has "file/below"
}

@test "no numeric vector of the suite comes near to a decision of the law" {
  # With sanitizers at the rate with the fewest steps, and groups without it at another: sanitizers
  # look for other mistakes.
  local selected=()
  if nm "$ATTEST" | grep -q __asan_init; then
    run "$ATTEST" vectors --lint --rate 250 --group mixer,attitude_law,rate_law
    [ "$status" -eq 0 ]
    has "numeric vectors, 0 too near to a decision"
    selected=(--rate 50)
  fi
  run "$ATTEST" vectors --lint "${selected[@]}"
  [ "$status" -eq 0 ]
  has "numeric vectors, 0 too near to a decision"
}

@test "each threshold of the law has a vector on it, and numeric ones close to it on both sides" {
  nm "$ATTEST" | grep -q __asan_init && skip "measured without sanitizers"
  run "$ATTEST" vectors --lint --verbose
  [ "$status" -eq 0 ]
  has "0 places without a vector"
}

@test "a threshold without vectors next to it is reported" {
  make_suite
  run "$ATTEST" --suite suite vectors --lint --verbose
  [ "$status" -eq 1 ]
  has "thrust gate           below            MISSING"
  has "attitude/roll@50hz at tick 0: MISSING, this is too far"
  run "$ATTEST" --suite suite vectors --lint
  [ "$status" -eq 0 ]
  run "$ATTEST" vectors --verbose
  [ "$status" -eq 2 ]
}

@test "a vector that comes too near is refused, with the tick and the way out" {
  make_suite
  cat >>suite/cases/px4-v1.5.5/attitude/roll.toml <<'T'
thrust = 0.2
T
  run "$ATTEST" --suite suite vectors --lint
  [ "$status" -eq 1 ]
  has "roll.toml: at 50hz, tick 0, thrust gate is at 0; a numeric vector needs at least 1e-06, or"
  run "$ATTEST" vectors
  [ "$status" -eq 2 ]
}

@test "a mixer's vectors say which mixer they are for" {
  run "$ATTEST" vectors out --filter 'mixer/linear_*'
  [ "$status" -eq 0 ]
  has "4 input traces in out"
  grep -q "R: 6x 10000 10000 10000 0" out/px4-v1.5.5/mixer/linear_hexa_x/provenance.toml
  head -1 out/px4-v1.5.5/mixer/linear_hexa_x/250hz.csv | grep -q "in/actuator_controls_0.control"
}

@test "vectors record their profile, and keep the provenance of the folder" {
  "$ATTEST" vectors out --profile px4-v1.3.4 --group anti_windup --rate 250
  grep -q "px4-v1.3.4" out/px4-v1.3.4/anti_windup/*/provenance.toml
  "$ATTEST" vectors out --profile px4-v1.5.5 --filter 'rates/*' --rate 250
  "$ATTEST" vectors out --profile px4-v1.5.5 --filter 'rates/*' --rate 100
  grep -q "px4-v1.5.5" out/px4-v1.5.5/rates/*/provenance.toml
  echo typo >>out/px4-v1.5.5/rates/p_alone/provenance.toml
  run "$ATTEST" vectors out --profile px4-v1.5.5 --filter 'rates/*' --rate 100
  [ "$status" -eq 2 ]
  has "rates/p_alone/provenance.toml:"
  grep -q typo out/px4-v1.5.5/rates/p_alone/provenance.toml
}
