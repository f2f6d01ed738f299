load common

@test "the reference agrees to the bit with what the firmware recorded" {
  run "$ATTEST" replay --level exact "$SOURCE"/golden/recorded/*/*.csv
  [ "$status" -eq 0 ]
  has "81 of 81 traces conform"
}

@test "the profile comes from the provenance next to the trace, or from the option" {
  trace="$SOURCE"/golden/recorded/px4-v1.3.4/fuzz_250hz.csv
  run "$ATTEST" replay "$trace"
  has "px4-v1.3.4"
  run "$ATTEST" replay "$trace" --profile px4-v1.5.5
  [ "$status" -eq 1 ]
  has "first at tick"
}

@test "a wrong port differs from the firmware, and the first difference is named" {
  run "$ATTEST" replay --port "lib:$PORTS/port_sign_flip.so" \
    "$SOURCE"/golden/recorded/px4-v1.5.5/tracking_100hz.csv
  [ "$status" -eq 1 ]
  has "out/actuator_controls_0.control[1]"
  has "FAIL 0 of 1"
}

@test "a long trace is not in memory as a whole" {
  ! nm "$ATTEST" | grep -q __asan_init || skip "sanitizers reserve terabytes"
  local mixers="$SOURCE/golden/recorded/mixer-v1.5.5"
  cp "$mixers/provenance.toml" .
  { head -1 "$mixers/4x.csv"; yes "$(sed -n 2p "$mixers/4x.csv")" | head -300000; } >4x.csv
  run bash -c 'ulimit -v 300000; exec "$0" "$@"' "$ATTEST" replay 4x.csv
  [ "$status" -eq 0 ]
  has "300000 ticks"
}

@test "a mistake in the last row is reported, also if the port failed before" {
  local trace="$SOURCE/golden/recorded/px4-v1.5.5/tracking_100hz.csv"
  cp "$(dirname "$trace")/provenance.toml" .
  { cat "$trace"; echo 1; } >long.csv
  run "$ATTEST" replay --port "lib:$PORTS/port_crash.so" long.csv
  [ "$status" -eq 2 ]
  has "long.csv:$(wc -l <long.csv):"
}

@test "a parameter can be overridden" {
  trace="$SOURCE"/golden/recorded/px4-v1.5.5/tracking_100hz.csv
  run "$ATTEST" replay "$trace" --param MC_ROLL_P=6.5
  [ "$status" -eq 0 ]
  run "$ATTEST" replay "$trace" --param MC_ROLL_P=6.6
  [ "$status" -eq 1 ]
  run "$ATTEST" replay "$trace" --param MC_ROL_P=6.5
  [ "$status" -eq 2 ]
  has 'did you mean `MC_ROLL_P`'
  run "$ATTEST" replay "$trace" --param MC_ROLL_P
  [ "$status" -eq 2 ]
  has "NAME=VALUE"
  for command in "replay $trace" "vectors inputs"; do
    run "$ATTEST" $command --param MC_ROLL_P 7
    [ "$status" -eq 2 ]
    [ "${#lines[@]}" -eq 1 ]
    has "--param: MC_ROLL_P: write NAME=VALUE with a finite number, such as MC_ROLL_P=6.5"
  done
  run "$ATTEST" replay "$SOURCE"/golden/recorded/px4-v1.18/opposite_250hz.attitude.csv \
    --param MPC_HOLD_DZ=0.2
  [ "$status" -eq 2 ]
  has 'it is `MAN_DEADZONE` since px4-v1.17'
}

@test "a battery trace without a number of cells is of 3, and says so" {
  trace="$SOURCE"/golden/recorded/battery-v1.5.5/discharge.csv
  run "$ATTEST" replay --level exact "$trace"
  [ "$status" -eq 0 ]
  has "no column in/parameter.BAT_N_CELLS: 3 cells are assumed"
  run "$ATTEST" replay --level exact "$trace" --param BAT_N_CELLS=4
  [ "$status" -eq 1 ]
}

@test "a trace says its release, and another file is judged by the newest that has its parameters" {
  "$ATTEST" record v1.18/reference_model/events_change_no_state builtin --out new.csv
  "$ATTEST" record v1.16/rates/i_alone builtin --out released.csv
  "$ATTEST" record v1.14/rates/i_alone builtin --out old.csv
  for profile in px4-v1.18:new px4-v1.16.0:released px4-v1.14.4:old; do
    file=${profile#*:}.csv
    head -1 "$file" | grep -q ",profile/${profile%:*}$"
    run "$ATTEST" replay "$file"
    [ "$status" -eq 0 ]
    has "$file  ${profile%:*}  "
    lacks "judged as"
    lacks "columns ignored"
    sed -i -E '1s#,profile/[^,]+$##; 2,$s/,1$//' "$file"
  done
  sed '1s#$#,profile/px4-v1.18#; 2,$s#$#,1#' released.csv >said.csv
  sed '1s#px4-v1.18$#px4-v1.19#' said.csv >unknown.csv
  run "$ATTEST" replay unknown.csv
  [ "$status" -eq 2 ]
  has 'unknown.csv:1: column `profile/px4-v1.19`: no such profile; did you mean `px4-v1.18`?'
  run "$ATTEST" replay unknown.csv --profile v1.16
  [ "$status" -eq 0 ]
  sed '1s#$#,profile/px4-v1.16.0#; 2,$s#$#,1#' said.csv >both.csv
  run "$ATTEST" replay both.csv
  [ "$status" -eq 2 ]
  has "another column says px4-v1.18; keep the right one"
  run "$ATTEST" replay new.csv
  [ "$status" -eq 0 ]
  has "new.csv: judged as px4-v1.18, because neither a column such as profile/px4-v1.18 nor"
  run "$ATTEST" replay released.csv
  [ "$status" -eq 0 ]
  has "released.csv: judged as px4-v1.16.0, because"
  run "$ATTEST" replay released.csv --profile v1.18
  [ "$status" -eq 0 ]
  lacks "judged as"
}

@test "parameters that the profile does not have are not set" {
  trace="$SOURCE"/golden/recorded/px4-v1.3.4/fuzz_250hz.csv
  head -1 "$trace" | grep -q in/parameter.MC_TPA_BREAK
  run "$ATTEST" replay --level exact "$trace"
  [ "$status" -eq 0 ]
  has "not set, because px4-v1.3.4 does not have them: MC_BAT_SCALE_EN, MC_TPA_BREAK, MC_TPA_SLOPE"
  run "$ATTEST" replay "$trace" --param MC_TPA_BREAK=0.5
  [ "$status" -eq 2 ]
}

@test "a golden is no trace, and the error says what to do" {
  run "$ATTEST" replay "$SOURCE"/golden/px4-v1.5.5/attitude/yaw_error.csv
  [ "$status" -eq 2 ]
  has "yaw_error.csv:1:1: is a golden, which has no inputs, and no trace; \`attest vectors DIR\`"
  run "$ATTEST" plot "$SOURCE"/golden/px4-v1.5.5/attitude/yaw_error.csv --list
  [ "$status" -eq 2 ]
  has "yaw_error.csv:1:1: is a golden"
}

@test "a mixer trace is replayed on the mixer that its provenance names" {
  run "$ATTEST" replay --level exact "$SOURCE"/golden/recorded/mixer-v1.5.5/4x_scaled_idle.csv
  [ "$status" -eq 0 ]
  has "1100 ticks, exact"
  run "$ATTEST" replay "$SOURCE"/golden/recorded/mixer-v1.5.5/4x.csv \
    --mixer "R: 4+ 10000 10000 10000 0"
  [ "$status" -eq 1 ]
  has "out/actuator_outputs.output[1]"
  has "tick 0"
}

@test "a mixer trace is given to the port's mixer, if it has one" {
  trace="$SOURCE/golden/recorded/mixer-v1.5.5/6x.csv"
  run "$ATTEST" replay --level exact "$trace" --port "lib:$PORTS/port_with_actuation.so"
  [ "$status" -eq 0 ]
  run "$ATTEST" replay "$trace" --port fault:mixer-no-boost
  [ "$status" -eq 1 ]
  has "out/actuator_outputs"
  run "$ATTEST" replay "$trace" --port "lib:$PORTS/port_prints.so"
  [ "$status" -eq 2 ]
  has "no trace was compared"
  has "NONE 0 of 1 traces conform, 1 not compared"
  has "unsupported"
  has "the port has no module mixer (extension attest.mixer.v1)"
}

@test "a malformed trace is shown with file, line and column" {
  cp "$SOURCE"/golden/recorded/px4-v1.5.5/tracking_100hz.csv broken.csv
  sed -i '7s/,1,/,one,/' broken.csv
  run "$ATTEST" replay broken.csv
  [ "$status" -eq 2 ]
  has "broken.csv:7:"
  has '`one`'
}

@test "a port may stand among the traces, and then it is judged" {
  trace=$SOURCE/golden/recorded/px4-v1.5.5/fuzz_250hz.csv
  cp "$STARTER" mine.so
  for port in mine.so "lib:./mine.so"; do
    run "$ATTEST" replay "$trace" "$port"
    [ "$status" -eq 0 ]
    has "PASS 1 of 1 traces conform (lib:./mine.so, numeric)"
  done
  run "$ATTEST" replay "$trace" mine.so lib:./mine.so
  [ "$status" -eq 2 ]
  has "is a port, not a trace or log; give one port, and a file"
  run "$ATTEST" replay mine.so
  [ "$status" -eq 2 ]
  has "mine.so is a port, not a trace or log"
  lacks PASS
  printf '#!/bin/sh\nexit 3\n' >port.sh
  cp "$trace" executable.csv
  chmod +x port.sh executable.csv
  run "$ATTEST" replay executable.csv port.sh
  [ "$status" -eq 2 ]
  has "proc:./port.sh: it exited with status 3"
}

@test "a missing trace is an error" {
  run "$ATTEST" replay nowhere.csv
  [ "$status" -eq 2 ]
  has "nowhere.csv"
}

@test "outputs and parameters of another module are refused, with file and reason" {
  trace="$SOURCE/golden/recorded/px4-v1.5.5/tracking_100hz.csv"
  python3 - "$trace" <<'PYTHON'
import csv, pathlib, shutil, sys
trace = pathlib.Path(sys.argv[1])
shutil.copy(trace.parent / "provenance.toml", "provenance.toml")
rows = list(csv.reader(trace.open()))
added = {"part": "out/actuator_outputs.output[0]", "name": "in/parameter.MC_ROL_P"}
for name, column in added.items():
    csv.writer(open(f"{name}.csv", "w")).writerows(
        row + [column if i == 0 else "0.25"] for i, row in enumerate(rows))
PYTHON
  run "$ATTEST" replay part.csv
  [ "$status" -eq 2 ]
  has "\`out/actuator_outputs.output[0]\` is of another module than mc_att_control"
  run "$ATTEST" replay name.csv
  [ "$status" -eq 2 ]
  has 'did you mean `MC_ROLL_P`'
}

@test "a provenance that cannot be read is not passed over" {
  cp "$SOURCE"/golden/recorded/mixer-v1.5.5/{4x.csv,provenance.toml} .
  echo typo >>provenance.toml
  run "$ATTEST" replay 4x.csv
  [ "$status" -eq 2 ]
  has "provenance.toml:"
}

@test "a trace is read from a pipe" {
  trace="$SOURCE"/golden/recorded/px4-v1.5.5/fuzz_250hz.csv
  run bash -c "cat '$trace' | '$ATTEST' replay --level exact /dev/stdin"
  [ "$status" -eq 0 ]
  has "/dev/stdin  px4-v1.5.5  330 ticks"
  run bash -c "head -c 20000 '$trace' | '$ATTEST' replay /dev/stdin"
  [ "$status" -eq 2 ]
  has "/dev/stdin:"
  lacks "/proc/"
}

# flight_log OUT: a simulated flight as another logger would have it, with every second
# control_state and control missing.
flight_log() {
  "$ATTEST" sim gust --rate 250 --out "$BATS_TEST_TMPDIR/whole.ulg" >"$BATS_TEST_TMPDIR/sim"
  "$PYTHON" "$SOURCE/tests/cli/thin_log.py" "$BATS_TEST_TMPDIR/whole.ulg" "$1"
}

@test "a log of attest is judged tick by tick, as a trace" {
  log="$BATS_TEST_TMPDIR/whole.ulg"
  "$ATTEST" record px4-v1.3.4/arming/never_armed --rate 250 --out "$log"
  run "$ATTEST" replay "$log" --level exact
  [ "$status" -eq 0 ]
  has "px4-v1.3.4"
  has "a pass by a log proves little"
  has "PASS 1 of 1 traces and logs agree"
  "$ATTEST" sim gust --rate 250 --out "$log"
  run "$ATTEST" replay "$log" --port fault:quat-order-xyzw
  [ "$status" -eq 1 ]
  has "first at tick"
}

@test "a log that lacks every second sample is judged by its rates setpoints" {
  log="$BATS_TEST_TMPDIR/flight.ulg"
  flight_log "$log"
  run "$ATTEST" replay "$log"
  [ "$status" -eq 0 ]
  has "vehicle_rates_setpoint: 500 of 1000 logged samples paired"
  has "500 100.0%  within 0.0001"
  has "not judged: it depends on earlier steps"
  ends "PASS 1 of 1 traces and logs agree (builtin, numeric); not judged: actuator_controls_0*\
(it depends on earlier steps, and the log does not have every step)*"
  has "the profile is taken to be px4-v1.5.5"
  run "$ATTEST" replay "$log" --port fault:quat-order-xyzw
  [ "$status" -eq 1 ]
  has "samples of vehicle_rates_setpoint are wrong: the reference agrees with the log there"
  has "FAIL 0 of 1"
}

@test "controls without D term and integral are judged, also if the log lacks steps" {
  "$ATTEST" record px4-v1.5.5/rates/p_alone --rate 250 --out whole.ulg
  "$PYTHON" "$SOURCE/tests/cli/thin_log.py" whole.ulg thin.ulg
  run "$ATTEST" replay thin.ulg --json r.json
  [ "$status" -eq 0 ]
  has "actuator_controls_0, roll, pitch, yaw and thrust, while the integrals are 0: 24 of 24 logged"
  ends "PASS 1 of 1 traces and logs agree (builtin, numeric); not judged: the rest of actuator_*"
  grep -q '"condition": "roll, pitch, yaw and thrust, while the integrals are 0"' r.json
  run "$ATTEST" replay thin.ulg --port fault:gyro-yaw-reversed
  [ "$status" -eq 1 ]
  has "samples of actuator_controls_0 are wrong: the reference agrees with the log there"
  # With a D term of yaw, only roll and pitch are known; with a thrust, integrals are not 0.
  "$ATTEST" record px4-v1.5.5/rates/gains_differ_by_axis --rate 250 --out whole.ulg
  "$PYTHON" "$SOURCE/tests/cli/thin_log.py" whole.ulg thin.ulg
  run "$ATTEST" replay thin.ulg
  [ "$status" -eq 2 ]
  has "it depends on earlier steps, and the log does not have every step"
  lacks "while the integrals are 0"
}

@test "a long log is not in memory as a whole" {
  ! nm "$ATTEST" | grep -q __asan_init || skip "sanitizers need more memory"
  flight_log flight.ulg
  "$PYTHON" "$SOURCE/tests/cli/long_log.py" flight.ulg long.ulg 60
  run "$PYTHON" -c 'import resource, subprocess, sys
run = subprocess.run(sys.argv[1:])
print("peak_mb", resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss // 1024)
sys.exit(run.returncode)' "$ATTEST" replay long.ulg
  [ "$status" -eq 0 ]
  has "PASS 1 of 1 traces and logs agree"
  [ "$(sed -n 's/^peak_mb //p' <<<"$output")" -lt 45 ]
}

@test "an output field that the log lacks is not compared, and named" {
  log="$BATS_TEST_TMPDIR/flight.ulg"
  flight_log "$log"
  # Gives the field roll another name of the same length.
  sed -i 's/\(vehicle_rates_setpoint:[^:]*\)float roll;/\1float rowl;/' "$log"
  run "$ATTEST" replay "$log"
  has "not in the log, so not compared: vehicle_rates_setpoint.roll"
  [ "$status" -eq 0 ]
  has "500 100.0%  within 0.0001"
}

@test "the limits and assumptions for a log are options" {
  log="$BATS_TEST_TMPDIR/flight.ulg"
  flight_log "$log"
  run "$ATTEST" replay "$log" --port fault:quat-order-xyzw --within 10
  [ "$status" -eq 0 ]
  run "$ATTEST" replay "$log" --assume armed
  [ "$status" -eq 2 ]
  has "has the topic actuator_armed"
  run "$ATTEST" replay "$log" --assume amred
  [ "$status" -eq 2 ]
  has 'did you mean `armed`'
  run "$ATTEST" replay "$log" --param MC_ROL_P=7
  [ "$status" -eq 2 ]
  has 'did you mean `MC_ROLL_P`'
}

# wild VALUE: the port wild.so, the C starter with this rates setpoint in every 25th tick.
wild() {
  local starter="$SOURCE/controller/starters/c"
  cat >wild.c <<'WILD'
#define attest_unit_v1 right_unit_v1
#include "unit.c"
#undef attest_unit_v1

static int wild_step(void* self, const attest_inputs* in, attest_outputs* out) {
  static int ticks;
  const int result = step(self, in, out);
  if (++ticks % 25 == 0) out->vehicle_rates_setpoint.roll = WILD;
  return result;
}

const attest_unit* attest_unit_v1(void) {
  static attest_unit unit;
  unit = *right_unit_v1();
  unit.step = wild_step;
  return &unit;
}
WILD
  cc -shared -fPIC "-DWILD=($1)" "-I$SOURCE/controller" "-I$starter" wild.c \
    "$starter"/{attitude,rate,tailsitter}.c -lm -o wild.so
}

@test "wild values of a port do not explain deviations from a log" {
  log="$BATS_TEST_TMPDIR/flight.ulg"
  flight_log "$log"
  for value in 100 -100; do
    wild $value
    run "$ATTEST" replay "$log" --port lib:./wild.so
    [ "$status" -eq 1 ]
    has "samples of vehicle_rates_setpoint are wrong: the reference agrees with the log there"
  done
  wild NAN
  run "$ATTEST" replay "$log" --port lib:./wild.so
  [ "$status" -eq 1 ]
  has "non-finite"
  has "NaN or infinity in 20 samples of vehicle_rates_setpoint where the log has numbers"
}

@test "a port that crashes on a log fails" {
  log="$BATS_TEST_TMPDIR/flight.ulg"
  flight_log "$log"
  run "$ATTEST" replay "$log" --port "lib:$PORTS/port_crash.so"
  [ "$status" -eq 1 ]
  has "crash"
}

@test "a file that is no log is refused" {
  echo "timestamp" >"$BATS_TEST_TMPDIR/a.ulg"
  run "$ATTEST" replay "$BATS_TEST_TMPDIR/a.ulg"
  [ "$status" -eq 2 ]
  has "a.ulg"
}

@test "replay writes a page of one trace or log" {
  log="$BATS_TEST_TMPDIR/flight.ulg"
  flight_log "$log"
  trace="$SOURCE"/golden/recorded/px4-v1.5.5/tracking_100hz.csv
  run "$ATTEST" replay "$log" --html log.html
  [ "$status" -eq 0 ]
  grep -q "How far the port is from the log" log.html
  grep -q "not judged: actuator_controls_0 (it depends on earlier steps" log.html
  run "$ATTEST" replay "$trace" --port fault:quat-order-xyzw --html trace.html
  [ "$status" -eq 1 ]
  grep -q "first deviation" trace.html
  run "$ATTEST" replay "$log" --html "$log"
  [ "$status" -eq 2 ]
  has "would be overwritten"
}
