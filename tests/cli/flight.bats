load common

flip="lib:$PORTS/port_sign_flip.so"

# A suite whose one case is a short flight of two vehicles, without golden, in ./suite.
flight_suite() {
  mkdir -p suite/cases/px4-v1.5.5/flight suite/golden suite/models
  cp -r "$SOURCE/golden/recorded" suite/golden/
  cp "$SOURCE"/models/iris.* "$SOURCE"/models/hexa.* suite/models/
  cat >suite/cases/px4-v1.5.5/flight/tilt.toml <<'CASE'
schema = 1
profiles = ["px4-v1.5.5"]
group = "flight"
why = "A hovering vehicle is asked to roll."
duration_s = 0.5
rates_hz = [100, 333]
rates_why = "two are enough"

[vehicle_attitude_setpoint]
q_d = { tilt_deg = 10 }

[flight.metrics.tilts]
measure = "settling_time_s"
max = 0.45
CASE
}

# broken SED_SCRIPT: edits the suite's case with it; attest must refuse the case.
broken() {
  flight_suite
  sed -i "$1" suite/cases/px4-v1.5.5/flight/tilt.toml
  run "$ATTEST" --suite suite run
  [ "$status" -eq 2 ]
}

@test "every case is flown by every vehicle on both plants" {
  run "$ATTEST" run --group flight --rate 100 --filter '*tilt_step_30' --filter '*motor_failure'
  [ "$status" -eq 0 ]
  has "PASS 40 vectors passed, 0 failed"
}

@test "vehicle and plant select flights" {
  run "$ATTEST" run --vehicle hexa --plant ode --filter 'flight/hover' --rate 100,1000
  [ "$status" -eq 0 ]
  has "PASS 9 vectors passed, 0 failed"
  run "$ATTEST" run --filter 'px4-v1.5.5/flight/hover@250hz-iris-mujoco'
  has "PASS 1 vector passed, 0 failed"
  run "$ATTEST" run --vehicle hxea --filter 'flight/*'
  [ "$status" -eq 2 ]
  has 'no cases of vehicle `hxea`; did you mean `hexa`?'
}

@test "if only flights were judged, the report says why it names no mistake" {
  run "$ATTEST" run --filter '*/flight/hover@250hz-iris-ode' --profile px4-v1.5.5 \
    --port fault:outputs-late
  [ "$status" -eq 1 ]
  has "only flights were judged, which the diagnosis does not examine: run the cases in open loop"
}

@test "a flight of another release than the port's has no result" {
  run "$ATTEST" sim hover --rate 250:1000 --port "lib:$STARTER" --html page.html
  [ "$status" -eq 2 ]
  [ ! -e page.html ]
  has "skip: the port does not support profile px4-v1.18"
  has "supports px4-v1.5.5, px4-v1.3.4, not px4-v1.18; write: attest sim px4-v1.5.5/flight/hover"
  ends "* --rate 250 --port lib:* --html page.html" # with the other options that were given
}

@test "a port with a wrong sign loses its vehicle, and the verdict says when" {
  run "$ATTEST" run --port "$flip" --filter 'px4-v1.5.5/flight/hover@250hz-iris-*' \
    --json r.json
  [ "$status" -eq 1 ]
  has "fail: the flight ended at"
  has "the body rate is"
  has "first at tick"
  has "look first at the rate law"
  python3 - <<'CHECK'
import json
results = json.load(open("r.json"))["results"]
assert [r["plant"] for r in results] == ["mujoco", "ode"], results
assert all(r["vehicle"] == "iris" and r["verdict"] == "fail" for r in results)
CHECK
}

@test "a port that is wrong later in a flight is found at the tick at which it errs" {
  run "$ATTEST" run --port "lib:$PORTS/port_wrong_after_100.so" --json report.json \
    --filter '*/yaw_178_manual@250hz-iris-ode' --filter '*/motor_failure@250hz-iris-ode'
  [ "$status" -eq 1 ]
  python3 - <<'CHECK'
import json
failed = [one for one in json.load(open("report.json"))["results"] if one["verdict"] == "fail"]
assert failed and all(one["first"]["tick"] >= 100 for one in failed), failed
assert {one["first"]["channel"] for one in failed} == {"out/actuator_controls_0.control[2]"}, failed
CHECK
}

@test "the same flight is the same bytes, in any company" {
  for plant in mujoco ode; do
    "$ATTEST" sim hover --rate 333 --plant $plant --out one.csv
    "$ATTEST" sim hover --rate 333 --plant $plant --out two.csv
    cmp one.csv two.csv
  done
  flight_suite
  cp -r suite other
  "$ATTEST" --suite suite bless --yes --reason "a test"
  "$ATTEST" --suite other bless --yes --reason "a test"
  diff -r suite/golden other/golden
  "$ATTEST" --suite suite run --jobs 1 --json one.json >/dev/null
  "$ATTEST" --suite suite run --jobs 4 --json four.json >/dev/null
  cmp one.json four.json
}

@test "a flown trace is fed again by replay, to the bit" {
  run "$ATTEST" sim acro_roll --rate 250 --vehicle crazyflie2 --out flown.csv
  [ "$status" -eq 0 ]
  has "acro_roll@250hz-crazyflie2-mujoco"
  has "settling" || has "rms_rate_error_rad_s"
  head -n 1 flown.csv | grep -q 'plant/vehicle_local_position.x,'
  run "$ATTEST" replay flown.csv --level exact
  [ "$status" -eq 0 ]
}

@test "sim shows where a port deviates, and the flight of the reference" {
  run "$ATTEST" sim hover --port fault:i-subtracted --html page.html
  [ "$status" -eq 0 ]
  has "outputs deviate from the reference's for the same inputs"
  has "look first at the rate law"
  ends "DIFFERS the metrics are within their bounds, which is exit code 0, but the outputs dev*"
  grep -q 'roll (reference)' page.html
  grep -q '"text":"first deviation: out/' page.html
  run "$ATTEST" sim hover --port fault:i-subtracted --plant all --html page.html
  [ "$(grep -o 'outputs deviate from the reference' page.html | wc -l)" -eq 2 ]
  # A port can be the second argument, as it is the first one of `run`.
  run "$ATTEST" sim hover "$STARTER" --html page.html
  [ "$status" -eq 0 ]
  lacks "deviate"
  ends "PASS the metrics are within their bounds; the outputs agree with the reference's for the *"
  must_fail grep -q 'first deviation' page.html
}

@test "the port may come before the case" {
  cp "$STARTER" mine.so
  for words in "mine.so hover" "mine.so --case hover" "hover mine.so" "--case hover mine.so"; do
    run "$ATTEST" sim $words
    [ "$status" -eq 0 ]
    ends "PASS the metrics* (lib:./mine.so)"
  done
}

@test "sim: a lost vehicle, a case that is no flight, a vehicle or plant there is not" {
  run "$ATTEST" sim hover --rate 250 --port "$flip" --out lost.csv
  [ "$status" -eq 1 ]
  [[ ${lines[-1]} == "FAIL the flight ended at "*"; the outputs deviate from "* ]]
  [ -s lost.csv ]
  run "$ATTEST" sim hover
  [ "${lines[-1]}" = "PASS the metrics are within their bounds (builtin)" ]
  run "$ATTEST" sim px4-v1.5.5/attitude/both_tilted --rate 250 --out x.csv
  [ "$status" -eq 2 ]
  has "has no [flight]"
  run "$ATTEST" sim hover --rate 250 --vehicle irsi --out x.csv
  [ "$status" -eq 2 ]
  has 'unknown vehicle `irsi`; did you mean `iris`?'
  run "$ATTEST" sim hover --rate 250 --plant gazebo --out x.csv
  [ "$status" -eq 2 ]
  run "$ATTEST" sim takeoff --rate 250 --plant ode --out x.csv
  [ "$status" -eq 2 ]
  has "no floor"
  run "$ATTEST" sim hover --rate 0 --out x.csv
  [ "$status" -eq 2 ]
  run "$ATTEST" sim 'tilt*' --rate 100 --out x.csv
  has "give the id of one"
  [ ! -e x.csv ]
}

@test "sim: a port that crashes leaves no trace behind" {
  run "$ATTEST" sim hover --rate 250 --port "lib:$PORTS/port_crash.so" --out x.csv
  [ "$status" -eq 1 ]
  has "crash"
  [ -z "$(ls)" ]
}

@test "a port that throws, hangs or answers NaN in flight gets its verdict" {
  run "$ATTEST" run --port "lib:$PORTS/port_non_finite.so" --filter 'flight/hover@100hz-iris-ode'
  [ "$status" -eq 1 ]
  has "non-finite"
  run "$ATTEST" run --port "lib:$PORTS/port_throws.so" --filter 'flight/hover@100hz-iris-ode'
  [ "$status" -eq 1 ]
  has "crash"
  run "$ATTEST" run --port "lib:$PORTS/port_hang.so" --timeout 0.3 \
    --filter 'flight/hover@100hz-iris-ode'
  [ "$status" -eq 1 ]
  has "timeout"
}

@test "a port that flushes denormals does not change the plant" {
  run "$ATTEST" run --port "lib:$PORTS/port_sets_ftz.so" --filter 'flight/hover@100hz*'
  [ "$status" -eq 0 ]
}

@test "an unknown vehicle, an impossible rate, slow physics are refused with file and line" {
  broken 's/^\[flight.metrics/[flight]\nvehicles = ["irsi"]\nvehicles_why = "x"\n&/'
  has 'tilt.toml:13:1: unknown vehicle `irsi`; did you mean `iris`?'
  broken 's/^rates_hz.*/rates_hz = [0]/'
  has 'tilt.toml:6:1: '
  broken 's/^\[flight.metrics/[flight]\nphysics_hz = 200\n&/'
  has 'tilt.toml:13:1: physics at 200 Hz is slower than the loop at 333 Hz'
}

@test "a negative mass and a broken model are refused with file and line" {
  flight_suite
  "$ATTEST" --suite suite bless --yes --reason "a test"
  sed -i 's/^mass_kg = .*/mass_kg = -1/' suite/models/iris.toml
  run "$ATTEST" --suite suite run
  [ "$status" -eq 2 ]
  has 'iris.toml:5:1: must be positive'
  cp "$SOURCE/models/iris.toml" suite/models/
  sed -i '11s/<default/<defualt/' suite/models/iris.xml
  run "$ATTEST" --suite suite run
  [ "$status" -eq 2 ]
  [[ $output =~ iris.xml:[0-9]+:\ MuJoCo: ]]
  [ ! -e MUJOCO_LOG.TXT ]
  sed 's/mass="1.5"/mass="1.6"/' "$SOURCE/models/iris.xml" >suite/models/iris.xml
  run "$ATTEST" --suite suite run
  [ "$status" -eq 2 ]
  has 'iris.xml: the mass [kg] is 1.6, in iris.toml it is 1.5'
}

@test "a golden of another vehicle is stale" {
  flight_suite
  "$ATTEST" --suite suite bless --yes --reason "a test"
  "$ATTEST" --suite suite run
  echo '# changed' >>suite/models/hexa.toml
  run "$ATTEST" --suite suite run
  [ "$status" -eq 2 ]
  has "hexa.toml has changed since it was blessed"
  has "attest bless"
  run "$ATTEST" --suite suite bless --yes --reason "the vehicle has a comment"
  [ "$status" -eq 0 ]
  has "no value changes, the vehicle's files did"
  "$ATTEST" --suite suite run
}

@test "bless refuses a flight that misses its own bounds, or is lost" {
  flight_suite
  sed -i 's/max = 0.45/max = 0.01/' suite/cases/px4-v1.5.5/flight/tilt.toml
  run "$ATTEST" --suite suite bless --yes --reason "a test"
  [ "$status" -eq 2 ]
  has 'the reference misses the metric `tilts`: settling_time_s is'
  flight_suite
  echo '[parameters]
MC_ROLLRATE_P = -0.3' >>suite/cases/px4-v1.5.5/flight/tilt.toml
  run "$ATTEST" --suite suite bless --yes --reason "a test"
  [ "$status" -eq 2 ]
  [ ! -e suite/golden/px4-v1.5.5 ]
}

@test "a golden flight that the reference does not fly is an error, and no verdict on a port" {
  flight_suite
  "$ATTEST" --suite suite bless --yes --reason "a test"
  golden=suite/golden/px4-v1.5.5/flight/tilt.csv
  cp $golden good.csv
  # A wrong roll rate at tick 3, and two wrong metrics.
  for edit in '$3 == 3 { $6 = 9 }' 'NR == 2 { $NF = 99 }' 'NR == 2 { $NF = "nan" }'; do
    awk -F, -v OFS=, "$edit"' { print }' good.csv >$golden
    accept_edit $golden
    run "$ATTEST" --suite suite run
    [ "$status" -eq 2 ]
    has "the reference of this attest does not agree with the golden"
    lacks "fail: "
  done
  # Columns without which nothing would be compared.
  column=$(head -1 good.csv | tr , '\n' | grep -n '^horizon_s$' | cut -d: -f1)
  cut -d, -f "1-$((column - 1)),$((column + 1))-" good.csv >$golden
  accept_edit $golden
  run "$ATTEST" --suite suite run
  [ "$status" -eq 2 ]
  has "has no horizon_s that is a time; bless it anew"
}

@test "the horizon is where float and double part" {
  flight_suite
  cat >>suite/cases/px4-v1.5.5/flight/tilt.toml <<'TIGHT'
[tolerance]
why = "so tight that rounding shows"
"vehicle_rates_setpoint" = { absolute = 1e-7 }
TIGHT
  "$ATTEST" --suite suite bless --yes --reason "a test"
  python3 - <<'CHECK'
import csv
rows = csv.DictReader(open("suite/golden/px4-v1.5.5/flight/tilt.csv"))
horizons = [float(row["horizon_s"]) for row in rows if row["profiles"]]
assert horizons and all(0 <= t < 0.2 for t in horizons), horizons
CHECK
  run "$ATTEST" --suite suite run
  [ "$status" -eq 0 ]
}

@test "flights have no vectors" {
  run "$ATTEST" vectors out --group flight
  [ "$status" -eq 2 ]
  has "attest sim"
  run "$ATTEST" list --vehicles
  [ "$status" -eq 0 ]
  has "heavy_quad"
}

@test "a long flight at 8 kHz is written whole" {
  "$ATTEST" sim flip_100_level --rate 8000 --out long.csv
  [ "$(wc -l <long.csv)" -eq 32001 ]
}

@test "a parameter of a vehicle that the law does not have is refused with file and line" {
  flight_suite
  sed -i 's/^MC_ROLL_P/MC_ROL_P/' suite/models/iris.toml
  run "$ATTEST" --suite suite sim tilt --rate 100 --out flown.csv
  [ "$status" -eq 2 ]
  has "models/iris.toml:"
  has 'did you mean `MC_ROLL_P`'
}

@test "a flight is written as a log of PX4" {
  "$ATTEST" sim hover --rate 250 --out hover.ulg
  [ "$(head -c 4 hover.ulg)" = ULog ]
  grep -aq "vehicle_attitude:uint64_t timestamp;float\[4\] q;" hover.ulg
  grep -aq MC_ROLL_P hover.ulg
  "$ATTEST" record px4-v1.5.5/rates/p_alone --rate 250 --out p_alone.ulg
  grep -aq "actuator_controls_0:uint64_t timestamp;float\[8\] control;" p_alone.ulg
  run "$ATTEST" record px4-v1.5.5/mixer/controls_beyond_1 --rate 250 --out 4x.ulg
  [ "$status" -eq 2 ]
  has "a ULog is for traces of the controller"
  [ ! -e 4x.ulg ]
}
