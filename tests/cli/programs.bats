load common

setup_file() {
  export PYTHONDONTWRITEBYTECODE=1 # the starter's folder stays as it is
}

program() { echo "proc:$PYTHON $SOURCE/tests/ports/programs/$1"; }
starter() { echo "proc:$PYTHON $SOURCE/controller/starters/python/port.py"; }

# judged PROGRAM: runs it on one vector.
judged() {
  run "$ATTEST" run --port "$(program "$1")" --filter px4-v1.5.5/rates/p_alone@250hz \
    --timeout 1 --no-diagnose --json report.json
}

# refused PROGRAM TEXT: the error, before anything runs.
refused() {
  judged "$1"
  [ "$status" -eq 2 ]
  has "$2"
  [ ! -e report.json ]
}

@test "a run of all vectors on a program names --core" {
  run timeout --signal=INT 5 "$ATTEST" run --port "$(starter)"
  has "for a slow port, --core selects few"
  run "$ATTEST" run --port "$(starter)" --filter px4-v1.5.5/rates/p_alone@250hz
  lacks "--core selects few"
}

@test "the starter in Python conforms, and keeps the rules of the exchange" {
  run "$ATTEST" smoke --verbose --port "$(starter)"
  [ "$status" -eq 0 ]
  lacks FAIL
  [ "$(grep -c '^pass' <<<"$output")" -eq 13 ]
  run "$ATTEST" run --port "$(starter)" --rate 250 --group attitude --group rates \
    --group tailsitter --group instances
  [ "$status" -eq 0 ]
  has "PASS"
}

@test "the starter answers the example of PROTOCOL.md byte for byte" {
  run "$PYTHON" "$SOURCE/tests/ports/programs/example.py" check "$PYTHON" \
    "$SOURCE/controller/starters/python/port.py"
  [ "$status" -eq 0 ]
}

@test "step by step, in batches, byte by byte, in shared memory and in text: the same bits" {
  for port in "program.py right" "program.py hello_in_batches" "program.py byte_by_byte" \
    "program.py right --shared" in_text.py "in_text.py fgetl"; do
    "$ATTEST" run --port "$(program "$port")" --filter 'px4-v1.5.5/rates/*@250hz' \
      --filter px4-v1.5.5/attitude/tilt_by_size@250hz --json report.json >/dev/null
    "$PYTHON" - >>headrooms <<'HEADROOM'
import json
print([(one["id"], one.get("tightest")) for one in json.load(open("report.json"))["results"]])
HEADROOM
  done
  [ "$(wc -l <headrooms)" -eq 6 ]
  [ "$(sort -u headrooms | wc -l)" -eq 1 ]
}

@test "every command that takes a port takes a program" {
  local trace="$SOURCE/golden/recorded/px4-v1.5.5/fuzz_250hz.csv"
  "$ATTEST" replay --port "$(starter)" "$trace"
  "$ATTEST" sim hover --rate 250 --port "$(starter)" --out flight.csv
  run "$ATTEST" time --port "$(starter)" --filter rates/p_alone@250hz
  [ "$status" -eq 0 ]
  lacks "stack of a step"
  "$ATTEST" doctor --port "$(starter)" >/dev/null
  run "$ATTEST" stress --port "$(starter)" --rates 50 --duration 0.5 --no-cyclictest
  [ "$status" -ne 2 ] || has "not judged"
  has "outputs agree"
}

@test "a wrong program fails like a wrong library, and the stage is named" {
  cp -r "$SOURCE/controller/starters/python" wrong
  sed -i 's/(abs(thrust) - gains.tpa_break)/(thrust * thrust - gains.tpa_break)/' wrong/law.py
  grep -q 'thrust \* thrust' wrong/law.py
  run "$ATTEST" run --port "proc:$PYTHON wrong/port.py" --rate 250 --group tpa
  [ "$status" -eq 1 ]
  has "it looks like no fault of the catalogue"
  has "first stage to differ: rate law in "
}

@test "a program that cannot be started is an error before anything runs" {
  run "$ATTEST" run --port proc:no-such-program
  [ "$status" -eq 2 ]
  has "no-such-program: no program of this name is in PATH"
  echo text >file
  run "$ATTEST" run --port "proc:./file"
  [ "$status" -eq 2 ]
  has "is no file that may be executed (chmod +x)"
  run "$ATTEST" run --port "proc:$PYTHON 'port.py"
  [ "$status" -eq 2 ]
  has "has a quote or a brace that is not closed"
  run "$ATTEST" run --port "proc:$PYTHON port.py | tee log"
  [ "$status" -eq 2 ]
  has "no shell runs"
  run "$ATTEST" run --port "proc:"
  [ "$status" -eq 2 ]
  has "needs a command"
}

# The unit tests of harness/port have every wrong answer.
@test "a wrong answer to the handshake is an error before anything runs" {
  refused "program.py hello_is_no_json" "its first line on stdout is \`ready\`, which is no JSON"
  refused "program.py hello_repeats" "its answer to the handshake has \`version\` twice in one"
  refused "program.py hello_repeats_escaped" "its answer to the handshake has a key twice"
  refused "program.py hello_misspells" "unknown member \`fixed_setp\`; did you mean \`fixed_step\`?"
  refused "program.py hello_has_no_end" "has no end within 65536 bytes"
  refused "program.py ends_at_once" "exited with status 1 before it answered the handshake"
  has "it last printed: no license found"
}

@test "a wrong answer to a step breaks the protocol, and the message says how" {
  judged "program.py prints"
  [ "$status" -eq 1 ]
  has "protocol: at tick 19: the answer to the request \`step\` begins with the bytes \`roll = 0.3"
  judged "in_text.py stale"
  [ "$status" -eq 1 ]
  has "protocol: at tick 19: the answer to the request \`step\` has the sequence number 28"
  judged "in_text.py repeats"
  [ "$status" -eq 1 ]
  has "the answer to the request \`step\` has \`out/vehicle_rates_setpoint.roll\` twice in one"
  judged "program.py no_result"
  [ "$status" -eq 1 ]
  has "protocol: step at tick 19 returned 77, which is no ATTEST_ result"
}

@test "a program that says something else of itself later breaks the protocol" {
  echo 0 >starts
  STARTS="$PWD/starts" judged "program.py hello_changes"
  [ "$status" -eq 1 ]
  has "protocol: its name is \`other\`, it was \`program\` when the port was asked first"
}

# starts_of MODE: the vectors of a group by one worker; prints how often the program was started.
starts_of() {
  : >starts
  STARTS="$PWD/starts" run "$ATTEST" run --port "$(program "$1")" --group attitude --rate 250 \
    --profile px4-v1.5.5 --jobs 1 --no-diagnose
}

@test "one process of a program serves many vectors, also if they fail" {
  starts_of "program.py counts_starts"
  [ "$status" -eq 0 ]
  has "PASS 18 vectors passed, 0 failed"
  [ "$(wc -l <starts)" -eq 3 ] # two answer what it is
  starts_of "program.py rolls"
  [ "$status" -eq 1 ]
  has "FAIL 18 of 20 vectors failed"
  [ "$(wc -l <starts)" -eq 6 ] # three failures were repeated alone
  starts_of "program.py one_unit"
  [ "$status" -eq 0 ]
  [ "$(wc -l <starts)" -eq 22 ] # each vector has a process of its own
}

@test "a program that ends is a crash with its status, signal and last words" {
  judged "program.py exits"
  [ "$status" -eq 1 ]
  has "crash: at tick 19: the program exited with status 3 in the request \`step\`"
  has "it last printed: motor table lost"
  judged "program.py killed"
  has "crash: at tick 19: the program was killed by signal 11 (Segmentation fault)"
  judged "program.py half"
  has "crash: at tick 19: the program exited with status 0 after 20 bytes of an answer"
  judged "program.py leaves_a_child"
  has "crash: at tick 19: the program exited with status 4"
  judged "program.py closes_stdout"
  has "crash: at tick 19: the program closed its stdout"
  judged "program.py floods_stderr"
  has "crash: at tick 19: "
  nothing_is_left
}

@test "a unit that cannot be made or destroyed is a failure, too" {
  judged "program.py exits_in_destroy"
  [ "$status" -eq 1 ]
  has "crash: the program exited with status 5 in the request \`destroy\`"
  judged "program.py destroy_fails"
  [ "$status" -eq 1 ]
  has "protocol: the answer to the request \`destroy\` has the result 3"
  judged "program.py create_fails"
  [ "$status" -eq 1 ]
  has "protocol: the answer to the request \`create\` has the result 3"
  run "$ATTEST" smoke --port "$(program "program.py exits_in_destroy")"
  [ "$status" -eq 1 ]
  has "FAIL"
}

@test "a program that does not answer is a timeout, and nothing of it is left" {
  judged "program.py hangs"
  [ "$status" -eq 1 ]
  has "timeout: no answer within 3 s of sleep in step() at tick 19"
  judged "program.py never_answers"
  has "timeout: no answer within 3 s of sleep, when it was loaded"
  judged "program.py does_not_read"
  has "timeout: no answer within 3 s of sleep in create()"
  nothing_is_left
}

@test "in shared memory, too, a program that ends is a crash, and a silent one a timeout" {
  judged "program.py exits --shared"
  [ "$status" -eq 1 ]
  has "crash: at tick 19: the program exited with status 3 in the request \`step\`"
  judged "program.py closes_stdout --shared"
  [ "$status" -eq 1 ]
  has "timeout: no answer within 3 s of sleep in step() at tick 19"
  judged "program.py prints --shared"
  has "the answer to the request \`step\` begins with the bytes \`roll = 0.3"
  nothing_is_left
}

@test "the statement has a hash of the program and of its files" {
  cp -r "$SOURCE/controller/starters/python" mine
  local run=("$ATTEST" run --port "proc:$PYTHON mine/port.py" --filter rates/p_alone@250hz)
  hash_of() { grep -o 'port [0-9a-f]\{12\}' <<<"$output" | head -n 1; }
  run "${run[@]}"
  local first
  first=$(hash_of)
  [ -n "$first" ]
  run "${run[@]}"
  [ "$(hash_of)" = "$first" ]
  echo "# another version" >>mine/port.py
  run "${run[@]}"
  [ "$(hash_of)" != "$first" ]
}
