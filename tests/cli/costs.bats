load common

# Programs that count the cost of their steps.

setup_file() {
  export PYTHONDONTWRITEBYTECODE=1
}

# counts OPTIONS: the port.
counts() { echo "proc:$PYTHON $SOURCE/tests/ports/programs/counts.py $*"; }

# timed OPTIONS_OF_PORT ARGUMENTS...
timed() {
  run "$ATTEST" time --port "$(counts "$1")" --profile px4-v1.5.5 \
    --filter 'large_angle/*@250hz' --filter 'rates/*@250hz' --json t.json "${@:2}"
}

@test "the count of the port takes the place of the host's clock, and is equal in three runs" {
  for i in 1 2 3; do
    timed "" --html t.html
    [ "$status" -eq 0 ]
    has "counted by the port in cycles at 25 MHz, in place of the host's clock"
    has "stack: 812 bytes, the high-water mark that the port reports"
    [[ $output =~ counts\ at\ 25\ MHz:\ 2\.1[0-9]%\ of\ 250\ Hz\ \(controller,\ px4-v1.5.5/ ]]
    lacks "exchange:"
    lacks "time to read the clock"
    cp t.json $i.json
  done
  cmp 1.json 2.json
  cmp 2.json 3.json
  grep -q "step cost \[cycles\]" t.html
  timed --batch --repeat 3
  has "with equal counts in 3 runs"
  python3 - <<'CHECK'
import json
step, batch = (json.load(open(name)) for name in ("1.json", "t.json"))
assert step["counter"] == {"unit": "cycles", "clock_hz": 25e6}, step["counter"]
costs = {one["id"]: one.get("max_cycles") for one in step["vectors"]}
assert costs == {one["id"]: one.get("max_cycles") for one in batch["vectors"]}
worst = step["modules"]["mc_att_control"]
assert worst["max_cycles"] == max(cost for cost in costs.values() if cost) > 2000
assert worst["max_ns"] == 40 * worst["max_cycles"]
assert step["periods"][0]["vector"] == step["slowest"]
assert abs(step["periods"][0]["share"] - worst["max_ns"] * 250e-9) < 1e-12
CHECK
}

@test "counts that differ between runs are reported, and the largest counts" {
  timed --noisy --repeat 2
  [ "$status" -eq 0 ]
  [[ $output =~ each\ the\ largest\ of\ 2\ runs\;\ [1-9][0-9]*\ of\ the\ counts\ differ ]]
}

@test "a budget in microseconds is compared at the clock" {
  timed "" --budget 88
  [ "$status" -eq 0 ]
  has "0 of"
  has "% of it"
  timed "" --budget 80
  [ "$status" -eq 1 ]
  timed "" --budget 80 --clock-hz 168e6
  [ "$status" -eq 0 ]
  has "counts at 168 MHz: 0.3"
}

@test "the inputs of the worst step can be replayed" {
  timed "" --worst w.csv
  [ "$status" -eq 0 ]
  run "$ATTEST" replay w.csv --port "$(counts)" --profile px4-v1.5.5
  [ "$status" -eq 0 ]
}

@test "a budget file catches a growth, and names the vector" {
  timed "" --write-budget-file costs.json
  [ "$status" -eq 0 ]
  timed "" --budget-file costs.json
  [ "$status" -eq 0 ]
  has "all worst costs are those of costs.json"
  timed "--slower 9" --budget-file costs.json
  [ "$status" -eq 1 ]
  [[ $output =~ 2,1[0-9]+\ -\>\ 2,[0-9]+,\ \+[0-9.]+%,\ in\ px4-v1.5.5/large_angle/ ]]
  lacks "in px4-v1.5.5/rates/"
  python3 - <<'CHECK'
import json
changes = json.load(open("t.json"))["changes"]
assert [(one["group"], one["rate_hz"], one["fails"]) for one in changes] == [
    ("large_angle", "250", True)], changes
assert changes[0]["now"] > changes[0]["before"]
CHECK
  timed "--slower 9" --budget-file costs.json --allow-growth 9.5
  [ "$status" -eq 0 ]
  has "in px4-v1.5.5/large_angle/"
  timed "--slower 9" --write-budget-file slower.json
  timed "" --budget-file slower.json
  [ "$status" -eq 0 ]
  has ", -"
  sed -i '/"group":"large_angle"/d' slower.json
  timed "" --budget-file slower.json
  [ "$status" -eq 1 ]
  has "px4-v1.5.5/large_angle at 250 Hz, mc_att_control is not in the file"
}

@test "a budget file of another port, unit, clock or profile is an error" {
  timed "" --write-budget-file costs.json
  timed "--name other" --budget-file costs.json
  [ "$status" -eq 2 ]
  has 'costs.json: is of the port `counts`, and this is `other`'
  timed "--cost '{\"unit\":\"instructions\"}'" --budget-file costs.json
  [ "$status" -eq 2 ]
  has "costs.json: has cycles at 25 MHz, and this port counts instructions"
  timed "--cost '{\"unit\":\"cycles\",\"clock_hz\":1e6}'" --budget-file costs.json
  [ "$status" -eq 2 ]
  has "has cycles at 25 MHz, and this port counts cycles at 1 MHz"
  sed 's/px4-v1.5.5/px4-v1.3.4/g' costs.json >older.json
  timed "" --budget-file older.json
  [ "$status" -eq 2 ]
  has "older.json: has no costs of px4-v1.5.5"
  echo '{}' >none.json
  timed "" --budget-file none.json
  [ "$status" -eq 2 ]
  has "none.json: is no budget file of costs"
  run "$ATTEST" time --budget-file costs.json --filter 'rates/*@250hz'
  [ "$status" -eq 2 ]
  has "--budget-file needs a port that counts the cost of its steps"
}

@test "instructions have no time" {
  local port="--cost '{\"unit\":\"instructions\"}'"
  timed "$port"
  [ "$status" -eq 0 ]
  has "counted by the port in instructions"
  lacks "share of the period"
  timed "$port" --budget 20
  [ "$status" -eq 2 ]
  has "--budget is a time, and this port counts instructions; use --budget-file"
  timed "$port" --clock-hz 1e6
  [ "$status" -eq 2 ]
  has "--clock-hz needs a port that counts cycles"
}

@test "a forged cost breaks the protocol" {
  timed "--cost '{\"unit\":\"joules\"}'"
  [ "$status" -eq 2 ]
  has '`cost` has the unit `joules`'
  timed "--cost '{\"unit\":\"cycles\",\"clock_hz\":0}'"
  [ "$status" -eq 2 ]
  has '`cost` has `clock_hz` = 0; it is above 0'
  for wrong in "no_cost:lacks \`cost\`" "negative_cost:has \`cost\` = -1" \
    "large_cost:has \`cost\` = 4294967296"; do
    run "$ATTEST" time --port "proc:$PYTHON $SOURCE/tests/ports/programs/in_text.py ${wrong%%:*}" \
      --filter px4-v1.5.5/rates/p_alone@250hz
    [ "$status" -eq 1 ]
    has "protocol: at tick 19: the answer to the request \`step\` ${wrong#*:}"
  done
}

@test "a schedule takes the slowest steps of a report as execution times" {
  timed ""
  printf '[task.unit]\nrate_hz = 250\npriority = 2\n' >tasks.toml
  run "$ATTEST" schedule tasks.toml --times t.json
  [ "$status" -eq 0 ]
  [[ $output =~ unit\ .*\ 8[0-9.]+\ us ]]
  run "$ATTEST" schedule tasks.toml
  [ "$status" -eq 2 ]
  has "execution_us"
  timed "--cost '{\"unit\":\"instructions\"}'"
  run "$ATTEST" schedule tasks.toml --times t.json
  [ "$status" -eq 2 ]
  has "t.json: has no times: its port counts instructions"
  run "$ATTEST" schedule tasks.toml --times tasks.toml
  [ "$status" -eq 2 ]
}

@test "in real time the counts are the execution times" {
  run "$ATTEST" stress --port "$(counts)" --rates 50 --duration 0.5 --no-cyclictest --json s.json \
    --budget 70
  has "the port counts its execution times, in cycles at 25 MHz"
  has "overruns of the execution time of 70 us"
  python3 - <<'CHECK'
import json
execution = json.load(open("s.json"))["results"][0]["execution_time"]
assert 80_000 <= execution["min_ns"] <= execution["max_ns"] <= 88_000, execution
CHECK
}
