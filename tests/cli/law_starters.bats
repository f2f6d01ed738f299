# The starters that have the two laws alone: the cases of both laws.

load common

setup_file() {
  export PYTHONDONTWRITEBYTECODE=1 # the starter's folder stays as it is
}

starters="$(dirname "$STARTER")/.."
in_c="lib:$starters/c_law/attest_starter_c_law.so"
in_python="$SOURCE/controller/starters/python_law"

@test "the starter in C has the laws of v1.14 to v1.17, and the rate law of v1.18, to the bit" {
  run "$ATTEST" run --level exact --group attitude_law,rate_law --port "$in_c"
  [ "$status" -eq 0 ]
  # All vectors, but for these three reasons, which are no fault of the port.
  [[ $output =~ PASS\ ([0-9]+)\ vectors\ passed ]]
  [ "${BASH_REMATCH[1]}" -ge 174 ]
  [ "$(grep -cE '^ +[0-9]+ (skip|unsupported)' <<<"$output")" -eq 0 ]
  [ "$(grep -A9 ' do not apply to this port, which need not have all' <<<"$output" |
    grep -cE '^      [0-9]+: ')" -eq 3 ]
  has ": the port makes no module attitude_law of profile px4-v1.18"
  has ": the port does not support profile px4-v1.3.4"
  has ": the port does not support profile px4-v1.5.5"
  [[ ${lines[-1]} =~ \;\ [0-9]+\ do\ not\ apply\ to\ this\ port\ \( ]]
}

@test "without a unit the starter in C does not fly" {
  run "$ATTEST" run --filter '*/flight/hover@100-400hz-iris-ode' --profile px4-v1.16.0 \
    --filter '*/rate_law/d' --port "$in_c"
  [ "$status" -eq 0 ]
  has "1 vector passed, 0 failed; 1 "
  has "the port has no module rate_unit"
}

@test "the starter in Python has them to the bit, too" {
  # One profile: the law is the same in the others.
  run "$ATTEST" run --level exact --group attitude_law,rate_law --profile px4-v1.17 \
    --port "proc:$PYTHON $in_python/port.py"
  [ "$status" -eq 0 ]
  [[ $output =~ PASS\ ([0-9]+)\ vectors\ passed,\ 0\ failed\ \( ]]
  [ "${BASH_REMATCH[1]}" -ge 39 ]
  run "$ATTEST" smoke --port "proc:$PYTHON $in_python/port.py"
  [ "$status" -eq 0 ]
  lacks FAIL
}

@test "the starter in Octave has them to the bit, too" {
  command -v octave-cli >/dev/null || skip "no octave-cli"
  local port="proc:octave-cli --norc --quiet $SOURCE/controller/starters/octave/port.m"
  run "$ATTEST" run --level exact --group attitude_law,rate_law --profile px4-v1.17 --port "$port"
  [ "$status" -eq 0 ]
  [[ $output =~ PASS\ ([0-9]+)\ vectors\ passed,\ 0\ failed\ \( ]]
  [ "${BASH_REMATCH[1]}" -ge 39 ]
  run "$ATTEST" smoke --port "$port"
  [ "$status" -eq 0 ]
  lacks FAIL
}

@test "a mistake in the starter in Octave is found" {
  command -v octave-cli >/dev/null || skip "no octave-cli"
  cp -r "$SOURCE/controller/starters/octave" wrong
  sed -i 's/ + integral - / - integral - /' wrong/rate_law.m
  run cmp -s wrong/rate_law.m "$SOURCE/controller/starters/octave/rate_law.m"
  [ "$status" -eq 1 ]
  run "$ATTEST" run --filter 'px4-v1.17/rate_law/integral' \
    --port "proc:octave-cli --norc --quiet wrong/port.m"
  [ "$status" -eq 1 ]
  has "look first at the rate law"
}

@test "a mistake in a law of theirs is found" {
  cp -r "$in_python" wrong
  sed -i 's/+ self.integral\[axis\]$/- self.integral[axis]/' wrong/law.py
  run cmp -s wrong/law.py "$in_python/law.py"
  [ "$status" -eq 1 ]
  run "$ATTEST" run --filter 'px4-v1.17/rate_law/integral' --port "proc:$PYTHON wrong/port.py"
  [ "$status" -eq 1 ]
  has "look first at the rate law"
}

@test "the statement is about the laws that were judged" {
  run "$ATTEST" run --group attitude_law,rate_law --profile px4-v1.16.0 --port "$in_c" --json r.json
  [ "$status" -eq 0 ]
  has "conformant: attitude_law, rate_law of px4-v1.16.0, numeric, 1 rate"
  grep -q '"standing": "conformant"' r.json
  run "$ATTEST" run --filter '*/rate_law/p_and_feed_forward' --profile px4-v1.16.0 --port "$in_c"
  [ "$status" -eq 0 ]
  has "because: only a part of rate_law"
}

@test "a law is judged from files, with a row for each call" {
  "$ATTEST" vectors calls --group rate_law --profile px4-v1.16.0 --exclude '*/not_finite' >/dev/null
  "$PYTHON" "$SOURCE/tests/ports/recorded/rate_law.py" calls
  run "$ATTEST" run --port recorded:calls --group rate_law --profile px4-v1.16.0
  [ "$status" -eq 0 ]
  has "PASS 15 vectors passed, 0 failed; 1 need --level exact, 2 skip"
}

@test "a trace of a law is replayed" {
  "$ATTEST" record px4-v1.16.0/rate_law/reset --rate 250 --out reset.csv
  run "$ATTEST" replay reset.csv --port "$in_c" --level exact
  [ "$status" -eq 0 ]
  run "$ATTEST" replay reset.csv --port fault:cascade-i-factor-linear
  [ "$status" -eq 1 ]
  has "look first at the integrator"
}

@test "a port that has units is judged as a whole, also if only a law is selected" {
  run "$ATTEST" run --group rate_law --profile px4-v1.16.0 --port fault:cascade-spool-up-missing \
    --json r.json
  [ "$status" -eq 0 ]
  has "partial: px4-v1.16.0"
  has "because: only --group rate_law"
  grep -q '"standing": "partial"' r.json
}
