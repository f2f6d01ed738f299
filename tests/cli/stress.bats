load common

# Real time on a machine with other work: the tests assert only results that its latency cannot
# change. The budgets are wide, so that only the port can fail.
open=(--policy other --no-cyclictest --misses-per-million 1000000 --p99-latency 1000000)

@test "a port is measured at each rate, compared with the idle machine" {
  run "$ATTEST" stress --rates 100,250 --duration 0.5 "${open[@]}" --json s.json --junit s.xml
  [ "$status" -eq 0 ] || [[ $output == *"does not step the plant"* ]]
  has "flight/hover@100hz-iris-mujoco"
  has "flight/hover@250hz-iris-mujoco"
  has "idle machine"
  has "wake-up latency"
  has "execution time"
  has "response time"
  has "sample age"
  has "timer slack 1 ns"
  xmllint --noout --schema "$SOURCE/tests/harness/report/junit.xsd" s.xml
  grep -q '"port.name" value="attest-reference"' s.xml
  python3 - <<'CHECK'
import json, os
import jsonschema
report = json.load(open("s.json"))
schema = json.load(open(os.environ["SOURCE"] + "/harness/report/stress.schema.json"))
jsonschema.Draft7Validator(schema).validate(report)
assert not report["interrupted"]
for result, rate in zip(report["results"], (100, 250)):
    assert result["deadlines"] == result["ticks"] + result["skipped_releases"] == rate // 2
    for name in ("wake_up_latency", "execution_time", "response_time"):
        spread = result[name]
        assert spread["count"] == result["ticks"] == sum(b["count"] for b in spread["buckets"])
        assert spread["min_ns"] <= spread["median_ns"] <= spread["max_ns"]
        assert "p99_ns" not in spread, "of at most 125 samples"
CHECK
}

@test "progress is shown once a second" {
  run "$ATTEST" stress --rates 100 --duration 1.5 "${open[@]}"
  has "100 Hz: idle machine"
  has "of 1.5 s,"
}

@test "load is made while it is measured" {
  run "$ATTEST" stress --rates 100 --duration 0.3 --load 1 --load-kind cache "${open[@]}"
  has "(load: 1 x cache ("
  run "$ATTEST" stress --load 1 --load-kind fire
  [ "$status" -eq 2 ]
  has 'no such kind of load: `fire`; there are cpu, cache, io'
}

@test "load needs no stress-ng, and ends" {
  mkdir none
  for kind in cpu cache io; do
    run timeout -k 1 100 env PATH="$PWD/none" "$ATTEST" stress --rates 100 --duration 0.3 --load 2 \
      --load-kind $kind "${open[@]}" --json "$PWD/s.json"
    [ "$status" -ne 124 ]
    has "(load: 2 x $kind (own processes))"
  done
  nothing_is_left
}

@test "a stress-ng that does not end is killed, with what it started" {
  ln -s "$(command -v sleep)" "forever"
  fake stress-ng <<<"trap '' TERM; while :; do '$PWD/forever' 1000; done"
  run timeout -k 1 100 env PATH="$PWD/fakes" "$ATTEST" stress --rates 100 --duration 0.3 --load 1 \
    "${open[@]}"
  [ "$status" -ne 124 ]
  has "(load: 1 x cpu (stress-ng))"
  nothing_is_left
}

@test "a stress-ng that fails is done without" {
  fake stress-ng <<<'echo "no such option"; exit 2'
  run timeout -k 1 100 env PATH="$PWD/fakes" "$ATTEST" stress --rates 100 --duration 0.3 --load 1 \
    "${open[@]}"
  has "(load: 1 x cpu (own processes))"
  lacks "no such option"
}

@test "an attest that is killed leaves no load behind" {
  ln -s "$(command -v sleep)" "forever"
  mkdir none
  fake stress-ng <<<"trap '' TERM; '$PWD/forever' 1000 & '$PWD/forever' 1000"
  for path in none fakes; do
    PATH="$PWD/$path" "$ATTEST" stress --rates 100 --duration 600 --load 2 "${open[@]}" \
      --json "$PWD/s.json" >out.txt 2>err.txt 3>&- &
    pid=$!
    for _ in $(seq 300); do
      grep -Eq "[1-9][0-9.]* of 600 s" err.txt && break
      sleep 0.2
    done
    grep -Eq "[1-9][0-9.]* of 600 s" err.txt
    kill -KILL $pid
    wait $pid || true
    nothing_is_left
    rm err.txt
  done
}

@test "a cyclictest that never ends, fails or prints garbage is done without" {
  idle=(--rates 100 --duration 0.3 --policy other --misses-per-million 1000000
    --p99-latency 1000000)
  for script in 'echo "{\"thread\": {\"0\": {\"histogram\": {\"x\": 1}}}}"' 'exit 1' \
    "trap '' TERM; while :; do /bin/sleep 1; done"; do
    fake cyclictest <<<"$script"
    run timeout -k 1 100 env PATH="$PWD/fakes" "$ATTEST" stress "${idle[@]}"
    [ "$status" -eq 0 ] || [[ $output == *"does not step the plant"* ]]
    has "cyclictest failed, or gave no figures in time"
    lacks "cyclictest, idle"
  done
  nothing_is_left
}

@test "figures of cyclictest are printed next to ours" {
  fake cyclictest <<<"echo '{\"thread\": {\"0\": {\"histogram\": {\"40\": 9}, \"max\": 41}}}'"
  run timeout -k 1 100 env PATH="$PWD/fakes" "$ATTEST" stress --rates 100 --duration 0.3 \
    --policy other --misses-per-million 1000000 --p99-latency 1000000
  has "cyclictest, idle"
}

@test "a wrong port fails, and the command to reproduce it is shown" {
  run "$ATTEST" stress --port "lib:$PORTS/port_sign_flip.so" --rates 250 --duration 0.5 \
    "${open[@]}" --junit s.xml
  [ "$status" -eq 1 ]
  has "look first at the rate law"
  grep -q "attest stress --port .*sign_flip.so --case px4-v1.5.5/flight/hover --rate 250" s.xml
}

@test "a rate that is not judged is named, and is no pass of the whole" {
  run "$ATTEST" stress --port "lib:$PORTS/port_fixed_step.so" --rates 100,250 --duration 0.3 \
    "${open[@]}" --json s.json
  [ "$status" -eq 2 ]
  has "outputs not judged: a fixed step"
  has "NONE 0 of 2 rates hold in real time (load: none); not judged: 100 Hz, 250 Hz"
  has "attest: error: not judged: 100 Hz, 250 Hz; see the reasons above"
  grep -q '"verdict": "none"' s.json
}

@test "a port that crashes or hangs in real time has a verdict" {
  run "$ATTEST" stress --port "lib:$PORTS/port_crash.so" --rates 250 --duration 0.5 "${open[@]}"
  [ "$status" -eq 1 ]
  has "crash: the port's process "
  local port_and_duration # the flight of the first would take ten minutes
  for port_and_duration in "hang 600" "hangs_in_load 0.5" "hangs_in_create 0.5" \
    "hangs_in_destroy 0.5"; do
    run timeout -k 1 100 "$ATTEST" stress --port "lib:$PORTS/port_${port_and_duration% *}.so" \
      --rates 250 --duration "${port_and_duration#* }" --timeout 0.5 "${open[@]}"
    [ "$status" -eq 1 ]
    has "timeout: "
  done
}

@test "a stall every 1000 steps is found, and its ticks named" {
  run "$ATTEST" stress --port "lib:$PORTS/port_stalls.so" --rates 2000 --duration 2.1 "${open[@]}" \
    --budget 200 --json s.json
  python3 - <<'CHECK'
import json
stress = json.load(open("s.json"))["results"][0]
slow = stress["slow_steps"]
# On a busy machine, a stall that is preempted takes less CPU time, and the machine's own slow steps
# may replace these in the list of the worst.
stalls = stress["ticks"] // 1000
assert stress["overruns"] >= 1, stress["overruns"]
if stress["overruns"] >= stalls and slow["count"] <= len(slow["worst"]):
    ticks = {step["tick"] for step in slow["worst"]}
    assert set(range(999, stress["ticks"], 1000)) <= ticks, slow
CHECK
  run "$ATTEST" stress --port "lib:$PORTS/port_stalls.so" --rates 2000 --duration 2.1 \
    --policy other --no-cyclictest --p99-latency 1000000 --budget 200
  [ "$status" -eq 1 ] || [[ $output == *"does not step the plant"* ]]
}

@test "a recorded timing is flown again, to the same bits" {
  "$ATTEST" stress --rates 250 --duration 1 "${open[@]}" --record-timing t.json || true
  run "$ATTEST" run --timing t.json
  [ "$status" -eq 0 ]
  has "PASS 1 vector passed, 0 failed"
  # On a machine that stalls, the recorded flight may miss its bounds.
  for out in one.csv two.csv; do
    run "$ATTEST" sim --timing t.json --out "$out"
    [ "$status" -le 1 ]
  done
  cmp one.csv two.csv
  run "$ATTEST" run --timing t.json --port "lib:$PORTS/port_sign_flip.so"
  [ "$status" -eq 1 ]
  has "reproduce: attest run --port"
  has "--timing t.json"
}

@test "a timing that fits nothing is refused" {
  echo '{}' >t.json
  run "$ATTEST" run --timing t.json
  [ "$status" -eq 2 ]
  has "t.json: is no timing file"
  "$ATTEST" stress --rates 250 --duration 0.2 "${open[@]}" --record-timing t.json || true
  sed -i 's/"case_sha256":"[0-9a-f]*"/"case_sha256":"0"/' t.json
  run "$ATTEST" sim --timing t.json --out f.csv
  [ "$status" -eq 2 ]
  has "the file has changed since"
  [ ! -e f.csv ]
  run "$ATTEST" run --timing t.json --group flight
  [ "$status" -eq 2 ]
  has "leave out all other selections"
  run "$ATTEST" sim hover --rate 250 --timing t.json --out f.csv
  [ "$status" -eq 2 ]
  run "$ATTEST" sim --out f.csv
  [ "$status" -eq 2 ]
  has "needs a case, or --timing"
  run "$ATTEST" stress --rates 250,500 --record-timing t.json
  [ "$status" -eq 2 ]
  has "records one rate"
}

@test "Ctrl-C ends it with what was measured" {
  "$ATTEST" stress --rates 100,250 --duration 600 "${open[@]}" --json s.json >out.txt 2>err.txt &
  pid=$!
  for _ in $(seq 100); do
    grep -Eq "[1-9][0-9.]* of 600 s" err.txt && break
    sleep 0.2
  done
  kill -INT $pid
  status=0
  wait $pid || status=$?
  [ "$status" -eq 130 ]
  grep -q "interrupted" out.txt
  python3 - <<'CHECK'
import json
report = json.load(open("s.json"))
assert report["interrupted"] and report["results"][0]["ticks"] > 0
CHECK
}

@test "the estimator triggers the unit where the case says so" {
  mkdir -p suite/cases/px4-v1.5.5/flight suite/golden
  cp -r "$SOURCE/models" suite/
  cp -r "$SOURCE/golden/recorded" suite/golden/
  printf '\n[unit]\ntrigger = "estimator"\n' |
    cat "$SOURCE/cases/px4-v1.5.5/flight/hover.toml" - >suite/cases/px4-v1.5.5/flight/hover.toml
  run "$ATTEST" --suite suite stress --rates 250 --duration 0.5 "${open[@]}" --json s.json
  has "flight/hover@250hz-iris-mujoco"
  python3 - <<'CHECK'
import json
result = json.load(open("s.json"))["results"][0]
assert result["deadlines"] == result["ticks"] + result["skipped_releases"] == 125, result
CHECK
}

@test "a flight with a battery is flown" {
  run "$ATTEST" stress --case battery_scaled --rates 250 --duration 0.5 --record-timing b.json \
    "${open[@]}"
  [ "$status" -eq 0 ] || [[ $output == *"does not step the plant"* ]]
  has "execution time"
  run "$ATTEST" sim --timing b.json --out b.csv
  [ "$status" -eq 0 ]
}

@test "what cannot be stressed is refused" {
  run "$ATTEST" stress --case attitude/roll_30
  [ "$status" -eq 2 ]
  run "$ATTEST" stress --policy best
  [ "$status" -eq 2 ]
  has 'no such policy: `best`; there are fifo and other'
  run "$ATTEST" stress --rates 0
  [ "$status" -eq 2 ]
}

@test "a stress run is a page with the idle machine and a timeline" {
  run "$ATTEST" stress --rates 250 --duration 0.5 "${open[@]}" --html s.html --json s.json
  python3 - <<'CHECK'
import json, re
page = open("s.html", encoding="utf-8").read()
groups = json.loads(re.search(r'id="plots">(.*?)</script>', page, re.DOTALL)[1])["groups"]
titles = [plot["title"] for group in groups for plot in group["plots"]]
assert titles[:2] == ["Wake-up latency", "Execution time"] and "Longest times" in titles, titles
assert [s["name"] for s in groups[0]["plots"][0]["series"]] == ["idle machine", "in flight"]
result = json.load(open("s.json"))["results"][0]
assert f'<td class="number">{result["deadlines"]}</td>' in page
assert f'<td class="number">{result["response_time"]["max_ns"] / 1000:.4g}</td>' in page
CHECK
  run "$ATTEST" stress --html same --json same
  [ "$status" -eq 2 ]
  has "is asked for twice"
}
