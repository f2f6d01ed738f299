# attest sweep --plan: the shards of a sweep on many machines. cli/slurm runs a plan through Slurm.

load common

# The names have what a shell treats specially.
setup() {
  cd "$BATS_TEST_TMPDIR"
  unset NO_COLOR ATTEST_SUITE
  mkdir "the team's folder"
  cd "the team's folder"
  sweep='my "$weep" ${{ 1 }}.toml'
  cat >"$sweep" <<'SWEEP'
schema = 1
case = "px4-v1.5.5/flight/tilt_step_30"
vehicle = "iris"
plant = "mujoco"
rate = 250
design = "latin_hypercube"
samples = 20

[disperse.mass]
keys = ["vehicle.mass_kg"]
as = "factor"
distribution = "uniform"
low = 0.9
high = 1.1

[require.tilts]
max = 1.2
probability = 0.7
SWEEP
}

shellchecked() {
  command -v shellcheck >/dev/null || return 0
  shellcheck --exclude=SC2016 "$@" # '$' in single quotes is a name here
}

@test "a plan for GNU parallel gives the bytes of one machine" {
  command -v parallel >/dev/null || skip "no GNU parallel"
  "$ATTEST" -q sweep "$sweep" --out one --keep-worst 1
  run "$ATTEST" sweep "$sweep" --plan parallel --shards 3 --out "the plan" --keep-worst 1 --jobs 2
  [ "$status" -eq 0 ]
  has "20 samples in 3 shards: 'the plan'/run flies them with GNU parallel, then merges them to"
  shellchecked "the plan"/{shard,merge,run}
  [ "$(wc -l <"the plan/jobs.txt")" -eq 3 ]
  cd /
  run "$OLDPWD/the plan/run" --jobs 2
  [ "$status" -eq 0 ]
  has "20/20"
  cd "$OLDPWD"
  diff -r one "the plan/results"
  rm "the plan/shards/2/samples.csv"
  touch before
  "the plan/run" # again: flies what is missing
  diff -r one "the plan/results"
  [ "the plan/shards/2/samples.csv" -nt before ]
  [ before -nt "the plan/shards/1/samples.csv" ]
}

@test "a shard of a plan is refused on a machine with another sweep, port or attest" {
  "$ATTEST" -q sweep "$sweep" --plan slurm --shards 2 --out plan --port "lib:$STARTER"
  shellchecked plan/{shard,merge,submit,shards.sbatch,merge.sbatch}
  [ "$(ls plan/shards)" = $'1\n2' ]
  # Another attest, at another place.
  fake attest <<'FAKE'
echo "fake attest: $*"
FAKE
  ATTEST=$PWD/fakes/attest run plan/shard 2
  has "fake attest: sweep $sweep --port lib:$STARTER --jobs 1 --shard 2/2 --out $PWD/plan/shards/2"
  echo "# changed" >>"$sweep"
  unset ATTEST
  run plan/shard 1
  [ "$status" -eq 2 ]
  has "plan/shards/1: has the results of another sweep: the hash of sweep file, case, vehicle"
  run plan/merge
  [ "$status" -eq 2 ]
  has "is of another sweep"
}

@test "the options of a plan are those of its shards and its merge" {
  local options=(--samples 12 --vehicle hexa --plant ode --timeout 40 --port "lib:$STARTER")
  "$ATTEST" --suite "$SOURCE" -q sweep "$sweep" "${options[@]}" --out one
  "$ATTEST" --suite "$SOURCE" -q sweep "$sweep" "${options[@]}" --plan slurm --shards 2 --out plan
  for shard in 1 2; do plan/shard $shard; done
  run plan/merge
  [ "$status" -eq 0 ]
  diff -r one plan/results
  grep -q -- "--timeout 40 --jobs 1" plan/shard
}

@test "the jobs of GitHub and GitLab give the bytes of one machine" {
  "$PYTHON" -c "import yaml" 2>/dev/null || skip "no python3-yaml"
  "$ATTEST" -q sweep "$sweep" --out one
  for kind in github gitlab; do
    mkdir repository
    cp "$sweep" repository
    cd repository
    "$ATTEST" -q sweep "$sweep" --plan $kind --shards 3 --out "../$kind"
    PATH=$(dirname "$ATTEST"):$PATH "$PYTHON" "$SOURCE/tests/cli/run_workflow.py" ../$kind/sweep.yml
    cmp "../$kind/install-attest" "$SOURCE/ci/examples/install-attest"
    cd ..
    diff -r one repository/results
    rm -r repository
  done
  # A port is built first.
  cp "$STARTER" port.so
  "$ATTEST" -q sweep "$sweep" --plan github --shards 3 --out with_port --port lib:./port.so
  grep -A3 "name: Build the port" with_port/sweep.yml | grep -q "./check --help"
}

@test "a plan that cannot work is refused" {
  refused() { # TEXT ARGUMENT...
    local text=$1
    shift
    run "$ATTEST" sweep "$sweep" --out plan "$@"
    [ "$status" -eq 2 ]
    has "$text"
    [ ! -e plan ]
  }
  refused "--plan slrum: no such plan; did you mean \`slurm\`?; there are slurm, parallel, github" \
    --plan slrum --shards 2
  refused "--shards 21: the sweep has only 20 samples" --plan slurm --shards 21
  refused "--shards 257: github takes at most 256" --plan github --shards 257 --samples 1000
  refused "--shards" --plan slurm
  refused "--plan" --shards 2
  refused "--plan" --plan slurm --shards 2 --shard 1/2
  local name=$sweep
  sweep="$PWD/$name"
  refused "is a path that a machine of CI does not have" --plan github --shards 2
  sweep="../the team's folder/$name"
  refused "is a path that a machine of CI does not have" --plan gitlab --shards 2
  sweep=$name
  mkdir -p used/mine
  run "$ATTEST" sweep "$sweep" --plan slurm --shards 2 --out used
  [ "$status" -eq 2 ]
  has "used: exists; name a new folder"
  local lines=$'two\nlines.toml'
  cp "$sweep" "$lines"
  run "$ATTEST" sweep "$lines" --plan slurm --shards 2 --out plan
  [ "$status" -eq 2 ]
  has "has a control character"
  [ "$(ls -d plan* used* | wc -l)" -eq 1 ]
}
