# Flight logs of PX4 v1.14 to v1.18, with attitude unit and rate unit.
load common

setup_file() {
  export FLIGHT="$BATS_FILE_TMPDIR/flight.ulg" SPARSE="$BATS_FILE_TMPDIR/sparse.ulg"
  flight "$FLIGHT"
  flight "$SPARSE" --thin vehicle_angular_velocity=20 --thin vehicle_torque_setpoint=20 \
    --thin vehicle_thrust_setpoint=20 --thin vehicle_attitude=2
}

# flight OUT [OPTION...]: of cascade_log.py.
flight() {
  "$PYTHON" "$SOURCE/tests/cli/cascade_log.py" "$@"
}

# verdicts: of the two units, in the output of the last `run`.
verdicts() {
  grep -oE "^[a-z-]+ +[^ ]+: (attitude|rate) unit" <<<"$output" | sed -E 's/ +[^ ]+: / /'
}

judged() {
  [ "$(verdicts)" = "$1 attitude unit
$2 rate unit" ] || {
    echo "expected: $1 attitude unit, $2 rate unit"
    echo "$output"
    return 1
  }
}

@test "a log that attest wrote of a unit agrees to the bit" {
  for vector in sticks/tilt_filter@250 acro/sticks@1000 timing/sample_time_not_publication@250 \
    timing/rate_sample_not_newer@1000 robustness/every_flag_is_a_byte@250 \
    modes/own_replaces_external@250 rates/i_alone@4000 robustness/rate_gyro@8000; do
    "$ATTEST" record "px4-v1.16.0/${vector%@*}" --rate "${vector#*@}" --out unit.ulg
    run "$ATTEST" replay unit.ulg --level exact
    [ "$status" -eq 0 ]
    has "PASS 1 of 1 traces and logs agree"
  done
  "$ATTEST" record px4-v1.14.4/sticks/tilt_filter --rate 250 --out unit.ulg
  run "$ATTEST" replay unit.ulg --level exact
  [ "$status" -eq 0 ]
  has "px4-v1.14.4"
  run "$ATTEST" replay unit.ulg --port fault:cascade-thrust-up
  [ "$status" -eq 1 ]
  has "first at tick"
}

@test "a log of attest has the topics and fields of PX4" {
  "$ATTEST" record px4-v1.16.0/sticks/tilt_filter --rate 250 --out unit.ulg
  grep -aq "vehicle_status:uint64_t timestamp;uint64_t armed_time;" unit.ulg
  grep -aq "uint8_t arming_state;" unit.ulg
  grep -aq "vehicle_rates_setpoint:uint64_t timestamp;float roll;" unit.ulg
  "$ATTEST" record px4-v1.16.0/rates/d_alone --rate 1000 --out unit.ulg
  grep -aq "vehicle_torque_setpoint:uint64_t timestamp;float\[3\] xyz;" unit.ulg
  grep -aq "rate_ctrl_status:uint64_t timestamp;float rollspeed_integ;" unit.ulg
}

@test "both units of a flight at full rate agree with the reference and the starter" {
  for port in builtin "lib:$(dirname "$STARTER")/../c_cascade/attest_starter_c_cascade.so"; do
    run "$ATTEST" replay "$FLIGHT" --port "$port"
    [ "$status" -eq 0 ]
    judged pass pass
    has "vehicle_rates_setpoint: 900 of 900 logged samples paired with a vehicle_attitude"
    has "vehicle_attitude_setpoint: 200 of 200 logged samples"
    has "vehicle_torque_setpoint: 4000 of 4000 logged samples paired with a vehicle_angular_vel"
    has "99% up to 0, largest 0"
    has "the profile is px4-v1.16.0, because PX4 v1.16.0 wrote the log"
    has "PASS 2 of 2 traces and units agree"
    lacks "not judged"
  done
}

@test "a pass by a log says by which bars, how little it proves, and what shows the rest" {
  local meaning="a pass by a log proves little, because a flight shows few mistakes of the law; "
  meaning+="which ones, and their share: attest faults --log $SPARSE"
  run "$ATTEST" replay "$SPARSE" --html page.html --json replay.json
  [ "$status" -eq 0 ]
  has "passes if at least 85% of the samples are within 0.0001 of the log, and at most 2% differ"
  has "passes if at least 98% of the single steps are within 0.0001 of the log"
  [ "${lines[-2]}" = "$meaning" ]
  local beyond="vehicle_torque_setpoint.xyz[2], rate_ctrl_status, vehicle_rates_setpoint"
  local why="computed from earlier steps, which the log lacks"
  ends "PASS 2 of 2 traces and units agree (builtin, numeric); not judged: *${beyond/[/\\[} ($why)"
  grep -qF "rate unit: not judged: rate_ctrl_status ($why)" page.html
  grep -qF "$meaning" page.html
  grep -q "passes if at least 98% of the single steps" page.html
  local judged  # of each unit; the page has the same numbers
  judged=$(grep -oE "[0-9]+ single steps, log" <<<"$output" | grep -oE "^[0-9]+")
  [ -n "$judged" ]
  for steps in $judged; do grep -q "\b$steps single steps\b" page.html; done
  [ "$(grep -cF "\"pass_means\": \"$meaning\"" replay.json)" -eq 2 ]
  grep -A1 '"what": "rate_ctrl_status"' replay.json | grep -qF "\"why\": \"$why\""
  run "$ATTEST" replay "$SPARSE" "$SPARSE" --html fleet.html
  [ "$(grep -cF "not judged: ${beyond} ($why)" fleet.html)" -ge 1 ]
}

@test "logs of other releases agree with the law of their release" {
  for profile in px4-v1.14.4 px4-v1.15.4 px4-v1.17 px4-v1.18; do
    flight other.ulg --profile "$profile"
    run "$ATTEST" replay other.ulg
    [ "$status" -eq 0 ]
    judged pass pass
    has "the profile is $profile"
    has "vehicle_attitude_setpoint: 200 of 200 logged samples"
    lacks "not judged"
  done
}

@test "a wrong attitude unit fails, and its rate unit passes" {
  for fault in m-not-canonical yaw-weight-ignored yaw-weight-twice yaw-ff-reversed thrust-up; do
    run "$ATTEST" replay "$FLIGHT" --port "fault:cascade-$fault"
    [ "$status" -eq 1 ]
    judged fail pass
    has "FAIL 1 of 2 traces and units agree"
  done
}

@test "a wrong rate unit fails, and its attitude unit passes" {
  for fault in i-factor-of-200 d-reversed d-of-gyro k-not-on-i integral-on-the-ground \
    saturation-freezes i-of-this-step; do
    run "$ATTEST" replay "$FLIGHT" --port "fault:cascade-$fault"
    [ "$status" -eq 1 ]
    judged pass fail
  done
}

@test "a log with a gyro sample every 20 ms judges the rate unit by single steps" {
  run "$ATTEST" replay "$SPARSE"
  [ "$status" -eq 0 ]
  judged pass pass
  has "vehicle_rates_setpoint: 450 of 900 logged samples paired"
  has "100 of them left out: the log does not have all that they depend on"
  has "198 of 4000 logged steps have all their inputs in the log"
  has "3800 left out: of a step whose gyro sample or torque the log does not have"
  has "vehicle_torque_setpoint, setpoint younger than 3.9 ms"
  has "198 100.0%  within 0.0001"
  has "PASS 2 of 2 traces and units agree"
  run "$ATTEST" replay "$SPARSE" --port fault:cascade-m-not-canonical
  [ "$status" -eq 1 ]
  judged fail pass
  for fault in d-reversed k-not-on-d rollrate-k-not-read battery-not-torque rates-setpoint-late; do
    run "$ATTEST" replay "$SPARSE" --port "fault:cascade-$fault"
    [ "$status" -eq 1 ]
    judged pass fail
  done
  # The integral of a step is taken from the log, and the yaw filter is left out.
  for fault in i-missing yaw-torque-not-filtered; do
    run "$ATTEST" replay "$SPARSE" --port "fault:cascade-$fault"
    [ "$status" -eq 0 ]
    judged pass pass
  done
}

# sparse_setpoints OUT [OPTION...]: a log that lacks samples of every topic of the law. Several
# rates setpoints in a row have the same thrust, so the thrust does not show which one was in use.
sparse_setpoints() {
  flight "$@" --thin vehicle_attitude=6 --thin vehicle_attitude_setpoint=2 \
    --thin vehicle_rates_setpoint=3 --thin vehicle_angular_velocity=20 \
    --thin vehicle_torque_setpoint=20 --thin vehicle_thrust_setpoint=20 \
    --thin rate_ctrl_status=20
}

@test "a log without most setpoints judges the steps whose setpoint was in use" {
  sparse_setpoints setpoints.ulg
  run "$ATTEST" replay setpoints.ulg
  [ "$status" -eq 0 ]
  judged pass pass
  has "vehicle_rates_setpoint, setpoint younger than 16.2 ms"
  has "vehicle_rates_setpoint, own setpoint of the step"
  has "vehicle_torque_setpoint, setpoint younger than 3.9 ms"
  has "67 of 200 logged steps have all their inputs in the log"
  has "118 left out: with a setpoint of 3.9 ms and more, with which the reference does not agree"
  for fault in m-not-canonical yaw-weight-ignored rollrate-k-not-read; do
    run "$ATTEST" replay setpoints.ulg --port "fault:cascade-$fault"
    [ "$status" -eq 1 ]
  done
  # The reference model of v1.18 remembers all setpoints.
  sparse_setpoints model.ulg --profile px4-v1.18
  run "$ATTEST" replay model.ulg
  [ "$status" -eq 0 ]
  judged skip pass
}

@test "a log that lacks some gyro samples judges the rate unit by single steps" {
  flight lost.ulg --lose vehicle_angular_velocity=20
  run "$ATTEST" replay lost.ulg
  [ "$status" -eq 0 ]
  judged pass pass
  has "3798 of 4000 logged steps have all their inputs in the log"
}

@test "without the limit of the gyro rate, a thinned log does not judge the rate unit" {
  thin=()
  for topic in angular_velocity torque_setpoint thrust_setpoint; do
    thin+=(--thin "vehicle_$topic=4")
  done
  flight thin.ulg "${thin[@]}" --thin rate_ctrl_status=4 --rate-max 0
  run "$ATTEST" replay thin.ulg
  [ "$status" -eq 0 ]
  judged pass skip
  has "the log lacks samples that the unit had, what was assumed does not hold, or another law"
  flight thin.ulg "${thin[@]}" --thin rate_ctrl_status=4
  run "$ATTEST" replay thin.ulg
  [ "$status" -eq 0 ]
  judged pass pass
}

@test "a log begun in flight judges the rate unit by single steps" {
  flight late.ulg --from 1
  run "$ATTEST" replay late.ulg
  [ "$status" -eq 0 ]
  judged pass pass
  has "2999 of 3000 logged steps have all their inputs in the log"
}

@test "without vehicle_control_mode, what is assumed must hold" {
  flight no_mode.ulg --without vehicle_control_mode
  run "$ATTEST" replay no_mode.ulg
  [ "$status" -eq 0 ]
  judged skip pass
  has "assumed, because the log does not have it: attitude, armed, rates (--assume)"
  has "what was assumed does not hold"
  run "$ATTEST" replay no_mode.ulg --assume atitude
  [ "$status" -eq 2 ]
  has 'did you mean `attitude`'
  run "$ATTEST" replay "$FLIGHT" --assume attitude
  [ "$status" -eq 2 ]
  has "has the topic vehicle_control_mode, so --assume attitude has no effect"
}

# wild DEFINITION...: the port wild.so, the C starter of the cascade, changed as wild.c says.
wild() {
  local starter="$SOURCE/controller/starters/c_cascade"
  cat >wild.c <<'WILD'
#include <math.h>
#include <string.h>
#include "port.h"

const attest_unit* right_unit_v1(void);

static int attitude_step(void* self, const attest_attitude_inputs* in,
                         attest_attitude_outputs* out) {
  static int ticks;
  const int result = attitude_unit_table.step(self, in, out);
#ifdef CRASH
  if (++ticks == 10) __builtin_trap();
#endif
#ifdef WILD_RATES
  if (++ticks % 25 == 0) out->vehicle_rates_setpoint.roll = WILD_RATES;
#endif
  (void)ticks;
  return result;
}

static int rate_step(void* self, const attest_rate_inputs* in, attest_rate_outputs* out) {
  static int ticks;
  const int result = rate_unit_table.step(self, in, out);
#ifdef WILD_TORQUE
  if (++ticks % 25 == 0) out->vehicle_torque_setpoint.xyz[1] = WILD_TORQUE;
#endif
  (void)ticks;
  return result;
}

static const void* extension(const char* id) {
  static attest_attitude_unit attitude;
  static attest_rate_unit rate;
  attitude = attitude_unit_table;
  rate = rate_unit_table;
  attitude.step = attitude_step;
  rate.step = rate_step;
#ifndef NO_ATTITUDE_UNIT
  if (strcmp(id, ATTEST_EXTENSION_ATTITUDE_UNIT) == 0) return &attitude;
#endif
#ifndef NO_RATE_UNIT
  if (strcmp(id, ATTEST_EXTENSION_RATE_UNIT) == 0) return &rate;
#endif
  return NULL;
}

const attest_unit* attest_unit_v1(void) {
  static attest_unit unit;
  unit = *right_unit_v1();
  unit.extension = extension;
  return &unit;
}
WILD
  cc -c -fPIC -O1 -Dattest_unit_v1=right_unit_v1 "-I$SOURCE/controller" "$starter/port.c" -o port.o
  cc -shared -fPIC -O1 "$@" "-I$SOURCE/controller" "-I$starter" wild.c port.o \
    "$starter"/{attitude_law,attitude_unit,rate_unit,reference_model,sticks}.c -lm -o wild.so
}

@test "wild values at every 25th tick fail" {
  wild
  run "$ATTEST" replay "$FLIGHT" --port lib:./wild.so
  [ "$status" -eq 0 ]
  for log in "$FLIGHT" "$SPARSE"; do
    for value in 100 -100; do
      wild "-DWILD_RATES=($value)"
      run "$ATTEST" replay "$log" --port lib:./wild.so
      [ "$status" -eq 1 ]
      has "samples of vehicle_rates_setpoint are wrong: the reference agrees with the log there"
    done
    wild -DWILD_RATES=NAN
    run "$ATTEST" replay "$log" --port lib:./wild.so
    [ "$status" -eq 1 ]
    has "non-finite"
    has "samples of vehicle_rates_setpoint where the log has numbers"
  done
  wild "-DWILD_TORQUE=(-1)"
  run "$ATTEST" replay "$FLIGHT" --port lib:./wild.so
  [ "$status" -eq 1 ]
  judged pass fail
  has "samples of vehicle_torque_setpoint are wrong: the reference agrees with the log there"
}

# A new process for the rate unit would have the outputs of the log in its memory.
@test "after a crash in one unit of a log, the port is not run on the other one" {
  wild -DCRASH
  run "$ATTEST" replay "$FLIGHT" --port lib:./wild.so
  [ "$status" -eq 1 ]
  judged crash crash
  has "not run: the port had crashed or broken the protocol before"
}

@test "NaN fails in a rate unit that is otherwise not judged" {
  wild -DWILD_TORQUE=NAN
  for log in "$FLIGHT" "$SPARSE"; do
    run "$ATTEST" replay "$log" --port lib:./wild.so
    [ "$status" -eq 1 ]
    judged pass non-finite
  done
}

@test "of a port with one unit, that one is judged" {
  wild -DNO_RATE_UNIT
  run "$ATTEST" replay "$FLIGHT" --port lib:./wild.so
  [ "$status" -eq 0 ]
  judged pass unsupported
  has "the port has no module rate_unit (extension attest.rate_unit.v1)"
  wild -DNO_ATTITUDE_UNIT
  run "$ATTEST" replay "$FLIGHT" --port lib:./wild.so
  [ "$status" -eq 0 ]
  judged unsupported pass
  run "$ATTEST" replay "$SPARSE" --port lib:./wild.so
  [ "$status" -eq 0 ]
  judged unsupported pass
}

@test "the law is that of the release that wrote the log, or of --profile" {
  flight old.ulg --release 1.13.2
  run "$ATTEST" replay old.ulg
  [ "$status" -eq 2 ]
  has "was written by PX4 v1.13.2, whose law attest does not have; name the law with --profile"
  has "(the nearest is px4-v1.14.4)"
  flight unknown.ulg --release 0
  run "$ATTEST" replay unknown.ulg
  [ "$status" -eq 2 ]
  has "does not say which release of PX4 wrote it (ver_sw_release)"
  run "$ATTEST" replay unknown.ulg --profile px4-v1.16.0
  [ "$status" -eq 0 ]
  judged pass pass
  run "$ATTEST" replay unknown.ulg --profile px4-v1.15.4
  [ "$status" -eq 0 ]
  judged pass skip
  has "or another law flew"
  run "$ATTEST" replay unknown.ulg --profile px4-v1.5.5
  [ "$status" -eq 2 ]
  has "is of the attitude unit, which px4-v1.5.5 does not have"
}

@test "a log without the topics of a unit names what is missing" {
  flight part.ulg --without vehicle_angular_velocity
  run "$ATTEST" replay part.ulg
  [ "$status" -eq 0 ]
  judged pass skip
  has "the log has no sample of the topic vehicle_angular_velocity"
  flight part.ulg --without vehicle_attitude_setpoint
  run "$ATTEST" replay part.ulg
  [ "$status" -eq 0 ]
  judged skip pass
  has "the log has no sample of the topic vehicle_attitude_setpoint"
  flight part.ulg --without vehicle_attitude --without vehicle_rates_setpoint
  run "$ATTEST" replay part.ulg
  [ "$status" -eq 2 ]
  has "has too little to replay"
  has "for the attitude unit: no sample of the topic vehicle_attitude"
  has "for the rate unit: no sample of the topic vehicle_rates_setpoint"
}

@test "a damaged log is replayed as far as it goes" {
  head -c 400000 "$FLIGHT" >cut.ulg
  run "$ATTEST" replay cut.ulg
  [ "$status" -eq 0 ]
  judged pass pass
  has "damaged: byte"
  run "$ATTEST" replay cut.ulg --port fault:cascade-d-reversed
  [ "$status" -eq 1 ]
}

@test "a parameter is set in the unit that has it" {
  run "$ATTEST" replay "$FLIGHT" --param MC_ROLL_P=7 # the log has 6
  [ "$status" -eq 1 ]
  judged fail pass
  run "$ATTEST" replay "$FLIGHT" --param MC_ROLLRATE_K=1.3
  [ "$status" -eq 1 ]
  judged pass fail
  run "$ATTEST" replay "$FLIGHT" --param MC_ROL_P=7
  [ "$status" -eq 2 ]
  has 'did you mean `MC_ROLL_P`'
}

@test "JSON and page have a verdict on each unit, with the reason" {
  run "$ATTEST" replay "$SPARSE" --port fault:cascade-yaw-weight-ignored --json replay.json \
    --html replay.html
  [ "$status" -eq 1 ]
  "$PYTHON" - <<'CHECK'
import json
report = json.load(open("replay.json"))
assert report["schema"] == "attest-replay-1", report
attitude, rate = report["results"]
assert [attitude["module"], attitude["verdict"]] == ["attitude_unit", "fail"], attitude
assert [rate["module"], rate["verdict"]] == ["rate_unit", "pass"], rate
steps = rate["single_steps"]
assert steps["with_given_setpoint"] == 198 and steps["oldest_setpoint_us"] == 3900, steps
assert steps["logged"] == 198 + sum(one["outputs"] for one in steps["left_out"]), steps
assert attitude["profile"] == "px4-v1.16.0" and attitude["ticks"] == 500, attitude
rates, own = attitude["topics"]
assert rates["topic"] == "vehicle_rates_setpoint" and rates["judged"] and not rates["agrees"]
assert rates["logged"] == 900 and rates["paired"] == 450 and rates["left_out"] == 100, rates
assert rates["first_unexplained"]["channel"].startswith("out/vehicle_rates_setpoint."), rates
torque = rate["topics"][0]
assert torque["condition"] == "setpoint younger than 3.9 ms" and torque["agrees"], torque
assert torque["worst"]["timestamp_us"] > 5000000 and not rate["has_every_step"], rate
CHECK
  grep -q "How far the port is from the log: attitude unit" replay.html
  grep -q "setpoint younger than 3.9 ms" replay.html
  grep -q "Outputs of the rate unit" replay.html
  "$ATTEST" record px4-v1.16.0/rates/i_alone --rate 250 --out unit.csv
  "$ATTEST" replay unit.csv --profile px4-v1.16.0 --html trace.html --json trace.json
  grep -q "out/vehicle_torque_setpoint.xyz\[0\]" trace.html
  grep -q '"kind": "trace"' trace.json
  run bash -c "'$ATTEST' replay '$FLIGHT' --json - 2>messages | '$PYTHON' -m json.tool >/dev/null"
  [ "$status" -eq 0 ]
  grep -q "PASS 2 of 2" messages
  run "$ATTEST" replay "$FLIGHT" --json "$FLIGHT"
  [ "$status" -eq 2 ]
  has "would be overwritten"
}

@test "a log is known by its first bytes, whatever its name" {
  cp "$FLIGHT" download
  run "$ATTEST" replay download
  echo "$output" | sed 's/download/flight.ulg/' >renamed
  run "$ATTEST" replay "$FLIGHT"
  [ "$(sed "s#$FLIGHT#flight.ulg#" <<<"$output")" = "$(cat renamed)" ]
  run "$ATTEST" compare download "$FLIGHT" --level exact
  [ "$status" -eq 0 ]
}

@test "many logs are judged in their order, and shown on one page, the worst first" {
  flight strange.ulg --release 1.13.2
  cp "$FLIGHT" flight.ulg
  cp "$SPARSE" sparse.ulg
  echo "no log" >text.ulg
  logs=(sparse.ulg strange.ulg flight.ulg)
  for jobs in 1 3; do
    run "$ATTEST" replay "${logs[@]}" --param MC_ROLLRATE_K=1.3 --jobs "$jobs" --html "$jobs.html" \
      --json "$jobs.json"
    [ "$status" -eq 1 ]
    has "skip        strange.ulg: attitude unit  no profile"
    has "was written by PX4 v1.13.2, whose law attest does not have; name the law with --profile"
  has "(the nearest is px4-v1.14.4)"
    has "FAIL 2 of 6 traces and units agree, 2 not compared"
    grep -oE "^[a-z]+ +[a-z]+.ulg: [a-z]+" <<<"$output" | tr -s ' ' >order.txt
    [ "$(cat order.txt)" = "pass sparse.ulg: attitude
fail sparse.ulg: rate
skip strange.ulg: attitude
skip strange.ulg: rate
pass flight.ulg: attitude
fail flight.ulg: rate" ]
  done
  cmp 1.html 3.html
  cmp 1.json 3.json
  [ "$(grep -oE 'href="#log-[0-9]' 1.html | grep -oE "[0-9]" | tr -d '\n')" = 312213 ]
  grep -q 'id="log-3"' 1.html
  # A file that is no log is an error, after the others are judged. Alone, it replaces no report.
  cp 1.json kept.json
  run "$ATTEST" replay text.ulg --json 1.json
  [ "$status" -eq 2 ]
  cmp 1.json kept.json
  run "$ATTEST" replay text.ulg sparse.ulg --json text.json
  [ "$status" -eq 2 ]
  judged pass pass
  has "text.ulg:"
  grep -q '"file": "sparse.ulg"' text.json
}
