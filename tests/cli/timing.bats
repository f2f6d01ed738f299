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

@test "a schedule says what the loop feels" {
  tasks
  run "$ATTEST" schedule tasks.toml --record-timing t.json
  [ "$status" -eq 0 ]
  [[ $output =~ unit\ .*\ 76\ us\ +476\ us\ +476\ us ]]
  [[ $output =~ estimator\ .*\ 400\ us\ +400\ us\ +400\ us ]]
  [[ $output =~ begins\ after\ its\ release\ +400\ us ]]
  has "scheduled"
  run "$ATTEST" run --timing t.json
  [ "$status" -eq 0 ]
}

@test "a schedule that cannot be kept is refused, with the file" {
  tasks
  sed -i 's/execution_us = 400/execution_us = 4000/' tasks.toml
  run "$ATTEST" schedule tasks.toml
  [ "$status" -eq 2 ]
  has "tasks.toml: the tasks of CPU 0 ask for 101.9% of it"
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
  has "is flown by no such vehicle"
}
