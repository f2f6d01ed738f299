# The barrier between a port's process and attest. The ports of hostile/attacks.c pass only if their
# attack succeeds.
load common

# A suite of one group: an attack that the barrier does not stop must not harm the sources.
setup_file() {
  export SUITE="$BATS_FILE_TMPDIR"
  for part in cases golden; do
    mkdir -p "$SUITE/$part/px4-v1.5.5"
    cp -r "$SOURCE/$part/px4-v1.5.5/rates" "$SUITE/$part/px4-v1.5.5/"
  done
  cp "$SOURCE/golden/px4-v1.5.5/provenance.toml" "$SUITE/golden/px4-v1.5.5/"
  INSIDE=$(ls "$SUITE"/golden/px4-v1.5.5/rates/*.csv | head -1)
  barrier=$("$ATTEST" doctor | grep barrier || true)
  export INSIDE barrier
}

# attacked PORT [OPTIONS]: runs the port on a case, with the file VICTIM.
attacked() {
  run timeout -s KILL 120 "$ATTEST" run --suite "$SUITE" --port "lib:$PORTS/hostile_$1.so" \
    --filter "px4-v1.5.5/rates/${CASE:-*}@250hz" --no-diagnose --jobs 1 --fail-fast "${@:2}"
}

needs_landlock() {
  [[ $barrier != *"no barrier for files"* ]] || skip "this kernel has no Landlock"
}

needs_scopes() {
  [[ $barrier != *"no barrier for"* ]] || skip "this kernel has no scopes of Landlock"
}

@test "the suite can be neither read nor changed by a port" {
  needs_landlock
  export VICTIM="$INSIDE"
  for attack in reads_file writes_file removes_file renames_file reads_by_link reads_by_root \
    reads_by_program; do
    echo "$attack"
    attacked $attack
    [ "$status" -eq 1 ]
    has "fail: differs from the reference"
    [ -f "$INSIDE" ]
  done
}

@test "all other files stay as they are, so these attacks succeed elsewhere" {
  for attack in reads_file writes_file reads_by_link reads_by_root reads_by_program removes_file \
    renames_file; do
    echo "$attack"
    mkdir -p elsewhere
    echo 1 >elsewhere/file
    CASE=d_alone VICTIM="$PWD/elsewhere/file" attacked $attack
    has "PASS 1 vector passed, 0 failed"
    [ "$status" -eq 0 ]
  done
}

@test "--port-reads lets a port read a file of the suite, but not change it" {
  needs_landlock
  VICTIM="$INSIDE" attacked reads_file --port-reads "$(dirname "$INSIDE")"
  [ "$status" -eq 0 ]
  VICTIM="$INSIDE" attacked writes_file --port-reads "$INSIDE"
  [ "$status" -eq 1 ]
}

@test "a trace that is replayed is hidden from the port" {
  needs_landlock
  cp "$SOURCE/golden/recorded/px4-v1.5.5/fuzz_250hz.csv" trace.csv
  VICTIM="$PWD/trace.csv" run "$ATTEST" replay trace.csv --port "lib:$PORTS/hostile_reads_file.so"
  [ "$status" -eq 1 ]
}

@test "the memory of attest can be neither read nor traced" {
  for attack in reads_memory opens_memory traces; do
    attacked $attack
    [ "$status" -eq 1 ]
    has "fail: differs from the reference"
  done
}

@test "signals of a port do not reach attest" {
  needs_scopes
  for attack in stops kills queues; do
    attacked $attack
    [ "$status" -eq 1 ]
    has "fail: differs from the reference"
    run timeout -s KILL 60 "$ATTEST" sim hover --rate 250 --out f.csv \
      --port "lib:$PORTS/hostile_$attack.so"
    echo "sim: $status"
    [ "$status" -le 1 ]
  done
}

@test "control groups cannot be used" {
  needs_landlock
  attacked freezes
  [ "$status" -eq 1 ]
  has "fail: differs from the reference"
}

@test "disks cannot be read past their files" {
  needs_landlock
  attacked reads_disk
  [ "$status" -eq 1 ]
  has "fail: differs from the reference"
}

@test "limits cannot be raised, and shared memory counts" {
  for attack in raises_files raises_memory raises_of_parent; do
    attacked $attack
    [ "$status" -eq 1 ]
    has "fail: differs from the reference"
  done
  CASE=p_alone attacked makes_shared
  [ "$status" -eq 1 ]
  has "crash: the port's processes used more than 4 GiB of memory"
}

@test "a kernel without Landlock is named, and the memory stays hidden" {
  without=("$PYTHON" "$SOURCE/tests/cli/without_landlock.py" "$ATTEST")
  run "${without[@]}" doctor
  has "this kernel has no barrier for files of the suite, signals"
  run "${without[@]}" run --suite "$SUITE" --filter 'px4-v1.5.5/rates/*@250hz' --json r.json
  [ "$status" -eq 0 ]
  has "this kernel has no barrier for files of the suite, signals"
  grep -q '"files": false' r.json
  for attack in reads_memory opens_memory traces raises_files; do
    run "${without[@]}" run --suite "$SUITE" --port "lib:$PORTS/hostile_$attack.so" \
      --filter 'px4-v1.5.5/rates/*@250hz' --no-diagnose --fail-fast
    [ "$status" -eq 1 ]
    has "fail: differs from the reference"
  done
}
