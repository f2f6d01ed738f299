load common

# judged PORT: runs it on a few quick cases.
judged() {
  run "$ATTEST" run --port "lib:$PORTS/hostile_$1.so" --filter 'rates/*@250hz' \
    --filter 'rates/*@100hz' --json report.json --badge badge.svg --no-diagnose "${@:2}"
}

@test "create() that returns NULL later breaks the protocol: the profile was supported" {
  judged one_unit
  [ "$status" -eq 1 ]
  has 'protocol: create("px4-v1.5.5") returned NULL; it made a unit when the port was asked first'
  lacks "does not support profile"
  grep -q "does not conform" badge.svg
  judged one_unit --in-process
  [ "$status" -eq 1 ]
  has "protocol"
  run "$ATTEST" run --port "lib:$PORTS/hostile_one_unit.so" --filter 'instances/*again*@250hz' \
    --no-diagnose
  [ "$status" -eq 1 ]
  has "protocol: create() returned NULL after the first instance was destroyed"
}

@test "parameters that outlive their instance fail" {
  run "$ATTEST" run --port "lib:$PORTS/hostile_keeps_parameters.so" --no-diagnose \
    --filter 'px4-v1.5.5/instances/made_again@250hz'
  [ "$status" -eq 1 ]
  has "px4-v1.5.5/instances/made_again@250hz"
  has "first at tick 0"
}

@test "what a port says of itself is asked once, and a change breaks the protocol" {
  judged arithmetic_later
  [ "$status" -eq 1 ]
  has 'its attest.arithmetic is `fixed:20`, it was `none`'
  lacks "fraction bits"
  judged arithmetic_changes
  [ "$status" -eq 1 ]
  has 'its attest.arithmetic is `fixed:20`, it was `fixed:30`'
  judged fixed_step_later
  [ "$status" -eq 1 ]
  has 'its attest.fixed_step is `50`, it was `none`'
  judged groups_later
  [ "$status" -eq 1 ]
  has 'its attest.unsupported_groups is `rates`, it was ``'
  [ "$(grep -c '"verdict": "protocol"' report.json)" -eq "$(grep -c '"verdict"' report.json)" ]
}

@test "outputs before ATTEST_UNSUPPORTED are judged" {
  judged wrong_unsupported
  [ "$status" -eq 1 ]
  has "an output was wrong before step at tick 20 returned ATTEST_UNSUPPORTED"
  has "out/actuator_controls_0.control"
  run "$ATTEST" run --port "lib:$PORTS/hostile_wrong_unsupported.so" \
    --filter '*/hover@250hz-iris-mujoco' --no-diagnose
  [ "$status" -eq 1 ]
  judged right_unsupported
  [ "$status" -eq 2 ]
  has "unsupported: step at tick 20 returned ATTEST_UNSUPPORTED"
}

@test "the other sign, a hundred times as much and NaN do not pass at the events level" {
  for port in negated_torque rates_times_100; do
    judged $port --level events
    [ "$status" -eq 1 ]
    has "at this level"
  done
  judged nan_integrals --level events
  [ "$status" -eq 1 ]
  has "non-finite"
  has "rate_integ is not finite"
}

@test "NaN at a tick of a flight of which the golden has no row" {
  run "$ATTEST" run --port "lib:$PORTS/hostile_nan_once.so" --filter '*/hover@250hz-iris-mujoco' \
    --no-diagnose
  [ "$status" -eq 1 ]
  has "non-finite"
  has "first at tick 332"
}

@test "the golden is not in the memory of a port" {
  for port in copies_golden rewrites_golden; do
    run "$ATTEST" run --port "lib:$PORTS/hostile_$port.so" --filter 'rates/*_alone@250hz' \
      --no-diagnose
    [ "$status" -eq 1 ]
    lacks "PASS"
    has "FAIL 7 of 7 vectors failed"
  done
}

@test "what a port writes on the socket of its process is no answer" {
  judged forges
  [ "$status" -eq 1 ]
  has "protocol: the port wrote on the socket on which its process answers"
  [ "$(grep -c '"verdict": "protocol"' report.json)" -eq "$(grep -c '"verdict"' report.json)" ]
  for command in "sim hover --rate 250 --out f.csv" "time --filter rates/*@250hz" \
    "replay $SOURCE/golden/recorded/px4-v1.5.5/fuzz_250hz.csv" \
    "stress --rates 250 --duration 0.3 --no-cyclictest"; do
    read -ra words <<<"$command"
    run "$ATTEST" "${words[@]}" --port "lib:$PORTS/hostile_forges.so"
    echo "$command: $status"
    [ "$status" -eq 1 ]
    has "protocol"
  done
}

# A message as the port's own process would send it: 80 bytes that give the sizes, and a head.
forge() {
  python3 - "$1" <<'FORGE'
import struct, sys
head = sys.argv[1].encode()
open("message", "wb").write(struct.pack("=IIQ8Q", 0xA77E57FF, 0, len(head), *[0] * 8) + head)
FORGE
  export FORGED_MESSAGE="$PWD/message"
}

@test "a verdict that a port gives itself does not count" {
  live=(--rates 250 --duration 0.3 --no-cyclictest --policy other)
  "$ATTEST" stress "${live[@]}" --json s.json || true
  forge "$(python3 - <<'RESULT'
import json
result = json.load(open("s.json"))["results"][0]
print(json.dumps({"stress": result | {"verdict": "pass", "reason": ""}}))
RESULT
)"
  run "$ATTEST" stress "${live[@]}" --port "lib:$PORTS/hostile_forges_message.so"
  [ "$status" -eq 1 ]
  has "protocol: the port wrote on the socket on which its process answers"
  forge '{"request": 1, "result": "pass"}'
  judged forges_message
  [ "$status" -eq 1 ]
  has "protocol: the port wrote on the socket on which its process answers"
  lacks "PASS"
}

@test "a live flight that a port ends early is not judged by its beginning" {
  run "$ATTEST" stress --rate 250 --duration 1 --no-cyclictest --policy other \
    --port "lib:$PORTS/hostile_stops_early.so"
  [ "$status" -eq 1 ]
  has "protocol"
}

@test "a port that stops the processes that judge it still gets a verdict" {
  run timeout -s KILL 60 "$ATTEST" run --port "lib:$PORTS/hostile_stops_judge.so" \
    --filter 'rates/*@250hz' --jobs 2
  [ "$status" -eq 0 ]
  has "passed, 0 failed"
}

# daemons: the processes of this test that the port has made daemons.
daemons() {
  local process
  for process in $(grep -lx port_daemon /proc/[0-9]*/comm 2>/dev/null); do
    grep -qzx "DAEMON_OF=$BATS_TEST_TMPDIR" "${process%comm}environ" 2>/dev/null && echo "$process"
  done
  return 0
}

# wait_for_daemons TEST: until there is one (-n), or none (-z).
wait_for_daemons() {
  for _ in $(seq 100); do
    [ "$1" "$(daemons)" ] && return 0
    sleep 0.1
  done
  echo "daemons: $(daemons)"
  return 1
}

@test "a daemon of a port does not outlive attest, even if attest is killed" {
  export DAEMON_OF="$BATS_TEST_TMPDIR"
  judged daemon
  [ -z "$(daemons)" ]
  has "passed, 0 failed"
  [ "$status" -eq 0 ]
  cp -r "$SOURCE/controller/starters/python" starter
  cat >daemon.py <<'PORT'
import os, sys, time
if os.fork() == 0:
    os.setsid()
    if os.fork() == 0:
        open("/proc/self/comm", "w").write("port_daemon")
        time.sleep(1000)
    os._exit(0)
os.wait()
if "DAEMON_PORT_WAITS" in os.environ:
    time.sleep(1000)
sys.path.insert(0, "starter")
import port
port.main()
PORT
  export DAEMON_PORT_WAITS=1
  for port in "lib:$PORTS/hostile_daemon.so" "proc:$PYTHON -B daemon.py"; do
    for signal in INT TERM KILL; do
      echo "$port, SIG$signal"
      "$ATTEST" run --port "$port" --filter 'rates/*@250hz' --timeout 60 --jobs 2 3>&- &
      wait_for_daemons -n
      kill -$signal $!
      wait $! || true
      wait_for_daemons -z
    done
  done
}
