load common

@test "the reference and a right port are not accused" {
  run "$ATTEST" hunt --steps 100000 --json found.json
  [ "$status" -eq 0 ]
  has "PASS 0 findings"
  grep -q '"findings": \[\]' found.json
  for port in builtin "lib:$STARTER"; do
    run "$ATTEST" hunt --steps 300000 --level exact --port "$port"
    [ "$status" -eq 0 ]
  done
  for port in right_quaternion right_cascade_quaternion; do
    run "$ATTEST" hunt --steps 100000 --port "lib:$PORTS/$port.so"
    [ "$status" -eq 0 ]
  done
}

@test "a mistake is found, shrunk and named, and its case fails" {
  run "$ATTEST" hunt --module rate_unit --profile v1.16.0 --steps 100000 --out ours \
    --port fault:cascade-d-reversed --json found.json --junit found.xml --html found.html
  [ "$status" -eq 1 ]
  has "FAIL 1 finding "
  has "cascade-d-reversed: adds D instead of subtracting it"
  grep -q '"fault": "cascade-d-reversed"' found.json
  grep -q '<testcase .*cascade_d_reversed' found.xml
  grep -q 'cascade_d_reversed: values' found.html
  made=ours/cases/px4-v1.16.0/hunt/cascade_d_reversed.toml
  has "case: $made"
  [ "$(wc -l <$made)" -lt 40 ]
  grep -q 'Fill in' $made
  reproduce=$(sed -n "s,.*reproduce: attest,,p" <<<"$output")
  run eval "\"$ATTEST\" $reproduce"
  [ "$status" -eq 1 ]
}

@test "several findings are listed without their cases, which --verbose prints" {
  two=(hunt --module rate_law,attitude_law --profile v1.16.0 --steps 60000
    --port fault:cascade-d-reversed+cascade-m-not-canonical)
  run "$ATTEST" "${two[@]}"
  [ "$status" -eq 1 ]
  has "cascade_d_reversed: differs from the reference; first at tick "
  has "cascade_m_not_canonical: differs from the reference; first at tick "
  has "--out DIR writes each finding as a case, with the command that runs it; --verbose prints"
  lacks "duration_ticks"
  run "$ATTEST" "${two[@]}" --verbose
  [ "$(grep -c duration_ticks <<<"$output")" -eq 2 ]
  lacks "--out DIR"
  run "$ATTEST" "${two[@]}" --out two
  lacks "duration_ticks"
  [ "$(grep -c '  reproduce: attest replay ' <<<"$output")" -eq 2 ]
}

@test "a finding runs as a trace and as a case" {
  "$ATTEST" hunt --module attitude_unit --steps 100000 --out ours --profile v1.15.4 \
    --port fault:cascade-m-not-canonical >found.txt || [ $? -eq 1 ]
  trace=(ours/traces/px4-v1.15.4/hunt/*.csv)
  run "$ATTEST" replay "${trace[0]}" --profile v1.15.4 --port fault:cascade-m-not-canonical
  [ "$status" -eq 1 ]
  run "$ATTEST" replay "${trace[0]}" --profile v1.15.4
  [ "$status" -eq 0 ]
  local commands found_port=fault:cascade-m-not-canonical
  grep -qF "  run all: attest --suite ours run --group hunt --port $found_port" found.txt
  run "$ATTEST" --suite ours run --group hunt --port $found_port --json report.json
  [ "$status" -eq 1 ]
  has "differs from the reference"
  has "; the reference alone judged 1 vector, because the suite has no golden of it"
  grep -q '"no_golden": true' report.json
  run "$ATTEST" --suite ours run --filter '*/attitude/roll_30@250hz' --profile v1.16.0
  [ "$status" -eq 0 ]  # a case of the base
  has "conformance: partial: "
  commands=$(sed -n 's/^ *keep: write the `why` of the cases, then attest //p' found.txt)
  eval "\"$ATTEST\" $commands" >/dev/null
  run "$ATTEST" --suite ours run --group hunt
  lacks "no golden"
  run "$ATTEST" --suite ours run --group hunt --port fault:cascade-m-not-canonical --no-diagnose
  [ "$status" -eq 1 ]
  run "$ATTEST" --suite ours run --group hunt
  [ "$status" -eq 0 ]
}

@test "the same seed gives the same findings for any number of jobs" {
  hunt() {
    "$ATTEST" hunt --port fault:cascade-m-not-canonical+cascade-d-reversed --profile v1.16.0 \
      --steps 100000 "$@" || [ $? -eq 1 ]
  }
  for seed in 1 18446744073709551615; do
    hunt --seed $seed --jobs 1 --json one.$seed >text.one 2>/dev/null
    hunt --seed $seed --jobs 2 --json two.$seed >text.two 2>/dev/null
    cmp one.$seed two.$seed
    cmp text.one text.two
  done
  must_fail cmp -s one.1 one.18446744073709551615
}

@test "a case of a hunt overwrites no file, and is in no released suite" {
  for _ in 1 2; do
    run "$ATTEST" hunt --module rate_law --steps 1000 --out ours --port fault:cascade-d-reversed
    [ "$status" -eq 1 ]
  done
  [ "$(find ours -name 'cascade_d_reversed*.toml' | wc -l)" -eq 2 ]
  run "$ATTEST" hunt --steps 1000 --out "$SOURCE"
  [ "$status" -eq 2 ]
}

@test "a port that hangs ends a hunt, also if it hangs when it is loaded" {
  run timeout 60 "$ATTEST" hunt --port "lib:$PORTS/port_hang.so" --timeout 0.2 --steps 1e9
  [ "$status" -eq 1 ]
  has "ended early: the port did not answer in time in "
  has "timeout"
  for port in port_hangs_in_create port_hangs_in_load; do
    run timeout 60 "$ATTEST" hunt --port "lib:$PORTS/$port.so" --timeout 0.2
    [ "$status" -eq 2 ]
    has "$port.so: "
    has "no answer within 0.2 s"
  done
}

@test "Ctrl-C ends a hunt with what was found" {
  "$ATTEST" hunt --port fault:cascade-d-reversed --module rate_unit --steps 1e12 --jobs 2 \
    --json found.json >out.txt 2>err.txt &
  pid=$!
  sleep 6
  kill -INT $pid
  status=0
  wait $pid || status=$?
  [ "$status" -eq 130 ]
  grep -q "ended early: interrupted" out.txt
  grep -q '"fault": "cascade-d-reversed"' found.json
  grep -q '"ended_early": "interrupted"' found.json
}

@test "--fail-fast ends after the round that has the first finding" {
  run "$ATTEST" hunt --fail-fast --steps 1e12 --module rate_unit --port fault:cascade-d-reversed \
    --json found.json
  [ "$status" -eq 1 ]
  has "ended early: at the first finding"
  grep -q '"fault": "cascade-d-reversed"' found.json
  grep -q '"trials": 1024' found.json
  run "$ATTEST" hunt --fail-fast --steps 1000 --module rate_unit
  [ "$status" -eq 0 ]
  lacks "ended early"
}

@test "a topic that is never published is one finding" {
  run "$ATTEST" hunt --steps 1000 --port "lib:$PORTS/port_silent_topic.so"
  [ "$status" -eq 1 ]
  has "FAIL 1 finding "
  has "the port never publishes mc_att_ctrl_status; its other outputs are judged"
  run "$ATTEST" hunt --steps 1000 --port "lib:$PORTS/port_silent.so"
  [ "$status" -eq 1 ]
  has "FAIL 3 findings "
  has "the port never publishes actuator_controls_0"
}

@test "a port is hunted for what it has" {
  run "$ATTEST" hunt --steps 100000 --port "lib:$PORTS/port_lacks.so"
  [ "$status" -eq 0 ]
  has "PASS 0 findings"
}

@test "a port that crashes is a finding, and wrong options are errors" {
  run "$ATTEST" hunt --steps 1000 --port "lib:$PORTS/port_crash.so"
  [ "$status" -eq 1 ]
  has "crash"
  run "$ATTEST" hunt --module rate_unti
  [ "$status" -eq 2 ]
  has 'did you mean `rate_unit`?'
  run "$ATTEST" hunt --module attitude
  [ "$status" -eq 2 ]
  has "--module attitude: no such module; did you mean \`attitude_unit\`?"
  run "$ATTEST" hunt --profile v1.13
  [ "$status" -eq 2 ]
  run "$ATTEST" hunt --level events
  [ "$status" -eq 2 ]
  run "$ATTEST" hunt --module mixer --port "lib:$STARTER"
  [ "$status" -eq 2 ]
  run "$ATTEST" hunt --steps 1000 --port "lib:$PORTS/right_cascade_fixed_22.so"
  [ "$status" -eq 2 ]
  has "a port in fixed point cannot be hunted"
  run "$ATTEST" hunt --seconds 1 --module rate_law
  [ "$status" -eq 0 ]
}

@test "a hunt begins where the last one with this corpus ended" {
  hunt() {
    "$ATTEST" hunt --module rate_law --profile v1.16.0,v1.15.4 --steps 1000 "$@" 2>/dev/null
  }
  hunt --corpus kept --port fault:cascade-d-reversed >out.txt || [ $? -eq 1 ]
  cases=$(find kept -name '*.toml' | wc -l)
  grep -q "corpus kept: began with 0 cases; added $cases" out.txt
  grep -q "Found by attest hunt" kept/cases/*/hunt/rate_law_*.toml
  grep -q "Kept by attest hunt" kept/cases/*/hunt/rate_law_*.toml
  cp -r kept copy
  hunt --seed 2 --corpus kept --jobs 1 >one.txt
  mv kept other
  mv copy kept
  hunt --seed 2 --corpus kept --jobs 2 >two.txt
  grep -q "corpus kept: began with $cases cases; added" one.txt
  cmp one.txt two.txt
  diff -r kept other
  run "$ATTEST" --suite kept list --group hunt
  [ "$status" -eq 0 ]
  has "px4-v1.16.0/hunt/rate_law_"
  run "$ATTEST" hunt --corpus copied --module rate_law --profile v1.16.0 --steps 1000
  cases=$(find copied -name '*.toml' | wc -l)
  run "$ATTEST" hunt --corpus copied --module mixer --steps 1000
  [ "$status" -eq 0 ]
  has "corpus copied: began with 0 cases, skipped $cases (of a profile or module"
}

@test "a corpus has only cases" {
  mkdir notes
  echo mine >notes/readme.txt
  run "$ATTEST" hunt --steps 1000 --corpus notes
  [ "$status" -eq 2 ]
  has "notes: has files but no cases/, so it is no corpus; name another folder"
  mkdir -p kept/cases/px4-v1.16.0/hunt
  echo 'schema = 1' >kept/cases/px4-v1.16.0/hunt/mine.toml
  run "$ATTEST" hunt --steps 1000 --corpus kept
  [ "$status" -eq 2 ]
  has "kept/cases/px4-v1.16.0/hunt/mine.toml"
  has "correct or remove it, or name another folder"
  run "$ATTEST" hunt --steps 1000 --corpus "$SOURCE"
  [ "$status" -eq 2 ]
}

@test "a hunt varies what the units received in a flight" {
  "$PYTHON" "$SOURCE/tests/cli/cascade_log.py" flight.ulg
  "$ATTEST" sim gust --rate 250 --out gust.ulg >/dev/null
  run "$ATTEST" hunt --log flight.ulg --log gust.ulg --steps 1000 --module rate_unit,mc_att_control
  [ "$status" -eq 0 ]
  [[ $output =~ "log flight.ulg: began with "[1-9] ]]
  [[ $output =~ "log gust.ulg: began with "[1-9] ]]
  run "$ATTEST" hunt --log flight.ulg --steps 1000 --module mixer
  [ "$status" -eq 2 ]
  has "flight.ulg: has the rate unit of px4-v1.16.0, which this hunt does not have; choose others"
  echo "no log" >wrong.ulg
  run "$ATTEST" hunt --log wrong.ulg
  [ "$status" -eq 2 ]
  has "wrong.ulg: is a text, and not a ULog"
}
