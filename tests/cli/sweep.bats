# attest sweep: a flight with dispersed values.

load common

# A sweep of N short flights in ./sweep.toml; more lines on stdin.
make_sweep() {
  local more
  more=$(cat)
  cat >sweep.toml <<SWEEP
schema = 1
case = "px4-v1.5.5/flight/tilt_step_30"
vehicle = "iris"
plant = "mujoco"
rate = 250
design = "latin_hypercube"
samples = $1

[disperse.mass]
keys = ["vehicle.mass_kg"]
as = "factor"
distribution = "truncated_normal"
mean = 1
deviation = 0.05
low = 0.85
high = 1.15

[disperse.inertia]
keys = ["vehicle.inertia_kg_m2[0]", "vehicle.inertia_kg_m2[1]", "vehicle.inertia_kg_m2[2]"]
as = "factor"
distribution = "log_normal"
median = 1
spread = 0.1

[disperse.tilt]
keys = ["case.flight.start.tilt_deg"]
distribution = "uniform"
low = -5
high = 5

[correlate.airframe]
dispersions = ["mass", "inertia"]
matrix = [1, 0.8, 0.8, 1]
$more
SWEEP
}

same() {
  cmp "$1/samples.csv" "$2/samples.csv" && cmp "$1/report.json" "$2/report.json" &&
    diff -r "$1" "$2"
}

@test "the requirements of a sweep are judged, and its worst flights fly again" {
  make_sweep 60 <<MORE
[require.tilts]
max = 1.2
probability = 0.9
MORE
  run "$ATTEST" sweep sweep.toml --out out --jobs 2 --keep-worst 2
  [ "$status" -eq 0 ]
  has "60 samples, design latin_hypercube; reference: 60 done"
  has "at most 1.2"
  has "met"
  has "rank correlation with"
  [ "$(wc -l <out/samples.csv)" -eq 61 ]
  # The command in the text flies the same flight: its metric is that of the table.
  local command sample
  command=$(grep -m1 'sample_[0-9]*\.html' <<<"$output" | sed 's/^ *attest //')
  sample=$(sed 's/.*sample_\([0-9]*\)\.html/\1/' <<<"$command")
  run bash -c "\"$ATTEST\" $command"
  [ "$status" -eq 0 ]
  local value
  value=$(grep "^$sample," out/samples.csv | cut -d, -f7)
  has "$(printf '%.4g' "$value")"
  [ -s "sample_$sample.html" ]
}

@test "a requirement that is not shown fails" {
  make_sweep 20 <<MORE
[require.tilts]
max = 0.2
probability = 0.9
MORE
  run "$ATTEST" sweep sweep.toml --out out
  [ "$status" -eq 1 ]
  has "not met"
  # No flight of 20 is bad, which does not show 99%.
  make_sweep 20 <<MORE
[require.tilts]
max = 1.2
probability = 0.99
MORE
  run "$ATTEST" sweep sweep.toml --out other
  [ "$status" -eq 1 ]
  has "undecided"
}

@test "a killed sweep continues to the same bytes, with any number of jobs" {
  make_sweep 100 </dev/null
  "$ATTEST" -q sweep sweep.toml --out whole --jobs 2
  for kill_after in 0.3 0.6; do
    "$ATTEST" -q sweep sweep.toml --out parts --jobs 1 &
    local attest=$!
    sleep $kill_after
    kill -9 $attest 2>/dev/null || true
    wait $attest || true
  done
  "$ATTEST" -q sweep sweep.toml --out parts --jobs 3
  same whole parts
  # An incomplete last line is never read.
  truncate -s -17 parts/samples.csv
  "$ATTEST" -q sweep sweep.toml --out parts --jobs 2
  same whole parts
}

@test "an interrupted sweep says how to go on" {
  make_sweep 3000 </dev/null
  "$ATTEST" sweep sweep.toml --out out --jobs 2 2>errors.txt &
  local attest=$!
  until [ "$(wc -l <out/samples.csv.part-* 2>/dev/null || echo 0)" -gt 3 ]; do sleep 0.05; done
  kill -INT $attest
  local status=0
  wait $attest || status=$?
  [ "$status" -eq 130 ]
  grep -q "the same command flies the others of 3000" errors.txt
  nothing_is_left
}

@test "shards, in any order, give the bytes of one machine" {
  make_sweep 31 </dev/null
  "$ATTEST" -q sweep sweep.toml --out whole
  for i in 1 2 3; do "$ATTEST" -q sweep sweep.toml --shard $i/3 --out part$i; done
  "$ATTEST" -q sweep sweep.toml --merge part3 part1 part2 --out merged
  same whole merged
  "$ATTEST" -q sweep sweep.toml --merge part2 part1 part3 --out merged # again
  same whole merged
  mkdir all
  cp -r part1 part2 part3 all
  "$ATTEST" -q sweep sweep.toml --merge all --out folder
  same whole folder
  run "$ATTEST" sweep sweep.toml --merge part3 part1 --out other
  [ "$status" -eq 2 ]
  has "missing: the folders of shards 2 of 3; run these"
  run "$ATTEST" sweep sweep.toml --merge part3 part1 part2 part1 --out other
  [ "$status" -eq 2 ]
  has "part1: is shard 1/3, and so is part1"
  "$ATTEST" -q sweep sweep.toml --shard 2/4 --out quarter
  run "$ATTEST" sweep sweep.toml --merge part1 quarter part3 --out other
  [ "$status" -eq 2 ]
  has "quarter: is shard 2/4, but part1 is one of 3"
  sed -i '$d' part2/samples.csv
  run "$ATTEST" sweep sweep.toml --merge part1 part2 part3 --out other
  [ "$status" -eq 2 ]
  has "incomplete: shards 2 of 3 (part2 has 9 of 10 samples); run these shards again"
  echo "# changed" >>sweep.toml
  run "$ATTEST" sweep sweep.toml --merge part1 part2 part3 --out other
  [ "$status" -eq 2 ]
  has "part1: is of another sweep: the hash of sweep file, case, vehicle and samples"
}

@test "a merge names all shards that it lacks" {
  make_sweep 50 </dev/null
  for i in 2 4 5 6 9; do "$ATTEST" -q sweep sweep.toml --shard $i/10 --out part$i; done
  "$ATTEST" -q sweep sweep.toml --shard 7/10 --out part7
  mv part7/samples.csv part7/samples.csv.part-lost # its machine died before the end
  sed -i '$d' part7/samples.csv.part-lost
  run "$ATTEST" sweep sweep.toml --merge part* --out merged
  [ "$status" -eq 2 ]
  has "missing: the folders of shards 1,3,8,10 of 10; incomplete: shards 7 of 10 (part7 has 4 of 5"
  [ ! -e merged/samples.csv ]
  run "$ATTEST" merge part2 part4
  [ "$status" -eq 2 ]
  has "part2: is a folder of \`attest sweep\`; \`attest sweep FILE --merge DIR... --out DIR\` joins"
}

@test "processes that fly for one folder take turns, on file systems without locks too" {
  make_sweep 100 </dev/null
  "$ATTEST" -q sweep sweep.toml --out whole
  "$ATTEST" -q sweep sweep.toml --out out --jobs 1 &
  until [ -e out/identity.json ] && ls out/samples.csv.part-* 2>/dev/null; do sleep 0.01; done
  run "$ATTEST" -q sweep sweep.toml --out out --jobs 1
  [ "$status" -eq 0 ]
  has "waiting for another \`attest sweep\` that flies for out"
  wait
  same whole out
  cc -shared -fPIC -x c -o without_locks.so - <<'C'
#include <errno.h>
int flock(int file, int operation) {
  (void)file, (void)operation;
  errno = ENOSYS;
  return -1;
}
C
  export LD_PRELOAD=$PWD/without_locks.so
  for process in 1 2; do "$ATTEST" -q sweep sweep.toml --out unlocked --jobs 1 & done
  wait
  unset LD_PRELOAD
  same whole unlocked
}

@test "a port with gains off by 3% differs in the paired test, though each flight is good" {
  make_sweep 40 <<MORE
[require.tilts]
max = 1.2
probability = 0.9
MORE
  # Five single flights hold the bounds of their case.
  local vehicle plant
  while read -r vehicle plant; do
    "$ATTEST" -q sim flight/tilt_step_30 --rate 250 --vehicle $vehicle --plant $plant \
      --out f.csv --port "lib:$PORTS/port_gains_off.so"
  done <<FLIGHTS
iris mujoco
iris ode
hexa mujoco
hummingbird mujoco
crazyflie2 ode
FLIGHTS
  run "$ATTEST" sweep sweep.toml --out off --jobs 2 --port "lib:$PORTS/port_gains_off.so"
  [ "$status" -eq 1 ]
  has "The port differs from the reference: "
  has "met"
  run "$ATTEST" sweep sweep.toml --out starter --jobs 2 --port "lib:$STARTER"
  [ "$status" -eq 0 ]
  has "No test shows a difference between the port and the reference."
}

@test "a comparison with few samples does not pass" {
  make_sweep 6 </dev/null
  run "$ATTEST" sweep sweep.toml --out out --port fault:quat-order-xyzw
  [ "$status" -eq 1 ]
  has "Too few flights to compare the port with the reference: no test can find a difference in a"
  has "metric with fewer than 7 pairs of flights."
  make_sweep 7 </dev/null
  run "$ATTEST" sweep sweep.toml --out other --port fault:quat-order-xyzw
  [ "$status" -eq 1 ]
  has "The port differs from the reference: "
}

@test "the metrics of a sample of dispersed case values are in their columns" {
  cat >sweep.toml <<SWEEP
schema = 1
case = "px4-v1.5.5/flight/tilt_step_30"
rate = 250
design = "monte_carlo"
samples = 1
[disperse.tilt]
keys = ["case.flight.start.tilt_deg"]
distribution = "uniform"
low = -1e-9
high = 1e-9
SWEEP
  "$ATTEST" -q sweep sweep.toml --out out
  run "$ATTEST" sim flight/tilt_step_30 --rate 250 --out f.csv
  local name column value
  for name in tilts levels; do
    column=$(head -1 out/samples.csv | tr , '\n' | grep -nx "reference.$name" | cut -d: -f1)
    value=$(sed -n 2p out/samples.csv | cut -d, -f"$column")
    grep -Eq "^ *$name +settling_time_s +$(printf '%.4g' "$value") " <<<"$output"
  done
}

@test "a port that crashes is a result of each sample" {
  make_sweep 3 </dev/null
  run "$ATTEST" sweep sweep.toml --out out --port "lib:$PORTS/port_crash.so"
  [ "$status" -eq 1 ]
  has "3 crash"
  run cat out/samples.csv
  has ",crash,,"
}

@test "a port that answers NaN once fails the sweep" {
  make_sweep 8 </dev/null
  run "$ATTEST" sweep sweep.toml --out out --port "lib:$PORTS/hostile_nan_once.so"
  [ "$status" -eq 1 ]
  has "8 non-finite"
}

@test "a sweep that loses every vehicle fails without a requirement, too" {
  make_sweep 2 </dev/null
  cat >>sweep.toml <<SWEEP
[disperse.gain]
keys = ["vehicle.parameters.MC_ROLLRATE_P", "vehicle.parameters.MC_PITCHRATE_P"]
distribution = "choice"
values = [-1]
[disperse.noise]
keys = ["case.flight.estimator.rate_noise_rad_s"]
distribution = "choice"
values = [0.05]
SWEEP
  run "$ATTEST" sweep sweep.toml --out out
  [ "$status" -eq 1 ]
  has "2 diverged"
  run "$ATTEST" sweep sweep.toml --out same --samples 8 --port builtin
  [ "$status" -eq 1 ]
}

@test "a vehicle that is lost is counted, not dropped" {
  cat >sweep.toml <<SWEEP
schema = 1
case = "px4-v1.5.5/flight/tilt_step_30"
rate = 250
plant = "ode"
design = "grid"
[disperse.gain]
keys = ["vehicle.parameters.MC_ROLLRATE_P", "vehicle.parameters.MC_PITCHRATE_P"]
as = "factor"
distribution = "choice"
values = [1, -3]
[disperse.noise]
keys = ["case.flight.estimator.rate_noise_rad_s"]
distribution = "choice"
values = [0.05]
[disperse.seed]
keys = ["case.flight.estimator.seed"]
distribution = "seed"
[require.tilts]
max = 1.2
probability = 0.6
SWEEP
  run "$ATTEST" sweep sweep.toml --out out --keep-worst 1
  [ "$status" -eq 1 ]
  has "2 samples, design grid; reference: 1 diverged, 1 done"
  has "1/2"
  has "0.5000"
}

@test "a sweep that cannot be flown is refused with file, line and value" {
  make_sweep 5 </dev/null
  refused() { # SED TEXT
    sed "$1" sweep.toml >wrong.toml
    run "$ATTEST" sweep wrong.toml --out out
    [ "$status" -eq 2 ]
    has "$2"
    [ ! -e out ]
  }
  refused 's/low = 0.85/low = -1/; s/deviation = 0.05/deviation = 5/' \
    'wrong.toml:9: [disperse.mass] at its lowest number, -1: vehicle.mass_kg = -1.5, the vehicle'
  refused 's/case.flight.start.tilt_deg/vehicle.mass_kg/' \
    'wrong.toml:25: [disperse.tilt]: `mass_kg` is dispersed by [disperse.mass], too'
  refused 's/0.8, 0.8/0.8, 0.7/' 'wrong.toml:33:1: needs 2 x 2 numbers'
  refused 's/start.tilt_deg/start.tild_deg/' 'unknown key `tild_deg`; did you mean `tilt_deg`?'
  refused 's/flight.tilt_step_30/flight\/nope/' 'wrong.toml'
  refused 's/^rate = 250/rate = "250:1000"/' 'is a flight of the controller, which has one rate'
  refused 's/vehicle = "iris"/vehicle = "irish"/' 'unknown vehicle `irish`; did you mean `iris`?'
  run "$ATTEST" sweep sweep.toml --out out --shard 3/2
  [ "$status" -eq 2 ]
  run "$ATTEST" sweep sweep.toml --out out --shard 1/6
  [ "$status" -eq 2 ]
  has "--shard 1/6: the sweep has only 5 samples"
}

@test "numbers of a distribution that are not finite are refused with their place" {
  make_sweep 10 </dev/null
  # Two at a time, because they may cancel out.
  for wrong in 'mean = 1/mean = nan/13' 'mean = 1/mean = inf/13' 'low = 0.85/low = -inf/15' \
    'high = 1.15/high = inf/16' 'deviation = 0.05/deviation = inf/14'; do
    for other in "" "s/mean = 1/mean = -inf/" "s/low = 0.85/low = -inf/" \
      "s/deviation = 0.05/deviation = nan/"; do
      sed "$other; s/${wrong%/*}/" sweep.toml >wrong.toml
      run "$ATTEST" sweep wrong.toml --out out
      [ "$status" -eq 2 ]
      has "wrong.toml:${wrong##*/}:1: must be"
      lacks boost
    done
  done
}

@test "the folder of another sweep is not continued" {
  make_sweep 3 </dev/null
  "$ATTEST" -q sweep sweep.toml --out out
  run "$ATTEST" sweep sweep.toml --out out --samples 4
  [ "$status" -eq 2 ]
  has "out: has the results of another sweep: the hash of sweep file"
  run "$ATTEST" sweep sweep.toml --out out --port "lib:$STARTER"
  [ "$status" -eq 2 ]
  has "out: has the results of another sweep: the port is none"
  mkdir notes && touch notes/mine
  run "$ATTEST" sweep sweep.toml --out notes
  [ "$status" -eq 2 ]
  has "notes: has other files"
  run "$ATTEST" sweep sweep.toml --out "$SOURCE/models"
  [ "$status" -eq 2 ]
  has "is in a suite"
}

@test "a full disk is an error, and the sweep continues when there is room" {
  make_sweep 30 </dev/null
  "$ATTEST" -q sweep sweep.toml --out whole
  run bash -c "ulimit -f 2; exec \"$ATTEST\" sweep sweep.toml --out out"
  [ "$status" -eq 2 ]
  has "cannot be written: File too large"
  "$ATTEST" -q sweep sweep.toml --out out
  same whole out
}

@test "the options replace vehicle and plant of the file" {
  make_sweep 2 </dev/null
  run "$ATTEST" sweep sweep.toml --out out --vehicle hexa --plant ode
  [ "$status" -eq 0 ]
  has "tilt_step_30@250hz-hexa-ode: 2 samples"
  run "$ATTEST" sweep sweep.toml --out out
  [ "$status" -eq 2 ]
  has "out: has the results of another sweep"
}

@test "the page of a sweep has its requirements, plots and worst flights, for any number of jobs" {
  make_sweep 40 <<MORE
[require.tilts]
max = 1.2
probability = 0.9
MORE
  "$ATTEST" -q sweep sweep.toml --out out --keep-worst 1 --jobs 1 --html page.html
  "$ATTEST" -q sweep sweep.toml --out out --keep-worst 1 --jobs 3 --html again.html
  cmp page.html again.html
  grep -q '</span> pass</p>' page.html
  grep -q 'attest --suite out/worst sim ' page.html
  grep -q '"title":"tilts over mass"' page.html
  run "$ATTEST" sweep sweep.toml --out part --shard 1/2 --html part.html
  [ "$status" -eq 2 ]
  has "part.html: needs all samples, so a shard cannot write it; use --merge"
  [ ! -e part.html ]
  run "$ATTEST" sweep sweep.toml --out other --html sweep.toml
  [ "$status" -eq 2 ]
  has "sweep.toml: is read by this command"
  run "$ATTEST" sweep sweep.toml --out out --html out/samples.csv
  [ "$status" -eq 2 ]
  has "out/samples.csv: is in out, a folder of results; give a file elsewhere"
}

@test "a sweep ends when its requirements are decided, at the same sample in all circumstances" {
  make_sweep 3000 <<MORE
[require.tilts]
max = 1.2
probability = 0.9
MORE
  sed -i 's/latin_hypercube/monte_carlo/; s/^samples/stop_when_decided = true\nsamples/' sweep.toml
  run "$ATTEST" sweep sweep.toml --out one --jobs 1
  [ "$status" -eq 0 ]
  # 1 / (n + 1) / 0.9^n >= 20 for the first time at n = 69
  has "69 of 3000 samples"
  has "Ended because every requirement is decided"
  has "69/69"
  [ "$(wc -l <one/samples.csv)" -eq 70 ]
  "$ATTEST" -q sweep sweep.toml --out three --jobs 3
  same one three
  # Killed in the middle, and run again when it is complete.
  sed -i '40,$d' three/samples.csv
  "$ATTEST" -q sweep sweep.toml --out three --jobs 2
  same one three
  "$ATTEST" -q sweep sweep.toml --out three
  same one three
  for part in "--shard 1/2" "--merge one"; do
    # shellcheck disable=SC2086 # two words
    run "$ATTEST" sweep sweep.toml --out other $part
    [ "$status" -eq 2 ]
    has 'sweep.toml: has `stop_when_decided`'
    [ ! -e other ]
  done
}

@test "the design saltelli has the Sobol index of each dispersion" {
  make_sweep 160 </dev/null
  sed -i 's/latin_hypercube/saltelli/; /^\[correlate/,$d' sweep.toml # 32 blocks of 5
  cat >>sweep.toml <<MORE
[disperse.seed]
keys = ["case.flight.estimator.seed"]
distribution = "seed"
[disperse.noise]
keys = ["case.flight.estimator.rate_noise_rad_s"]
distribution = "choice"
values = [0.05]
MORE
  sed -i 's/^samples = .*/samples = 192/' sweep.toml # noise is a fourth dimension
  run "$ATTEST" sweep sweep.toml --out out --html page.html
  [ "$status" -eq 0 ]
  has "Sobol indices of tilts, of 32 blocks (0.95)"
  grep -q 'Sobol indices of tilts, of 32 blocks (0.95)</caption>' page.html
  # A constant causes nothing, also with noise: a block has one seed.
  run python3 -c '
import json
metric = json.load(open("out/report.json"))["metrics"][0]["sobol"]
assert metric["indices"]["noise"]["total"] == 0, metric
assert metric["indices"]["noise"]["first"] == 0, metric
assert metric["indices"]["inertia"]["total"] > 0.3, metric
assert "seed" not in metric["indices"], metric'
  [ "$status" -eq 0 ]
  run "$ATTEST" sweep sweep.toml --out other --samples 100
  [ "$status" -eq 2 ]
  has "sweep.toml:7:1: must be a multiple of 6"
}
