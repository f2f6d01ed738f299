load common

# Two cases of different groups, judged one after the other, each in a process of its own. ./suite
# has the goldens of attest's law, ./forged those of a wrong port.
two_suites() {
  make_suite
  mkdir suite/cases/px4-v1.5.5/rates
  sed 's/"attitude"/"rates"/; s/roll\./turn./; s/amplitude = 0.3/amplitude = 0.4/' \
    suite/cases/px4-v1.5.5/attitude/roll.toml >suite/cases/px4-v1.5.5/rates/turn.toml
  cp -r suite forged
  rm -r forged/golden
  "$ATTEST" --suite suite bless --yes --reason "a test" >/dev/null
  "$ATTEST" --suite forged bless --port "lib:$PORTS/hostile_negated_torque.so" --yes \
    --reason "a test" >/dev/null
}

# in_first_step COMMAND...: runs the command with the port hostile_waits in the background, and
# returns when the port waits in its first step. `gone_on` continues it, as `run` does.
in_first_step() {
  export MEDDLE_GO="$BATS_TEST_TMPDIR/go"
  "$@" >output 2>&1 3>&- &
  running=$!
  for _ in $(seq 600); do
    waits && return 0
    sleep 0.1
  done
  cat output
  return 1
}

# waits: whether a process of this test's port waits.
waits() {
  local process
  for process in $(grep -lx in_step /proc/[0-9]*/comm 2>/dev/null); do
    grep -qzx "MEDDLE_GO=$MEDDLE_GO" "${process%comm}environ" 2>/dev/null && return 0
  done
  return 1
}

gone_on() {
  touch "$MEDDLE_GO"
  status=0
  wait "$running" || status=$?
  output=$(<output)
  echo "$output"
}

golden=golden/px4-v1.5.5/rates/turn

@test "a golden that is replaced after the suite was hashed is an error" {
  two_suites
  judged=("$ATTEST" --suite suite run --port "lib:$PORTS/hostile_waits.so" --rate 250 --jobs 1
    --no-diagnose --json report.json)
  in_first_step "${judged[@]}"
  cp -r forged/$golden/. suite/$golden/
  gone_on
  [ "$status" -eq 2 ]
  has "suite/$golden/provenance.toml: changed during the run"
  lacks "turn@250hz "
  grep -q "none: the run is not complete" report.json
}

@test "a port that meddles with the suite does not pass" {
  two_suites
  for how in in_create in_thread by_rename; do
    rm -rf judged
    cp -r suite judged
    MEDDLE_WITH=""
    for case in attitude/roll rates/turn; do
      for file in provenance.toml 250hz.csv; do
        path="golden/px4-v1.5.5/$case/$file"
        MEDDLE_WITH+="forged/$path=judged/$path:"
      done
    done
    export MEDDLE_WITH
    run "$ATTEST" --suite judged run --port "lib:$PORTS/hostile_meddles_$how.so" --rate 250 \
      --no-diagnose
    echo "$how: $status"
    [ "$status" -ne 0 ]
    lacks "PASS"
  done
}
