load common

# Each command must end by itself. KILL ends one that reads without an end.
ends() {
  run timeout -s KILL 60 "$ATTEST" "$@"
  echo "$*: $status"
  [ "$status" -eq "${code:-2}" ]
}

# endless FILE: extends it with zeros to 1 TB.
endless() {
  truncate -s 1T "$1"
}

@test "a recorded answer of 1 TB is refused" {
  filter=(--filter px4-v1.5.5/attitude/roll_pitch_and_yaw@250hz)
  for format in csv mat; do
    rm -rf vectors
    "$ATTEST" vectors vectors "${filter[@]}" >/dev/null
    answer="vectors/px4-v1.5.5/attitude/roll_pitch_and_yaw/250hz.out.$format"
    endless "$answer"
    ends run --port recorded:vectors "${filter[@]}"
    has "$answer: is larger than 1024 MiB, the most that such a file may have"
  done
}

@test "a recorded answer ends at the first row too many" {
  filter=(--filter px4-v1.5.5/attitude/roll_pitch_and_yaw@250hz)
  "$ATTEST" vectors vectors "${filter[@]}" >/dev/null
  PYTHONDONTWRITEBYTECODE=1 "$PYTHON" "$SOURCE/tests/ports/recorded/board.py" \
    "$SOURCE/controller/starters/python" vectors
  answer=vectors/px4-v1.5.5/attitude/roll_pitch_and_yaw/250hz.out.csv
  ticks=$(($(wc -l <$answer) - 1))
  # The row after the last tick is reported, not the broken one behind it.
  tail -1 $answer >>$answer
  echo "no number" >>$answer
  code=1 ends run --port recorded:vectors "${filter[@]}" --no-diagnose
  has "protocol: $answer: has more rows than the $ticks ticks"
}

@test "files without an end are refused" {
  "$ATTEST" record px4-v1.5.5/rates/p_alone --rate 250 --out right.csv
  head -3 right.csv >endless.csv
  "$ATTEST" record px4-v1.5.5/rates/p_alone --rate 250 --out endless.ulg
  for file in endless.csv endless.ulg endless.json endless.toml; do endless $file; done
  ends replay endless.csv --html page.html
  has "endless.csv: is larger than 4 GiB, the most that a trace in memory may have"
  for command in "replay endless.csv" "compare endless.csv right.csv"; do
    # shellcheck disable=SC2086
    ends $command
    has "endless.csv:4: line is longer than any trace's"
  done
  ends replay endless.ulg
  has "endless.ulg: is larger than 16 GiB, the most that a log may have"
  for command in "merge endless.json" "run --rerun-failed endless.json" \
    "run --expected-failures endless.toml" "sweep endless.toml --out out" \
    "run --timing endless.json" "schedule endless.toml"; do
    # shellcheck disable=SC2086
    ends $command
    has "endless."
    has " MiB, the most that such a file may have"
  done
}

@test "a suite with a file without an end is refused" {
  make_suite
  endless suite/cases/px4-v1.5.5/attitude/roll.toml
  ends --suite suite run
  has "roll.toml: is larger than 64 MiB, the most that such a file may have"
}

@test "a table of a sweep without an end is refused" {
  cat >sweep.toml <<'SWEEP'
schema = 1
case = "px4-v1.5.5/flight/tilt_step_30"
vehicle = "iris"
plant = "ode"
rate = 250
design = "latin_hypercube"
samples = 2

[disperse.tilt]
keys = ["case.flight.start.tilt_deg"]
distribution = "uniform"
low = -5
high = 5
SWEEP
  "$ATTEST" sweep sweep.toml --out out >/dev/null
  head -1 out/samples.csv >first
  cp first out/samples.csv
  endless out/samples.csv
  ends sweep sweep.toml --out out
  has "out/samples.csv:2: is longer than any row; the file was changed"
}

@test "pipes, devices, folders and sockets are no files" {
  mkfifo pipe
  mkdir folder
  "$PYTHON" -c 'import socket; socket.socket(socket.AF_UNIX).bind("socket")'
  for file in pipe folder socket /dev/zero; do
    for command in "merge $file" "run --rerun-failed $file" "run --expected-failures $file" \
      "run --timing $file" "sweep $file --out out" "schedule $file"; do
      # shellcheck disable=SC2086
      ends $command
      [[ $output == *"not a regular file but a"* || $output == *"cannot open the file"* ]]
    done
  done
  for file in folder socket /dev/zero; do
    ends replay $file
    ends compare $file $file
  done
}

# interrupt PROCESS FILE: sends Ctrl-C while the process has the file open. The process must end.
interrupt() {
  local opened=""
  for _ in $(seq 600); do
    opened=$(find "/proc/$1/fd" -lname "*$2*" 2>/dev/null) || true
    [ "$opened" ] && break
    sleep 0.05
  done
  [ "$opened" ]
  kill -INT "$1"
  for _ in $(seq 200); do
    kill -0 "$1" 2>/dev/null || break
    sleep 0.1
  done
  kill -KILL "$1" 2>/dev/null || true
  status=0
  wait "$1" || status=$?
  echo "status $status"
  [ "$status" -eq 130 ]
}

@test "Ctrl-C ends the reading of files" {
  filter=(--filter px4-v1.5.5/attitude/roll_pitch_and_yaw@250hz)
  "$ATTEST" vectors vectors "${filter[@]}" >/dev/null
  for i in $(seq 200); do truncate -s 1G "vectors/big$i"; done
  "$ATTEST" run --port recorded:vectors "${filter[@]}" 2>errors 3>&- &
  interrupt $! vectors/big
  grep -q "attest: interrupted" errors
}
