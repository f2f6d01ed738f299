load common

tasks() {
  cat >tasks.toml <<'TASKS'
[task.unit]
rate_hz = 250
execution_us = 76
priority = 2

[task.estimator]
rate_hz = 250
execution_us = 400
priority = 3
TASKS
}

@test "a schedule shows the delays of the loop" {
  tasks
  run "$ATTEST" schedule tasks.toml --record-timing t.json
  [ "$status" -eq 0 ]
  [[ $output =~ unit\ .*\ 76\ us\ +476\ us\ +476\ us ]]
  [[ $output =~ estimator\ .*\ 400\ us\ +400\ us\ +400\ us ]]
  [[ $output =~ start\ after\ the\ release\ +400\ us ]]
  has "scheduled"
  run "$ATTEST" run --timing t.json
  [ "$status" -eq 0 ]
  run "$ATTEST" run --timing t.json --param MC_ROLL_P=3
  [ "$status" -eq 2 ]
  has "--timing is a flight, and --param leaves flights out"
}

@test "the estimator releases the unit when it finishes" {
  tasks
  sed -i '/task.unit/,/^$/s/rate_hz = 250/trigger = "estimator"/' tasks.toml
  run "$ATTEST" schedule tasks.toml --record-timing t.json
  [ "$status" -eq 0 ]
  [[ $output =~ unit\ .*\ 76\ us\ +76\ us\ +76\ us ]]
  [[ $output =~ start\ after\ the\ release\ +0\ ns ]]
  [[ $output =~ sample\ age\ at\ the\ command\ +476\ us ]]
  python3 - <<'CHECK'
import json
ticks = json.load(open("t.json"))["ticks_ns"]
assert ticks[0] == [0, 400000, 476000] and ticks[1] == [4000000, 4400000, 4476000], ticks[:2]
CHECK
}

@test "in a flight the unit runs when a sample of the estimator arrives" {
  mkdir -p suite/cases/px4-v1.5.5/flight suite/golden
  cp -r "$SOURCE/models" suite/
  cp -r "$SOURCE/golden/recorded" suite/golden/
  printf '\n[unit]\ntrigger = "estimator"\n' >unit.toml
  cat "$SOURCE/cases/px4-v1.5.5/flight/estimator_delay.toml" unit.toml \
    >suite/cases/px4-v1.5.5/flight/estimator_delay.toml
  run "$ATTEST" --suite suite sim estimator_delay --rate 250 --out flown.csv
  [ "$status" -eq 0 ]
  python3 - <<'CHECK'
import csv
rows = list(csv.DictReader(open("flown.csv")))
times = [int(row["timestamp"]) for row in rows[:3]]
assert times == [5006000, 5010000, 5014000], times
CHECK
}

@test "a schedule that cannot be kept is refused, with the file" {
  tasks
  sed -i 's/execution_us = 400/execution_us = 4000/' tasks.toml
  run "$ATTEST" schedule tasks.toml
  [ "$status" -eq 2 ]
  has "tasks.toml: the tasks of CPU 0 need 101.9% of it"
  sed -i 's/priority = 3/priority = 2/' tasks.toml
  run "$ATTEST" schedule tasks.toml
  has '`unit` and `estimator` have the same priority 2 on CPU 0'
  run "$ATTEST" schedule none.toml
  [ "$status" -eq 2 ]
}

@test "a sweep finds where a vehicle stops holding" {
  run "$ATTEST" sweep-rate --vehicle iris --plant mujoco --rates 100,250 --csv s.csv
  [ "$status" -eq 0 ]
  [[ $output =~ iris\ +mujoco\ +[0-9]+\ Hz\ +[0-9.]+\ ms\ +[0-9.]+\ ms ]]
  python3 - <<'CHECK'
import csv
rows = list(csv.DictReader(open("s.csv")))
assert [row["rate_hz"] for row in rows] == ["100", "250"], rows
assert all(5 < float(row["lowest_rate_hz"]) < 100 for row in rows), rows
assert all(10 < float(row["largest_delay_ms"]) < 200 for row in rows), rows
CHECK
}

@test "a sweep of a port that goes wrong says so" {
  run "$ATTEST" sweep-rate --vehicle iris --plant ode --rates 250 --port "lib:$PORTS/port_crash.so"
  [ "$status" -eq 1 ]
  has "crash"
  run "$ATTEST" sweep-rate --vehicle zeppelin
  [ "$status" -eq 2 ]
  has "has no run configuration with this vehicle and plant"
}

@test "steps are timed over all vectors, and the slowest input can be replayed" {
  run "$ATTEST" time --group large_angle --rate 250 --worst w.csv --json t.json
  [ "$status" -eq 0 ]
  has "steps of"
  has "slowest steps:"
  [[ $output =~ attest\ replay\ (w.csv\ --profile\ px4-v[0-9.]+) ]]
  run "$ATTEST" replay ${BASH_REMATCH[1]} --level exact
  [ "$status" -eq 0 ]
  python3 - <<'CHECK'
import json
report = json.load(open("t.json"))
assert report["schema"] == "attest-time-1"
assert report["slowest"] in {vector["id"] for vector in report["vectors"]}
assert report["all"]["steps"] == sum(vector["steps"] for vector in report["vectors"])
assert report["all"]["min_ns"] <= report["all"]["median_ns"] <= report["all"]["max_ns"]
CHECK
}

@test "the units of the cascade are timed, with a row for each" {
  run "$ATTEST" time --profile px4-v1.16.0 --group timing --rate 250 --json t.json --html t.html
  [ "$status" -eq 0 ]
  has "  attitude unit"
  has "  rate unit"
  lacks "  controller"
  grep -q "Step times of the attitude unit by loop rate" t.html
  grep -q "Step times of the rate unit by loop rate" t.html
  grep -q "px4-v1.16.0/timing, rate unit" t.html
  python3 - <<'CHECK'
import json
report = json.load(open("t.json"))
assert set(report["modules"]) == {"attitude_unit", "rate_unit"}, report["modules"]
for module, figures in report["modules"].items():
    timed = [vector for vector in report["vectors"] if vector["module"] == module]
    assert figures["steps"] == sum(vector["steps"] for vector in timed) > 0
    assert figures["max_ns"] == max(vector["max_ns"] for vector in timed)
    assert min(vector["stack_bytes"] for vector in timed) > 0
CHECK
}

@test "the slowest input of a unit can be replayed" {
  for group in attitude rates; do
    run "$ATTEST" time --profile px4-v1.16.0 --group $group --rate 250 --no-stack --worst w.csv
    [ "$status" -eq 0 ]
    run "$ATTEST" replay w.csv --level exact # --profile: the newest that has the unit
    [ "$status" -eq 0 ]
    has "w.csv  px4-v1.16.0"
  done
}

@test "of a port with one unit, the vectors of the other one are not timed" {
  rate_only right
  run "$ATTEST" time --port lib:./right.so --profile px4-v1.16.0 --group timing --rate 250 \
    --json t.json
  [ "$status" -eq 0 ]
  has "  rate unit"
  lacks "  attitude unit"
  python3 - <<'CHECK'
import json
vectors = json.load(open("t.json"))["vectors"]
verdicts = {(vector["module"], vector["verdict"]) for vector in vectors}
assert verdicts == {("attitude_unit", "unsupported"), ("rate_unit", "pass")}, verdicts
CHECK
  run "$ATTEST" time --port lib:./right.so --profile px4-v1.16.0 --group attitude --rate 250
  [ "$status" -eq 2 ]
  has "no vector was timed"
}

@test "a budget fails on the count of steps over it" {
  run "$ATTEST" time --filter 'attitude/*@250hz' --budget 0.001
  [ "$status" -eq 1 ]
  has "steps took longer than 0.001 us"
  run "$ATTEST" time --filter 'attitude/*@250hz' --budget 0.001 --allow 1000000
  [ "$status" -eq 0 ]
  run "$ATTEST" time --filter 'attitude/*@250hz' --budget 100000
  [ "$status" -eq 0 ]
  has "0 of"
}

@test "flights are not timed" {
  run "$ATTEST" time --group flight
  [ "$status" -eq 2 ]
  has "no open-loop case of a unit or law is selected"
}

@test "the stack that a step uses is measured" {
  "$ATTEST" time --filter 'attitude/*@250hz' --json reference.json
  run "$ATTEST" time --port "lib:$PORTS/port_deep_stack.so" --filter 'attitude/*@250hz' \
    --json t.json
  [ "$status" -eq 0 ]
  [[ $output =~ stack\ of\ a\ step:\ at\ most\ [0-9]+\ bytes\ \(px4-v1.*/attitude/ ]]
  python3 - <<'CHECK'
import json
reference, deep = (json.load(open(name)) for name in ("reference.json", "t.json"))
for report in (reference, deep):
    used = [vector["stack_bytes"] for vector in report["vectors"] if vector["verdict"] == "pass"]
    assert report["all"]["stack_bytes"] == max(used) and min(used) > 0, used
assert 0 < reference["all"]["stack_bytes"] < 16384, reference["all"]
assert 65536 <= deep["all"]["stack_bytes"] < 65536 + 16384, deep["all"]
CHECK
  run "$ATTEST" time --filter 'attitude/*@250hz' --no-stack --json t.json
  lacks "stack of a step"
  [ -z "$(grep stack_bytes t.json)" ]
}

@test "instructions are counted where valgrind is" {
  command -v valgrind || skip "no valgrind"
  nm "$ATTEST" | grep -q __asan_init && skip "valgrind and sanitizers do not go together"
  # One vector, because with several it depends on chance which of them is the slowest.
  local vector='px4-v1.5.5/large_angle/exactly_inverted@250hz'
  "$ATTEST" time --filter "$vector" --instructions --json one.json
  "$ATTEST" time --filter "$vector" --instructions --json two.json
  "$ATTEST" time --filter px4-v1.16.0/attitude/roll_30@250hz --instructions --json attitude.json
  "$ATTEST" time --filter px4-v1.16.0/rates/d_alone@250hz --instructions --json rates.json
  python3 - <<'CHECK'
import json
names = ("one", "two", "attitude", "rates")
one, two, attitude, rates = (json.load(open(f"{name}.json"))["instructions"] for name in names)
assert one == two and len(one) > 10 and min(one) > 100, (one, two)
assert len(attitude) == 40 and min(attitude) > 100, attitude
assert len(rates) == 32 and min(rates) > 100, rates
CHECK
}

@test "counting instructions leaves no file behind, also when it is killed" {
  command -v valgrind || skip "no valgrind"
  nm "$ATTEST" | grep -q __asan_init && skip "valgrind and sanitizers do not go together"
  mkdir tmp
  for signal in INT KILL; do
    TMPDIR="$PWD/tmp" "$ATTEST" time --filter px4-v1.16.0/modes/long_run_5000@250hz \
      --repeat 1 --no-stack --instructions >said &
    local attest=$!
    for _ in $(seq 300); do
      pgrep -f "callgrind.*long_run_5000" >/dev/null && break
      sleep 0.1
    done
    pgrep -f "callgrind.*long_run_5000"
    sleep 2 # valgrind has started
    kill -$signal $attest
    wait $attest && false
    [ ! -s said ]
    [ -z "$(ls -A tmp)" ]
  done
}

@test "a port that crashes on one input: the others are timed, and the crash is named" {
  port="lib:$PORTS/port_crashes_on_ff.so"
  run "$ATTEST" time --port "$port" --filter 'rates/*@250hz' --json t.json
  [ "$status" -eq 1 ]
  has "rates/ff_alone@250hz crash: the port's process"
  has "slowest steps:"
  python3 - <<'CHECK'
import json
vectors = json.load(open("t.json"))["vectors"]
assert {vector["verdict"] for vector in vectors} == {"pass", "skip", "crash"}
assert all(("max_ns" in vector) == (vector["verdict"] == "pass") for vector in vectors)
CHECK
  run "$ATTEST" time --port "lib:$PORTS/port_crash.so" --filter 'rates/*@250hz'
  [ "$status" -eq 1 ]
  has "crash: the port's process"
  run "$ATTEST" time --port "lib:$PORTS/port_refuses_profile.so" --filter 'rates/*@250hz'
  [ "$status" -eq 2 ]
  has "supports no profile: its create() returned NULL for each of px4-v1.5.5, px4-v1.3.4, "
}

@test "a schedule that no port flew is no success" {
  tasks
  run "$ATTEST" schedule tasks.toml --port "lib:$PORTS/port_refuses_profile.so"
  [ "$status" -eq 2 ]
  has "supports no profile: its create() returned NULL"
}

@test "a file that is not a timing file is refused by name" {
  echo '{"attest_timing": "x"}' >late.json
  run "$ATTEST" run --timing late.json
  [ "$status" -eq 2 ]
  has "late.json: is no timing file"
}

@test "step times and the limits of the rate are pages" {
  "$ATTEST" -q time --filter 'px4-v1.5.5/tpa/*@250hz' --repeat 1 --no-stack --html t.html \
    --json t.json
  "$ATTEST" -q sweep-rate --vehicle iris --plant ode --rates 100 --csv s.csv --html s.html
  python3 - <<'CHECK'
import csv, json
page = open("t.html", encoding="utf-8").read()
times = json.load(open("t.json"))
assert f"{times['all']['steps']} steps" in page
assert times["slowest"] in page
page = open("s.html", encoding="utf-8").read()
for row in csv.DictReader(open("s.csv")):
    for figure in ("largest_delay_ms", "lowest_rate_hz"):
        assert f'<td class="number">{row[figure]}</td>' in page, figure
CHECK
  run "$ATTEST" time --html same --json same
  [ "$status" -eq 2 ]
  run "$ATTEST" sweep-rate --html same --csv same
  [ "$status" -eq 2 ]
}

@test "a port that hides the time of its steps breaks the protocol" {
  for port in got code stack thread; do
    echo "$port"
    run "$ATTEST" time --port "lib:$PORTS/hostile_clock_$port.so" --profile px4-v1.5.5 \
      --filter rates/ff_alone@250hz --repeat 2 --no-stack
    [ "$status" -eq 1 ]
    has "protocol: its clock is wrong: by it, its"
  done
  run "$ATTEST" time --port "lib:$PORTS/hostile_clock_honest.so" --profile px4-v1.5.5 \
    --filter rates/ff_alone@250hz --repeat 2 --no-stack
  [ "$status" -eq 0 ]
}
