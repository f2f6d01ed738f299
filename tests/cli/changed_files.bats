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

golden=golden/px4-v1.5.5/rates/turn.csv

@test "a golden that is replaced after the suite was hashed is an error" {
  two_suites
  judged=("$ATTEST" --suite suite run --port "lib:$PORTS/hostile_waits.so" --rate 250 --jobs 1
    --no-diagnose --json report.json)
  in_first_step "${judged[@]}"
  cp forged/$golden suite/$golden
  cp forged/golden/px4-v1.5.5/provenance.toml suite/golden/px4-v1.5.5/
  gone_on
  [ "$status" -eq 2 ]
  has "suite/$golden: is not the file that was blessed"
  lacks "turn@250hz "
  grep -q "none: the run is not complete" report.json
}

@test "a port that meddles with the suite does not pass" {
  two_suites
  for how in in_create in_thread by_rename; do
    rm -rf judged
    cp -r suite judged
    MEDDLE_WITH=""
    for file in attitude/roll.csv rates/turn.csv provenance.toml; do
      path="golden/px4-v1.5.5/$file"
      MEDDLE_WITH+="forged/$path=judged/$path:"
    done
    export MEDDLE_WITH
    run "$ATTEST" --suite judged run --port "lib:$PORTS/hostile_meddles_$how.so" --rate 250 \
      --no-diagnose
    echo "$how: $status"
    [ "$status" -ne 0 ]
    lacks "PASS"
  done
}

# judged_meanwhile PORT: begins to judge it on the case `roll`, and returns while it is in a step.
judged_meanwhile() {
  in_first_step "$ATTEST" --suite suite run --port "$1" --filter '*/roll@250hz' --jobs 1 \
    --no-diagnose --json report.json "${@:2}"
}

is_changed() {
  gone_on
  [ "$status" -eq 2 ]
  has "$1: the port changed during the run"
  lacks "PASS"
  grep -q "none: the run is not complete" report.json
}

@test "a library that is replaced during the run is an error, however it is replaced" {
  blessed_suite
  cp "$PORTS/hostile_waits.so" mine.so
  judged_meanwhile lib:./mine.so
  cp "$STARTER" other.so
  mv other.so mine.so
  is_changed ./mine.so

  rm go
  cp "$PORTS/hostile_waits.so" real.so
  ln -sf real.so mine.so
  judged_meanwhile lib:./mine.so
  ln -sf "$STARTER" mine.so
  is_changed ./mine.so

  rm go
  ln -sf real.so mine.so
  judged_meanwhile lib:./mine.so
  rm real.so
  is_changed ./mine.so
}

@test "a library that is replaced between two of its loads is not loaded" {
  two_suites
  cp "$PORTS/hostile_waits.so" mine.so
  in_first_step "$ATTEST" --suite suite run --port lib:./mine.so --rate 250 --jobs 1 \
    --no-diagnose --json report.json
  mv mine.so kept.so
  cp "$STARTER" mine.so
  is_changed ./mine.so
  grep -q '"pass": 1' report.json
}

@test "a library that is put back before it is loaded again, or only touched, is no error" {
  blessed_suite
  cp "$PORTS/hostile_waits.so" mine.so
  judged_meanwhile lib:./mine.so
  mv mine.so kept.so
  cp "$STARTER" mine.so
  mv kept.so mine.so
  touch mine.so
  gone_on
  [ "$status" -eq 0 ]
  has "PASS"
}

@test "a right port that replaces itself does not pass" {
  blessed_suite
  mkdir port # a port can make no file next to the suite
  for how in by_rename in_create in_thread; do
    cp "$PORTS/hostile_replaces_$how.so" port/mine.so
    MEDDLE_WITH="$STARTER=port/mine.so" \
      run "$ATTEST" --suite suite run --port lib:port/mine.so --rate 250 --no-diagnose
    echo "$how: $status"
    [ "$status" -ne 0 ]
    has "port/mine.so: the port changed during the run"
    lacks "PASS"
  done
}

@test "every command that calls a port notices that it changed" {
  flight=(--vehicle iris --plant ode)
  mkdir port # a port can make no file next to the trace that it replays
  "$ATTEST" record px4-v1.5.5/rates/p_alone --rate 250 --out right.csv
  # changes COMMAND...: is an error, and writes no file.
  changes() {
    cp "$PORTS/hostile_replaces_by_rename.so" port/mine.so
    MEDDLE_WITH="$STARTER=port/mine.so" run "$ATTEST" "$@" --port lib:port/mine.so
    echo "$*: $status"
    [ "$status" -eq 2 ]
    has "port/mine.so: the port changed during the run"
    [ ! -e page.html ]
  }
  changes replay right.csv --html page.html
  changes time --filter '*/p_alone@250hz' --repeat 1 --html page.html
  changes sim tilt_step_30 "${flight[@]}" --rate 250 --html page.html
  changes sweep-rate "${flight[@]}" --rates 250 --html page.html
  changes stress "${flight[@]}" --rates 250 --duration 0.2 --policy other --html page.html
}

# The Python starter in ./starter, started by ./slow.py, which waits as hostile_waits does.
slow_program() {
  cp -r "$SOURCE/controller/starters/python" starter
  cat >slow.py <<'PORT'
import ctypes, os, sys, time
sys.path.insert(0, "starter")
import port

law_step = port.Controller.step

def step(self, inputs):
    ctypes.CDLL(None).prctl(15, b"in_step")
    while not os.access(os.environ["MEDDLE_GO"], os.F_OK):
        time.sleep(0.01)
    return law_step(self, inputs)

port.Controller.step = step
port.main()
PORT
}

@test "a module of a program is part of its hash, and must not change during the run" {
  blessed_suite
  slow_program
  program="proc:$PYTHON -B slow.py"
  judged_meanwhile "$program" --timeout 120
  gone_on
  [ "$status" -eq 0 ]
  grep -q '"starter/law.py"' report.json
  before=$(grep '"sha256"' report.json)
  echo "# changed" >>starter/law.py
  "$ATTEST" --suite suite run --port "$program" --filter '*/roll@250hz' --json report.json
  [ "$before" != "$(grep '"sha256"' report.json)" ]

  rm go
  judged_meanwhile "$program" --timeout 120
  echo "# changed again" >>starter/law.py
  is_changed starter/law.py

  rm go
  in_first_step "$ATTEST" sim tilt_step_30 --vehicle iris --plant ode --rate 250 \
    --port "$program" --timeout 120 --html page.html
  echo "# and again" >>starter/law.py
  is_changed starter/law.py
  [ ! -e page.html ]
}

@test "the files that a program names are checked" {
  blessed_suite
  mkfifo pipe
  # names FILES: judges a program that names them.
  names() {
    printf 'import sys\nsys.path.insert(0, "%s")\nimport port\n' \
      "$SOURCE/controller/starters/python" >names.py
    printf 'port.files_of_program = lambda: %s\nport.main()\n' "$1" >>names.py
    run "$ATTEST" --suite suite run --port "proc:$PYTHON -B names.py" --rate 250
    echo "$output"
    [ "$status" -eq 2 ]
  }
  names '["none.py"]'
  has "none.py: cannot open the file: No such file"
  names '["."]'
  has "not a regular file but a directory"
  names '["pipe"]'
  has "not a regular file but a pipe"
  names '["/dev/zero"]'
  has "not a regular file but a device"
  truncate -s 1T sparse
  names '["sparse"]'
  has "sparse: is larger than 1024 MiB"
  names '"law.py"'
  has 'has `files` = "law.py"; it is a list of the paths of further files of the port'
  names '[""]'
  has '`files` has an empty name'
  names '["a" * 5000]'
  has "cannot be the path of a file"
  names '["a"] * 1001'
  has '`files` has 1001 names; at most 1000 are possible'
}
