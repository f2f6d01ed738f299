load common

# judged PORT: runs it on a few quick cases.
judged() {
  run "$ATTEST" run --port "lib:$PORTS/port_$1.so" --filter 'rates/*@250hz' \
    --timeout 2 --junit junit.xml --json report.json "${@:2}"
}

@test "one sign flipped: exit 1, and the report names channel and tick" {
  judged sign_flip
  [ "$status" -eq 1 ]
  has "first at tick"
  has "out/actuator_controls_0.control[1]"
  has "reproduce: attest run --port"
  xmllint --noout --schema "$SOURCE/tests/harness/report/junit.xsd" junit.xml
}

@test "the command that a failure names reproduces it" {
  judged sign_flip
  command=$(grep -o 'reproduce: .*' <<<"$output" | head -1)
  command=${command#reproduce: attest }
  run bash -c "\"$ATTEST\" $command"
  [ "$status" -eq 1 ]
  has "FAIL 1 of 1 vector failed"
}

@test "a port that crashes costs its verdicts, not the run" {
  judged crash
  [ "$status" -eq 1 ]
  has "crash"
  has "FAIL"
  xmllint --noout junit.xml
}

@test "a port that exits is distinguished from one that answers" {
  judged exits
  [ "$status" -eq 1 ]
  has "exited with status 0"
}

@test "a port that throws through the C ABI has crashed, and the reports are written" {
  judged throws
  [ "$status" -eq 1 ]
  has "gimbal lock in aisle 3"
  has "FAIL"
  xmllint --noout junit.xml
  [ -z "$(find . -name '.junit*')" ]
}

@test "a port that hangs is given up" {
  run "$ATTEST" run --port "lib:$PORTS/port_hang.so" --filter 'rates/*' --timeout 0.3 --fail-fast
  [ "$status" -eq 1 ]
  has "no answer within 0.3 s"
}

@test "a port that hangs in another function, or when it is loaded, is given up too" {
  for function in load create set_parameter destroy; do
    run timeout -k 1 100 "$ATTEST" run --port "lib:$PORTS/port_hangs_in_$function.so" \
      --filter rates/ff_alone@250hz --timeout 0.5 --json report.json
    [ "$status" -eq 1 ]
    has "timeout"
    has "no answer within 0.5 s"
    grep -q '"verdict": "timeout"' report.json
  done
}

@test "every command that steps a port has the same limit" {
  cat >tasks.toml <<'TASKS'
[task.unit]
rate_hz = 250
execution_us = 76
priority = 1
TASKS
  for command in "sim hover --rate 250 --out f.csv" "schedule tasks.toml" \
    "sweep-rate --vehicle iris --plant ode --rates 250" "time --filter rates/ff_alone@250hz" \
    "replay $SOURCE/golden/recorded/px4-v1.5.5/fuzz_250hz.csv"; do
    read -ra words <<<"$command"
    run timeout -k 1 100 "$ATTEST" "${words[@]}" --port "lib:$PORTS/port_hang.so" --timeout 0.5
    echo "$command: $status"
    [ "$status" -eq 1 ]
    has "timeout"
    has "no answer within 0.5 s"
  done
  for function in load create; do
    local port="lib:$PORTS/port_hangs_in_$function.so"
    run timeout -k 1 100 "$ATTEST" sim hover --rate 250 --out f.csv --port "$port" --timeout 0.5
    [ "$status" -eq 1 ]
    has "no answer within 0.5 s"
    run timeout -k 1 100 "$ATTEST" doctor --port "$port" --timeout 0.5
    [ "$status" -eq 1 ]
    has "no answer within 0.5 s"
  done
  for command in run sim schedule sweep-rate time replay stress doctor; do
    run "$ATTEST" $command --help
    has "Limit for each answer of the port [s]"
  done
}

@test "NaN where a number belongs" {
  judged non_finite
  [ "$status" -eq 1 ]
  has "non-finite"
  has "out/actuator_controls_0.control[1]"
  has "tick 20"
}

@test "outputs never published" {
  judged silent
  [ "$status" -eq 1 ]
  has ".published"
}

@test "a step that fails, and one that is unsupported" {
  judged step_fails
  [ "$status" -eq 1 ]
  has "step at tick 20 returned ATTEST_FAILED; it last printed: no solution of the tilt"
  judged unsupported_step
  [ "$status" -eq 2 ]
  has "no vector was compared"
}

@test "a parameter that is a constant in the port: only the cases that set it are not judged" {
  run "$ATTEST" run --port "lib:$PORTS/port_constant_parameter.so" --profile px4-v1.5.5 \
    --group yaw_feed_forward,rate_limit --rate 250
  [ "$status" -eq 0 ]
  has "set_parameter(MC_YAW_FF) at tick 0 returned ATTEST_UNSUPPORTED"
  has "2 unsupported: set_parameter"
  lacks "fail:"
}

@test "what a port declares that it lacks is not judged, and the rest is" {
  run "$ATTEST" run --port "lib:$PORTS/port_lacks.so" --profile px4-v1.5.5 --rate 250 \
    --json lacks.json
  [ "$status" -eq 0 ]
  lacks "fail:"
  has "because: lacks mc_att_ctrl_status, battery, tpa, MC_YAW_FF=0.25; only --rate 250"
  has "the port declares that it lacks tpa, but it has that"
  has "unsupported: the port declares that it lacks battery"
  has "unsupported: MC_YAW_FF is 0.25 in the port, and this vector sets 0.8"
  has "unsupported: MC_YAW_FF is 0.25 in the port, and flights have its default"
  [ "$("$PYTHON" -c 'import json; print(json.load(open("lacks.json"))["port"]["lacks"])')" = \
    "['mc_att_ctrl_status', 'battery', 'tpa', 'MC_YAW_FF=0.25']" ]
}

@test "a constant that the port lets change is in a note" {
  run "$ATTEST" run --port "lib:$PORTS/port_constant_that_changes.so" --profile px4-v1.5.5 \
    --group yaw_feed_forward,rate_limit --rate 250
  [ "$status" -eq 0 ]
  has "the port declares that it lacks MC_YAW_FF, but it has that"
  has "unsupported: MC_YAW_FF is 0.5 in the port, and this vector sets"
}

@test "a topic that a port never publishes is one failure, and the rest is judged" {
  run "$ATTEST" run --port "lib:$PORTS/port_silent_topic.so" --profile px4-v1.5.5 --rate 250
  [ "$status" -eq 1 ]
  [[ ${lines[-1]} =~ ^FAIL\ 1\ of\ [0-9]+\ vectors\ failed,\  ]]
  has "fail: the port never publishes mc_att_ctrl_status, which "
  has "in out/mc_att_ctrl_status.published"
  lacks "it looks like"
  # One expected failure does not excuse the other vectors.
  printf '[expected]\n"px4-v1.5.5/actuators/circuit_breaker" = "no topic"\n' >known.toml
  run "$ATTEST" run --port "lib:$PORTS/port_silent_topic.so" --profile px4-v1.5.5 --rate 250 \
    --expected-failures known.toml
  [ "$status" -eq 1 ]
  [[ ${lines[-1]} =~ ^FAIL\ 1\ of\ [0-9]+\ vectors\ failed,\  ]]
}

@test "a profile that the port refuses is skipped, and nothing compared is not success" {
  judged refuses_profile
  [ "$status" -eq 2 ]
  has "note: the port does not support px4-v1.5.5; it printed: no gains for px4-v1.5.5"
  has "supports no profile: its create() returned NULL for each of px4-v1.5.5, px4-v1.3.4, "
}

@test "writing past the outputs breaks the ABI" {
  judged writes_wild
  [ "$status" -eq 1 ]
  has "protocol"
  has "attest_unit.h"
}

@test "right ports with awkward manners pass" {
  for port in global_state prints; do
    judged $port --level exact
    [ "$status" -eq 0 ]
    has "PASS"
    lacks "chatter"
  done
  judged sets_ftz
  [ "$status" -eq 0 ]
}

@test "a port is given the time of its sample" {
  judged timestamp_sample
  [ "$status" -eq 0 ]
  flight=(--filter '*/estimator_delay@250hz-iris-mujoco')
  flight+=(--port "lib:$PORTS/port_timestamp_sample.so")
  SAMPLE_DELAY_US=6000 run "$ATTEST" run "${flight[@]}"
  [ "$status" -eq 0 ]
  SAMPLE_DELAY_US=6001 run "$ATTEST" run "${flight[@]}"
  [ "$status" -eq 1 ]
  has "step at tick 2 returned ATTEST_FAILED"
}

@test "a file that is not a library" {
  run "$ATTEST" run --port lib:./missing.so
  [ "$status" -eq 2 ]
  has "missing.so: no such library"
  run "$ATTEST" run --port lib:.
  [ "$status" -eq 2 ]
  has "is a folder"
  echo "not a library" >text.so
  run "$ATTEST" run --port ./text.so
  [ "$status" -eq 2 ]
  has "./text.so: neither a shared library nor an executable file"
  run "$ATTEST" run --port lib:./text.so
  [ "$status" -eq 2 ]
  has "cannot be loaded"
  judged no_symbol
  [ "$status" -eq 2 ]
  has "attest_unit_v1"
  judged wrong_abi
  [ "$status" -eq 2 ]
  has "ABI version is 99"
  judged null_unit
  [ "$status" -eq 2 ]
  has "returned NULL"
  run "$ATTEST" run --port rust
  [ "$status" -eq 2 ]
  has 'unknown port `rust`'
  run "$ATTEST" run ./rust.so
  [ "$status" -eq 2 ]
  has "./rust.so: no such file; a port is a file or one of \`builtin\`"
  mkdir rust.so
  run "$ATTEST" run ./rust.so
  [ "$status" -eq 2 ]
  has "./rust.so: is a folder, not a port"
  echo "print()" >rust.so/port.py
  run "$ATTEST" run ./rust.so
  has "such as ./rust.so/port.py"
  run "$ATTEST" run ./rust.so/port.py
  [ "$status" -eq 2 ]
  has "./rust.so/port.py: is not executable; write \`proc:python3 ./rust.so/port.py\`"
  mkdir mine
  run "$ATTEST" run mine
  [ "$status" -eq 2 ]
  has "such as mine/port.so, or start its script mine/check"
}

@test "the C starter conforms to the bit" {
  run "$ATTEST" run --port "lib:$STARTER" --level exact --group attitude
  [ "$status" -eq 0 ]
}

@test "a port that forks is judged once a case, at once, and leaves nothing behind" {
  judged forks
  [ "$status" -eq 0 ]
  "$ATTEST" run --profile px4-v1.5.5 --profile px4-v1.3.4 --filter 'rates/*@250hz' \
    --json reference.json
  [ "$(grep -c '"id"' report.json)" -eq "$(grep -c '"id"' reference.json)" ]
  # The process would sleep for 60 s, so it was killed. Its command line would name the port.
  must_fail grep -qa "port_fork[s].so" /proc/[0-9]*/cmdline 2>/dev/null
}

@test "a port that stops listening is not said to be killed" {
  judged closes_descriptors --fail-fast
  [ "$status" -eq 1 ]
  has "crash: the port's process closed the socket on which it answers, and went on"
}

@test "stdin, stdout and stderr may be closed, and a summary that is lost is no success" {
  "$ATTEST" run --filter 'rates/*@250hz' <&- 2>&- >out.txt
  grep -q PASS out.txt
  "$ATTEST" run --filter 'rates/*@250hz' --json closed.json >&- 2>&- <&- || true
  grep -q '"verdict": "pass"' closed.json
  status=0
  "$ATTEST" run --filter 'rates/*@250hz' >/dev/full 2>errors.txt || status=$?
  [ "$status" -eq 2 ]
  grep -q "stdout" errors.txt
  status=0
  "$ATTEST" run --group nope 2>/dev/full || status=$?
  [ "$status" -eq 2 ]
}

@test "a port may make one of the two units of a profile" {
  port="lib:$PORTS/port_other_profiles.so"
  run "$ATTEST" run --port "$port" --group rates --group attitude --rate 250
  [ "$status" -eq 0 ]
  has "the port makes no module rate_unit of profile px4-v1.16.0"
  lacks "protocol"
  run "$ATTEST" run --port "$port" --filter 'px4-v1.16.0/flight/hover@250-1000hz-iris-ode'
  [ "$status" -eq 0 ]
  run "$ATTEST" smoke --port "$port"
  [ "$status" -eq 0 ]
  has "the port makes no module rate_unit of profile px4-v1.16.0"
  lacks "FAIL"
}

@test "what a port prints is shown if it fails, and is never on the stdout of attest" {
  local one=(printing.so --filter 'px4-v1.5.5/rates/p_alone@250hz') in_process
  cp "$SOURCE"/controller/starters/c/*.[ch] .
  sed -i 's/^static int step(.*{$/&\n  printf("my rate is %g\\n", in->control_state.roll_rate);/
    1i #include <stdio.h>' unit.c
  cc -shared -fPIC -ffp-contract=off "-I$SOURCE/controller" ./*.c -lm -o printing.so
  for in_process in "" --in-process; do
    "$ATTEST" run "${one[@]}" --json - $in_process >report.json 2>messages
    "$PYTHON" -m json.tool report.json >/dev/null
    "$ATTEST" run "${one[@]}" $in_process >text 2>>messages
    "$ATTEST" time "${one[@]}" $in_process >>text 2>>messages
    run grep "my rate is" text report.json
    [ "$status" -eq 1 ]
  done
  [ "$(grep -c '^my rate is' messages)" -ge 30 ]
  sed -i 's/rates_sp\[i\] - rates\[i\];/rates_sp[i] + rates[i];/' rate.c
  cc -shared -fPIC -ffp-contract=off "-I$SOURCE/controller" ./*.c -lm -o printing.so
  run "$ATTEST" run "${one[@]}"
  [ "$status" -eq 1 ]
  has "differs from the reference; the port last printed: my rate is "
  "$ATTEST" record px4-v1.5.5/rates/p_alone --rate 250 --out right.csv
  run "$ATTEST" replay right.csv --port lib:./printing.so
  [ "$status" -eq 1 ]
  has "the port last printed: my rate is "
}

@test "a port of other releases gets one line: what it supports, and the command for it" {
  port="lib:$PORTS/port_other_profiles.so"
  run "$ATTEST" run --port "$port" --profile v1.5.5 --json r.json
  [ "$status" -eq 2 ]
  [ "${#lines[@]}" -eq 2 ]
  has "attest: error: $port supports px4-v1.18, px4-v1.17, px4-v1.16.0, px4-v1.15.4, px4-v1.14.4, \
not px4-v1.5.5; write: attest run --profile px4-v1.18 --port $port"
  ends "NONE 0 vectors passed, 0 failed; * do not apply to this port *"
  grep -q '"the port does not support profile px4-v1.5.5"' r.json
  command=$(sed -n 's/.*; write: attest //p' <<<"$output")
  run "$ATTEST" $command --filter 'rates/p_alone@250hz'
  [ "$status" -eq 0 ]
  for name in hover flight/hover; do
    run "$ATTEST" sim $name "$port"
    [ "$status" -eq 0 ]
    has "px4-v1.18/flight/hover@250-1000hz"
  done
  run "$ATTEST" sim hover "$port" --rate 250:500
  [ "$status" -eq 0 ]
  has "px4-v1.18/flight/hover@250-500hz"
  run "$ATTEST" record v1.17/rates/p_alone "$port" --out alone.csv
  [ "$status" -eq 0 ]
  run "$ATTEST" run "$port" --filter 'v1.17/rates/p_alone@250hz'
  [ "$status" -eq 0 ]
  has "PASS 1 vector passed"
  run "$ATTEST" sim sticks "$port" # not the cases in open loop of this name
  has "px4-v1.18/flight/sticks@250-1000hz"
  run "$ATTEST" record p_alone "$port" --out alone.csv
  [ "$status" -eq 0 ]
  head -1 alone.csv | grep -q out/rate_ctrl_status # of the rate unit
  run "$ATTEST" sim px4-v1.5.5/flight/hover --rate 250 --port "$port" --plant ode
  [ "$status" -eq 2 ]
  has "write: attest sim px4-v1.18/flight/hover --rate 250:1000 --port $port --plant ode"
  for command in "hunt --profile v1.5.5" "time --profile v1.5.5 --rate 250" \
    "record px4-v1.5.5/rates/p_alone --rate 250" "stress --profile v1.5.5"; do
    run "$ATTEST" $command --port "$port"
    [ "$status" -eq 2 ]
    [[ $output == "attest: error: $port supports px4-v1.18, "*", not px4-v1.5.5; write: attest "* ]]
  done
}
