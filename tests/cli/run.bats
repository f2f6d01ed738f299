load common

# For tests that need many cases: groups without flights, which take seconds (flight.bats).
quick=(--group battery --group rates --rate 100,250,8000)

@test "the reference conforms to the bit, at every rate" {
  run "$ATTEST" run --level exact --group rates
  [ "$status" -eq 0 ]
  has "PASS"
  has "11 rates"
}

@test "without a command: help that teaches, exit 2" {
  run "$ATTEST"
  [ "$status" -eq 2 ]
  has "First steps"
  has "attest --help lists the commands."
}

@test "help names the first steps" {
  run "$ATTEST" --help
  [ "$status" -eq 0 ]
  has "attest run mine/port.so"
}

@test "a wrong command line is an error that says what to do" {
  run "$ATTEST" run --prot builtin
  [ "$status" -eq 2 ]
  has 'attest: error: unknown option `--prot`; did you mean `--port`?'
  run "$ATTEST" --nonsense
  [ "$status" -eq 2 ]
  has 'attest: error: unknown option `--nonsense`'
  run "$ATTEST" new-port mine
  [ "$status" -eq 2 ]
  has "attest: error: name a new folder and the port to start from"
}

@test "filters, groups and rates select" {
  run "$ATTEST" run --filter 'attitude/*@250hz'
  [ "$status" -eq 0 ]
  has "1 rate)"
  run "$ATTEST" run --group attitude --group rates --rate 50,333
  [ "$status" -eq 0 ]
  has "2 rates)"
}

@test "a filter that matches nothing is said" {
  run "$ATTEST" run --filter 'nothing_like_it'
  [ "$status" -eq 2 ]
  has 'no case matches `nothing_like_it`'
}

@test "a misspelt group names the nearest one" {
  run "$ATTEST" run --group attitud
  [ "$status" -eq 2 ]
  has 'did you mean `attitude`'
}

@test "an impossible rate, level or shard is refused" {
  for wrong in "--rate 0" "--rate fast" "--rate 251" "--level lax" "--shard 3/2" "--shard x"; do
    run "$ATTEST" run $wrong
    [ "$status" -eq 2 ]
    has "attest: error:"
  done
}

@test "shards divide the suite: each case in exactly one" {
  "$ATTEST" run "${quick[@]}" --json all.json >/dev/null
  for i in 1 2 3; do
    "$ATTEST" run "${quick[@]}" --shard "$i/3" --json "part$i.json" >/dev/null
  done
  ids() { grep -ho '"id": *"[^"]*"' "$@" | sort; }
  [ "$(ids all.json)" = "$(ids part1.json part2.json part3.json)" ]
}

@test "the same bytes in the JSON report for any number of jobs" {
  "$ATTEST" run "${quick[@]}" --jobs 1 --json one.json >/dev/null
  "$ATTEST" run "${quick[@]}" --jobs 4 --json four.json >/dev/null
  cmp one.json four.json
  run "$ATTEST" run "${quick[@]}" --jobs 1 --port "lib:$PORTS/port_sign_flip.so" --json one.json
  run "$ATTEST" run "${quick[@]}" --jobs 4 --port "lib:$PORTS/port_sign_flip.so" --json four.json
  cmp one.json four.json
}

@test "fail-fast stops at the same case for any number of jobs" {
  run "$ATTEST" run --fail-fast --jobs 1 --port "lib:$PORTS/port_sign_flip.so" --json one.json
  [ "$status" -eq 1 ]
  run "$ATTEST" run --fail-fast --jobs 4 --port "lib:$PORTS/port_sign_flip.so" --json four.json
  [ "$status" -eq 1 ]
  cmp one.json four.json
  grep -q '"stopped_early": *true' one.json
}

@test "a report that cannot be written is said before the run" {
  run "$ATTEST" run --junit no/such/folder/junit.xml
  [ "$status" -eq 2 ]
  has "no/such/folder/junit.xml"
  lacks "PASS"
}

@test "an empty case folder is an error" {
  mkdir -p empty/cases
  run "$ATTEST" --suite empty run
  [ "$status" -eq 2 ]
  has "no case files"
}

@test "a folder that is no suite is an error" {
  run "$ATTEST" --suite . run
  [ "$status" -eq 2 ]
  has "has no cases/ folder"
}

@test "a missing golden names bless" {
  make_suite
  run "$ATTEST" --suite suite run
  [ "$status" -eq 2 ]
  has "no golden for px4-v1.5.5/attitude/roll"
  [ "$(grep -c "no golden" <<<"$output")" -eq 1 ]
  has "attest --suite 'suite' bless --filter 'px4-v1.5.5/attitude/roll'"
}

@test "a golden of another version of the case is stale" {
  blessed_suite
  sed -i 's/to = 20/to = 25/' suite/cases/px4-v1.5.5/attitude/roll.toml
  run "$ATTEST" --suite suite run
  [ "$status" -eq 2 ]
  has "stale"
  has "attest --suite 'suite' bless"
}

@test "a golden that somebody edited is refused" {
  blessed_suite
  sed -i '5s/$/1/' suite/golden/px4-v1.5.5/attitude/roll.csv
  run "$ATTEST" --suite suite run
  [ "$status" -eq 2 ]
  has "roll.csv"
  has "is not the file that was blessed"
}

@test "a broken case file is shown with its line, all mistakes at once" {
  make_suite
  sed -i 's/^duration_ticks.*/duration_tick = 30/; s/amplitude = 0.3/amplitud = 0.3/' \
    suite/cases/px4-v1.5.5/attitude/roll.toml
  run "$ATTEST" --suite suite run
  [ "$status" -eq 2 ]
  has "roll.toml:5"
  has 'did you mean `duration_ticks`'
  has 'did you mean `amplitude`'
}

@test "no colour in a pipe, quiet says nothing when all is well" {
  run "$ATTEST" run "${quick[@]}"
  lacks $'\e['
  run "$ATTEST" --quiet run "${quick[@]}"
  [ "$status" -eq 0 ]
  [ -z "$output" ]
}

# The port hangs in a step, while it is loaded, or in create().
@test "a run that is interrupted reports the vectors that were run" {
  "$ATTEST" run --port "lib:$STARTER" --json r.json >out 2>err &
  pid=$!
  sleep 5
  kill -INT "$pid"
  status=0
  wait "$pid" || status=$?
  [ "$status" -eq 130 ]
  grep -q "interrupted; the reports have the vectors that were run" err
  grep -qE "^STOPPED [0-9]+ vectors passed, 0 failed" out
  grep -qE "; stopped early, [0-9]+ of [0-9]+ vectors not run$" out
  must_fail grep -q PASS out
  grep -qE "^  [a-z_]+ .* STOPPED$" out
  "$PYTHON" - <<'CHECK'
import json
report = json.load(open("r.json"))
assert not report["errors"], report["errors"]
assert report["stopped_early"] and 0 < len(report["results"]) < 12000, len(report["results"])
left = sum(one["vectors"] for one in report["not_run"])
assert left == report["selection"]["vectors"] - len(report["results"]) > 0, left
CHECK
}

@test "a port that hangs ends the run after five cases" {
  run timeout 120 "$ATTEST" run "lib:$PORTS/port_hang.so" --timeout 0.3 --jobs 2
  [ "$status" -eq 1 ]
  has "stopped, because 5 cases in a row ended by a timeout"
  [[ ${lines[-1]} =~ stopped\ early,\ [0-9]+\ of\ [0-9]+\ vectors\ not\ run$ ]]
}

@test "Ctrl-C ends a run at once, and without a result it leaves no report behind" {
  for port in hang hangs_in_load hangs_in_create; do
    timeout 50 "$ATTEST" run --port "lib:$PORTS/port_$port.so" --timeout 60 --junit r.xml \
      >out 2>err &
    limited=$!
    for _ in $(seq 100); do
      pid=$(pgrep -P $limited) && [ -n "$(pgrep -P "$pid")" ] && break
      sleep 0.05
    done
    kill -INT "$pid"
    status=0
    wait $limited || status=$?
    [ "$status" -eq 130 ]
    grep -q interrupted err
    [ -z "$(find . -name '*r.xml*')" ]
  done
}

@test "a parent that ignores ended children changes nothing" {
  run env --ignore-signal=CHLD "$ATTEST" run --group tpa --rate 250
  [ "$status" -eq 0 ]
  has "PASS 8 vectors passed, 0 failed"
}

@test "reports are complete although nobody reads the summary to its end" {
  "$ATTEST" run "${quick[@]}" --port "lib:$PORTS/port_sign_flip.so" --json r.json |
    head -n 1 || true
  python3 -c 'import json; json.load(open("r.json"))'
}

@test "a reference with other bits than the golden: its values decide, and the report says so" {
  blessed_suite
  golden=suite/golden/px4-v1.5.5/attitude/roll.csv
  awk -F, -v OFS=, 'NR == 3 { $5 = sprintf("%.9g", $5 + 2e-7) } 1' $golden >other_bits.csv
  cp other_bits.csv $golden
  accept_edit $golden
  run "$ATTEST" --suite suite run --json report.json
  [ "$status" -eq 0 ]
  has "; the golden's values judged 1"
  has ", because the reference has other bits here"
  grep -q '"by_golden": true' report.json
  "$ATTEST" --suite suite merge report.json
  run "$ATTEST" --suite suite run --level exact
  [ "$status" -eq 2 ]
  has "the reference has other bits on this machine than the golden"
  # Beyond the tolerances nobody can judge.
  awk -F, -v OFS=, 'NR == 3 { $5 = 0.5 } 1' $golden >wrong.csv
  cp wrong.csv $golden
  accept_edit $golden
  run "$ATTEST" --suite suite run
  [ "$status" -eq 2 ]
  has "the reference of this build answers another out/"
}

@test "a golden that lacks an output is refused: nothing would be compared with it" {
  blessed_suite
  golden=suite/golden/px4-v1.5.5/attitude/roll.csv
  cut -d, -f 1-6,8- $golden >cut.csv
  mv cut.csv $golden
  accept_edit $golden
  run "$ATTEST" --suite suite run
  [ "$status" -eq 2 ]
  has "has no out/"
  has "bless it anew, or restore it from version control"
}

@test "a value that no option can have is refused: an empty text, NaN" {
  run "$ATTEST" run --json "" --group rates
  [ "$status" -eq 2 ]
  has "--json: is empty"
  run "$ATTEST" run --group rates --timeout nan
  [ "$status" -eq 2 ]
  has "--timeout: nan is not a finite number"
  for options in "compare a b --tolerance" "replay a --within" "replay a --at-least" \
    "vectors d --from-log a --from" "stress --p99-latency"; do
    run "$ATTEST" $options nan
    [ "$status" -eq 2 ]
    has "nan is not a finite number"
  done
  run "$ATTEST" compare a b --tolerance inf
  [ "$status" -eq 2 ]
  has "--tolerance: inf is not a finite number"
  run "$ATTEST" run --rate 250 --group rates --param MC_ROLLRATE_P=nan
  [ "$status" -eq 2 ]
  has "with a finite number"
}

@test "two reports in one file are refused" {
  run "$ATTEST" run --group rates --json report --junit ./report
  [ "$status" -eq 2 ]
  has "report: is asked for twice"
  [ ! -e report ]
}

@test "a report named - goes to stdout, and everything else to stderr" {
  "$ATTEST" run --group tpa --rate 250 --json - >report.json 2>text
  python3 -m json.tool report.json >/dev/null
  grep -q "^PASS" text
  "$ATTEST" run --group tpa --rate 250 --junit - 2>/dev/null | xmllint --noout -
}

@test "the traces of what fails are saved, and compare as the run said" {
  run "$ATTEST" run --group tpa --rate 250 --profile px4-v1.5.5 --port fault:tpa-missing \
    --no-diagnose --save-traces traces
  [ "$status" -eq 1 ]
  has "note: the traces of the failing vectors are in traces"
  [[ ${lines[-1]} == FAIL* ]]
  place=traces/px4-v1.5.5/tpa/each_axis/250hz
  run "$ATTEST" compare "$place.got.csv" "$place.want.csv"
  [ "$status" -eq 1 ]
  has "first at tick"
  "$ATTEST" replay "$place.want.csv"
  [ "$(find traces -name '*.got.csv' | wc -l)" -eq 7 ]
}

@test "the traces of a failing flight have what the reference answers to the same inputs" {
  run "$ATTEST" run --filter 'px4-v1.5.5/flight/hover@250hz-iris-mujoco' --no-diagnose \
    --port "lib:$PORTS/port_sign_flip.so" --save-traces traces
  [ "$status" -eq 1 ]
  place=traces/px4-v1.5.5/flight/hover/250hz-iris-mujoco
  head -1 "$place.got.csv" | grep -q plant/
  "$ATTEST" replay "$place.want.csv" --level exact
  run "$ATTEST" replay "$place.want.csv" --port "lib:$PORTS/port_sign_flip.so"
  [ "$status" -eq 1 ]
}

@test "of a crash only the expected trace is saved" {
  run "$ATTEST" run --filter 'px4-v1.5.5/tpa/each_axis@250hz' --no-diagnose \
    --port "lib:$PORTS/port_crash.so" --save-traces traces
  [ "$status" -eq 1 ]
  has "in step() at tick 20"
  [ "$(cd traces/px4-v1.5.5/tpa/each_axis && echo *)" = "250hz.want.csv provenance.toml" ]
}

@test "saved traces of another profile, and of a mixer, replay with their own" {
  run "$ATTEST" run --profile px4-v1.3.4 --group attitude --rate 250 --no-diagnose \
    --port fault:quat-order-xyzw --save-traces old
  [ "$status" -eq 1 ]
  "$ATTEST" replay --level exact old/px4-v1.3.4/attitude/antipodal_setpoint/250hz.want.csv
  run "$ATTEST" run --group mixer --rate 250 --no-diagnose --port fault:mixer-output-0-to-1 \
    --save-traces mixers
  [ "$status" -eq 1 ]
  "$ATTEST" replay --level exact "$(find mixers -name '*.want.csv' | sort | head -1)"
}

@test "a saved trace ends where the outputs of the port end" {
  run "$ATTEST" run --filter 'px4-v1.5.5/tpa/each_axis@250hz' --no-diagnose \
    --port "lib:$PORTS/port_step_fails.so" --save-traces traces
  [ "$status" -eq 1 ]
  [ "$(wc -l <traces/px4-v1.5.5/tpa/each_axis/250hz.got.csv)" -eq 21 ]
  run "$ATTEST" run --group tpa --filter 'px4-v1.5.5/*@250hz' --no-diagnose \
    --port "lib:$PORTS/hostile_wrong_unsupported.so" --save-traces unsupported
  [ "$status" -eq 1 ]
  run "$ATTEST" run --filter 'px4-v1.5.5/parameters/change_in_flight@250hz' --no-diagnose \
    --port "lib:$PORTS/port_step_fails.so" --save-traces later
  lacks "not saved"
  [ "$(wc -l <later/px4-v1.5.5/parameters/change_in_flight/250hz.got.csv)" -eq 21 ]
  for file in unsupported/px4-v1.5.5/tpa/*/250hz.got.csv; do [ "$(wc -l <"$file")" -eq 21 ]; done
}

@test "the folder for traces must be new, writable and not of the suite" {
  for folder in "$SOURCE/golden" "$SOURCE/golden/new"; do
    run "$ATTEST" run --group tpa --save-traces "$folder"
    [ "$status" -eq 2 ]
    has "is in a suite"
  done
  mkdir old
  touch old/file
  run "$ATTEST" run --group tpa --save-traces old
  [ "$status" -eq 2 ]
  has "old: is not empty"
  run "$ATTEST" run --group tpa --save-traces /proc/traces
  [ "$status" -eq 2 ]
  has "/proc/traces: cannot be made"
}

@test "the excerpt of a report in README.md is what a run prints" {
  excerpt=$(sed -n '/^    \$ attest run/,/^$/p' "$SOURCE/README.md" | sed 's/^    //')
  run "$ATTEST" $(head -1 <<<"$excerpt" | cut -d' ' -f3-)
  [ "$status" -eq 1 ]
  python3 - "$excerpt" "$output" <<'EXCERPT'
import sys
excerpt, report = sys.argv[1].splitlines()[1:], iter(sys.argv[2].splitlines())
for line in excerpt:
    if line != "...":
        start, is_start = line.removesuffix("..."), line.endswith("...")
        assert any(got == start or (is_start and got.startswith(start)) for got in report), line
EXCERPT
}

@test "names of groups, profiles and vehicles may be separated by commas, as reports show them" {
  "$ATTEST" list --group attitude,tpa --profile px4-v1.5.5,px4-v1.3.4 >commas
  "$ATTEST" list --group attitude --group tpa --profile px4-v1.5.5 --profile px4-v1.3.4 >options
  grep -q px4-v1.3.4/tpa/ commas
  cmp commas options
  "$ATTEST" list --vehicle hexa,crazyflie2 >commas
  "$ATTEST" list --vehicle hexa --vehicle crazyflie2 | cmp commas
}

# paths_of FILE...: the files that reports name: JUnit XML, GitLab's JSON, the terminal.
paths_of() {
  python3 - "$@" <<'PATHS'
import json, pathlib, re, sys
for file in map(pathlib.Path, sys.argv[1:]):
    text = file.read_text()
    if file.suffix == ".json":
        print("\n".join(entry["location"]["path"] for entry in json.loads(text)))
    else:
        path = r"^ +(?:case|golden): +(.*?)(?: \(also .*)?$"
        print("\n".join(re.findall(path, text, re.MULTILINE)))
PATHS
}

@test "each path in a report is that of a file, from the folder where attest was started" {
  # The cases of px4-v1.3.4 are in the files of px4-v1.5.5.
  mkdir -p here/suite/{cases,golden} ours
  for profile in px4-v1.5.5 px4-v1.3.4; do
    mkdir -p here/suite/golden/$profile
    cp "$SOURCE/golden/$profile/provenance.toml" here/suite/golden/$profile/
  done
  mkdir here/suite/cases/px4-v1.5.5
  cp -r "$SOURCE/cases/px4-v1.5.5/rates" here/suite/cases/px4-v1.5.5/
  cp -r "$SOURCE/golden/px4-v1.5.5/rates" here/suite/golden/px4-v1.5.5/
  echo ../here/suite >ours/BASE
  cp -r here/suite/golden ours/
  failing=(--port "lib:$PORTS/port_sign_flip.so" --profile px4-v1.3.4 --group rates --rate 250
    --no-diagnose)
  begin_with() { [ "$(wc -l <paths)" -gt 1 ] && ! grep -v "^$1" paths; }
  looked() {
    run "$ATTEST" "$@" --verbose --junit junit.xml --code-quality quality.json
    [ "$status" -eq 1 ]
    echo "$output" >terminal
    paths_of junit.xml quality.json terminal | sort -u >paths
    while read -r path; do [ -f "$path" ]; done <paths
  }
  looked run "${failing[@]}"
  begin_with "$SOURCE/"
  looked --suite ours run "${failing[@]}"
  begin_with "\(here/suite/cases\|ours/golden\)/"
  cd here
  looked --suite suite run "${failing[@]}" --json report.json
  begin_with suite/
  looked --suite "$PWD/suite" merge report.json --no-diagnose
  begin_with suite/
  looked --suite ../ours run "${failing[@]}"
  grep -q "^suite/cases" paths
  grep -q "^$BATS_TEST_TMPDIR/ours/golden" paths
  cd suite
  looked --suite . run "${failing[@]}"
  begin_with "\(cases\|golden\)/px4"

  run "$ATTEST" stress --rates 250 --duration 1 --port "lib:$PORTS/port_crash.so" \
    --junit stress.xml
  [ "$status" -eq 1 ]
  [ "$(paths_of stress.xml)" = "$SOURCE/cases/px4-v1.5.5/flight/hover.toml" ]
}

@test "what everybody types first is understood" {
  cp "$STARTER" mine.so
  for port in mine.so ./mine.so "--port ./mine.so"; do
    run "$ATTEST" run $port --rate 250hz --profile v1.5.5 --group tpa
    [ "$status" -eq 0 ]
    has "(px4-v1.5.5, numeric, 1 rate)"
    has "lib:./mine.so"
  done
  run "$ATTEST" smoke mine.so
  [ "$status" -eq 0 ]
  run "$ATTEST" run mine.so --port builtin
  [ "$status" -eq 2 ]
  printf '#!/bin/sh\nexit 3\n' >program
  run "$ATTEST" smoke program
  [ "$status" -eq 2 ]
  has "neither a shared library nor an executable file"
  chmod +x program
  run "$ATTEST" smoke ./program
  [ "$status" -eq 2 ]
  has "proc:./program"
  run "$ATTEST" run --filter attitude
  [ "$status" -eq 2 ]
  has '`attitude` is a group: write `--group attitude` or `attitude/*`'
  # The case rate_law/landed, which a port of the units does not have.
  run "$ATTEST" run --filter landed \
    --port "lib:${STARTER%/c/*}/c_cascade/attest_starter_c_cascade.so"
  [ "$status" -eq 2 ]
  has 'no vector was compared: '
  has '; `landed` is also a group: write `--group landed`'
  run "$ATTEST" sim hover
  [ "$status" -eq 0 ]
  has "px4-v1.5.5/flight/hover@250hz-iris-mujoco"
  has "metric"
  run "$ATTEST" new-port
  [ "$status" -eq 2 ]
  has "attest new-port mine --lang c"
  has "python_law"
}
