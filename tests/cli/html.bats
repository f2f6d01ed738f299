# `attest run --html`: the file, and the traces that it needs. html_report.py opens the page.

load common

failing=(run --group tpa --rate 250 --port fault:tpa-missing --no-diagnose)

# plots PAGE: the ids of the vectors that the page plots.
plots() {
  python3 - "$1" <<'PLOTS'
import json, re, sys
page = open(sys.argv[1], encoding="utf-8").read()
plots = json.loads(re.search(r'id="plots">(.*?)</script>', page, re.DOTALL)[1])
print("\n".join(plots))
PLOTS
}

@test "the page plots what fails, and no temporary folder is left" {
  mkdir temporary
  TMPDIR=$PWD/temporary run "$ATTEST" "${failing[@]}" --html page.html
  [ "$status" -eq 1 ]
  lacks "plots:"
  [ "$(plots page.html)" = "px4-v1.5.5/tpa/break_in_flight@250hz" ]
  [ -z "$(ls temporary)" ]
}

@test "the page is the same for any number of jobs, and with saved traces" {
  for jobs in 1 3; do
    run "$ATTEST" "${failing[@]}" --html "$jobs.html" --jobs "$jobs"
    [ "$status" -eq 1 ]
  done
  cmp 1.html 3.html
  run "$ATTEST" "${failing[@]}" --html saved.html --save-traces traces
  [ "$status" -eq 1 ]
  cmp 1.html saved.html
  [ "$(find traces -name '*.tolerance.csv' | wc -l)" -eq 7 ]
}

@test "the page goes to stdout, and everything else to stderr" {
  "$ATTEST" run --group tpa --rate 250 --html - 2>messages >page.html
  [ "$(head -c 15 page.html)" = "<!DOCTYPE html>" ]
  [ "$(tail -c 8 page.html)" = "</html>" ]
  grep -q "^PASS" messages
  [ "$(plots page.html)" = "" ]
}

@test "a page whose traces cannot be written is said before the run" {
  TMPDIR=/proc run "$ATTEST" "${failing[@]}" --html page.html
  [ "$status" -eq 2 ]
  has "/proc: a temporary folder cannot be made here"
  [ ! -e page.html ]
}

@test "no temporary folder is left, however attest ends" {
  mkdir temporary
  for signal in INT KILL; do
    TMPDIR=$PWD/temporary "$ATTEST" run --port "lib:$PORTS/port_hang.so" --group tpa \
      --html page.html 2>/dev/null &
    for _ in $(seq 100); do
      [ -n "$(ls temporary)" ] && break
      sleep 0.1
    done
    [ -n "$(ls temporary)" ]
    kill -$signal $!
    wait $! || [ "$?" -gt 128 ]
    nothing_is_left
    # After a kill another process removes it.
    for _ in $(seq 50); do
      [ -n "$(ls temporary)" ] || break
      sleep 0.1
    done
    [ -z "$(ls temporary)" ]
    [ ! -e page.html ]
  done
}

@test "a flight is plotted, also at recorded times" {
  cat >tasks.toml <<'TASKS'
[task.unit]
rate_hz = 250
execution_us = 76
priority = 2
TASKS
  "$ATTEST" schedule tasks.toml --record-timing t.json
  for selection in "--timing t.json" "--filter px4-v1.5.5/flight/hover@250hz-iris-mujoco"; do
    # shellcheck disable=SC2086 # two words
    run "$ATTEST" run $selection --no-diagnose --html page.html \
      --port "lib:$PORTS/port_sign_flip.so"
    [ "$status" -eq 1 ]
    [[ $(plots page.html) == px4-v1.5.5/flight/*@250hz-iris-mujoco ]]
  done
}

@test "a failure is plotted at each level" {
  for level in exact events; do
    run "$ATTEST" "${failing[@]}" --level "$level" --html "$level.html"
    [ "$status" -eq 1 ]
    [ -n "$(plots "$level.html")" ]
  done
}

@test "a port that does not repeat its outputs is noticed" {
  cat >other.py <<'PORT'
import os, sys
sys.path.insert(0, os.environ["STARTER_FOLDER"])
import controller, port
defaults = controller.default_parameters
controller.default_parameters = lambda profile: {
    name: value * (1 + os.getpid() / 2**23 if name == "MC_ROLL_P" else 1)
    for name, value in defaults(profile).items()
}
port.main()
PORT
  export STARTER_FOLDER=$SOURCE/controller/starters/python
  run "$ATTEST" run --filter 'px4-v1.5.5/attitude/tilt_by_azimuth@250hz' --no-diagnose \
    --port "proc:python3 $PWD/other.py" --html page.html
  [ "$status" -eq 1 ]
  grep -q '"repeated":false' page.html
  "$ATTEST" "${failing[@]}" --html page.html || true
  grep -q '"repeated":true' page.html
}

@test "one flight is a page, with or without its trace" {
  "$ATTEST" sim flip_150_level --rate 250 --html one.html --out flown.csv >printed
  grep -q "1000 ticks -> flown.csv, one.html$" printed
  "$ATTEST" sim flip_150_level --rate 250 --html two.html >printed
  grep -q "1000 ticks -> two.html$" printed
  cmp one.html two.html
  "$ATTEST" sim flip_150_level --rate 250 --html - >three.html 2>printed
  cmp one.html three.html
  grep -q "1000 ticks$" printed
  run "$ATTEST" sim flip_150_level --rate 250
  [ "$status" -eq 0 ]
  has "1000 ticks"
  has "metric"
  run "$ATTEST" sim flip_150_level --rate 250 --html same --out same
  [ "$status" -eq 2 ]
  has "is asked for twice"
}

@test "a flight in which the port crashes is a page without plots" {
  run "$ATTEST" sim hover --rate 250 --port "lib:$PORTS/port_crash.so" --html page.html
  [ "$status" -eq 1 ]
  has "0 ticks -> page.html"
  [[ ${lines[-1]} == "CRASH "* ]]
  grep -q "in step() at tick 20" page.html
}

@test "without a result the old page stays" {
  echo old >page.html
  "$ATTEST" record px4-v1.5.5/tpa/each_axis --rate 250 --out recorded.csv >/dev/null
  port=(--port "lib:$PORTS/port_other_profiles.so")
  hover=px4-v1.5.5/flight/hover
  run "$ATTEST" sim $hover --rate 250 "${port[@]}" --html page.html
  [ "$status" -eq 2 ]
  has "not px4-v1.5.5; write: attest sim px4-v1.18/flight/hover --rate 250:1000 --port lib:"
  run "$ATTEST" replay recorded.csv --profile px4-v1.5.5 "${port[@]}" --html page.html
  [ "$status" -eq 2 ]
  has "not px4-v1.5.5; write: attest replay TRACE_OF_px4-v1.18.csv --port lib:"
  run "$ATTEST" sweep-rate $hover --rates 250 "${port[@]}" --html page.html --csv page.html.csv
  [ "$status" -eq 2 ]
  has "not px4-v1.5.5; write: attest sweep-rate px4-v1.18/flight/hover --rate 250:1000 "
  [ ! -e page.html.csv ]
  run "$ATTEST" stress --case $hover --rates=250 --duration 0.1 "${port[@]}" --html page.html
  [ "$status" -eq 2 ]
  ends "* --duration 0.1 --html page.html"
  lacks "idle machine" # it did not fly
  has "not px4-v1.5.5; write: attest stress --case px4-v1.18/flight/hover --rate 250:1000 "
  [ "$(cat page.html)" = old ]
}

@test "one flight on both plants is one page" {
  run "$ATTEST" sim flip_150_level --rate 250 --plant all --html page.html
  [ "$status" -eq 0 ]
  has "@250hz-iris-mujoco"
  has "@250hz-iris-ode"
  grep -q '"name":"roll (ode)"' page.html
  run "$ATTEST" sim flip_150_level --rate 250 --plant all --out flown.csv
  [ "$status" -eq 2 ]
  has "--out writes one flight"
}
