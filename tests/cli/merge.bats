# Shards, the reports put together again, and what failed run again.
load common

selected=(--group attitude --group tpa --rate 250,1000)

# shards PORT N: the report of all in all.json, of the shards in part1.json, ...
shards() {
  run "$ATTEST" run "${selected[@]}" --port "$1" --json all.json
  for i in $(seq "$2"); do
    run "$ATTEST" run "${selected[@]}" --port "$1" --shard "$i/$2" --json "part$i.json"
  done
}

@test "merged reports are those of a run without shards, byte for byte" {
  shards builtin 3
  has "only --group attitude,tpa --rate 250,1000 --shard 3/3"
  run "$ATTEST" merge part2.json part3.json part1.json --json merged.json
  [ "$status" -eq 0 ]
  cmp all.json merged.json
}

@test "merged failures have the diagnosis of the whole run" {
  shards fault:tpa-missing 2
  run "$ATTEST" merge part1.json part2.json --json merged.json --junit merged.xml
  [ "$status" -eq 1 ]
  has '`tpa-missing`'
  cmp all.json merged.json
  grep -q tpa-missing merged.xml
}

@test "a missing shard, one that is there twice, and reports of other runs are refused" {
  shards builtin 3
  run "$ATTEST" merge part1.json part3.json --json merged.json
  [ "$status" -eq 2 ]
  has "missing: the report of shard 2/3"
  cp part1.json copy.json
  run "$ATTEST" merge part1.json part2.json part3.json copy.json
  [ "$status" -eq 2 ]
  has "copy.json: is shard 1/3, and so is part1.json"
  "$ATTEST" run --group rates --rate 250 --shard 2/3 --json other.json >/dev/null
  run "$ATTEST" merge part1.json other.json part3.json
  [ "$status" -eq 2 ]
  has 'other.json: the selection is `--group rates --rate 250`, but in part1.json it is'
  sed 's/"attest_version": "[^"]*"/"attest_version": "9.9"/' part2.json >newer.json
  run "$ATTEST" merge part1.json newer.json part3.json
  [ "$status" -eq 2 ]
  has 'newer.json: the version of attest is `9.9`'
  [ ! -e merged.json ]
}

@test "reports of another suite, or of an unknown vector, are refused" {
  shards builtin 2
  sed 's/"sha256": "[0-9a-f]*"/"sha256": "'"$(printf '0%.0s' {1..64})"'"/' part1.json >p1.json
  sed 's/"sha256": "[0-9a-f]*"/"sha256": "'"$(printf '0%.0s' {1..64})"'"/' part2.json >p2.json
  run "$ATTEST" merge p1.json p2.json
  [ "$status" -eq 2 ]
  has "but the reports are of 000000000000; name theirs with --suite DIR"
  sed 's/both_tilted/both_bent/' part1.json >p1.json
  sed 's/both_tilted/both_bent/' part2.json >p2.json
  run "$ATTEST" merge p1.json p2.json
  [ "$status" -eq 2 ]
  has "/attitude/both_bent@250hz is no vector of the suite"
}

@test "a port that is not here any more leaves out the diagnosis only" {
  cp "$PORTS/port_sign_flip.so" mine.so
  shards lib:./mine.so 2
  mv mine.so moved.so
  run "$ATTEST" merge part1.json part2.json
  [ "$status" -eq 1 ]
  has "no probable mistake is named, because lib:./mine.so is not the port of the reports"
  run "$ATTEST" merge part1.json part2.json --port fault:tpa-missing
  [ "$status" -eq 1 ]
  has "because fault:tpa-missing is not the port of the reports: its files have other bytes"
  lacks "name the port with --port"
  run "$ATTEST" merge part1.json part2.json --port lib:./moved.so --json merged.json
  [ "$status" -eq 1 ]
  cmp all.json merged.json
}

@test "each machine may have the port in another folder" {
  mkdir here there
  cp "$PORTS/port_sign_flip.so" here/mine.so
  cp here/mine.so there/mine.so
  "$ATTEST" run here/mine.so "${selected[@]}" --shard 1/2 --json part1.json || true
  (cd there && "$ATTEST" run mine.so "${selected[@]}" --shard 2/2 --json ../part2.json) || true
  run "$ATTEST" merge part1.json part2.json
  [ "$status" -eq 1 ]
  has "it looks like"
  cp "$PORTS/port_other_profiles.so" there/mine.so
  (cd there && "$ATTEST" run mine.so "${selected[@]}" --shard 2/2 --json ../part2.json) || true
  run "$ATTEST" merge part1.json part2.json
  [ "$status" -eq 2 ]
  has "the hash of the port is"
}

@test "a port that gets other arguments is another port" {
  cp "$PORTS/port_sign_flip.so" mine.so
  shards lib:./mine.so 2
  while read -r expected one other; do
    sed "s#lib:./mine.so#proc:./x/port $one#" part1.json >p1.json
    sed "s#lib:./mine.so#proc:./port $other#" part2.json >p2.json
    run "$ATTEST" merge p1.json p2.json
    [ "$status" -eq "$expected" ]
    case $status in
      2) has "the port is \`proc:port $other\`, but in p1.json it is \`proc:port $one\`" ;;
      1) has "FAIL" ;;
    esac
  done <<'PORTS'
2 runs/a runs/b
2 --gains=a/x.csv --gains=b/x.csv
1 a/x.csv b/x.csv
PORTS
}

@test "reports that claim more than they can are refused" {
  shards builtin 2
  sed 's/"released": true/"released": false/' part1.json >p1.json
  sed 's/"released": true/"released": false/' part2.json >p2.json
  run "$ATTEST" merge p1.json p2.json --json merged.json  # it is known from the suite
  cmp all.json merged.json
  sed 's#"shard": "1/2"#"shard": "1/18446744073709551615"#' part1.json >many.json
  run timeout 20 "$ATTEST" merge many.json
  [ "$status" -eq 2 ]
  has "missing: the report of shard 2/18446744073709551615 and 18446744073709551613 more"
  "$PYTHON" - <<'P'
import json
report = json.load(open("part2.json"))
report["port"]["lacks"] = ["vehicle_rates_setpoint.roll"]
json.dump(report, open("fewer.json", "w"))
P
  run "$ATTEST" merge part1.json fewer.json
  [ "$status" -eq 2 ]
  has "fewer.json: the declaration of the port is"
}

@test "a report that contradicts itself is refused by its name" {
  shards fault:tpa-missing 2
  "$PYTHON" - <<'P'
import json
def write(file, **changed):
    json.dump(dict(report, **changed), open(file, "w"))
report = json.load(open("part1.json"))
passing = [r for r in report["results"] if r["verdict"] != "fail"]
write("fewer.json", results=passing)
write("consistent.json", results=passing, totals=dict(report["totals"], fail=0))
P
  run "$ATTEST" merge fewer.json part2.json --json merged.json
  [ "$status" -eq 2 ]
  has "fewer.json: contradicts itself: its totals have"
  run "$ATTEST" merge consistent.json part2.json --json merged.json
  [ "$status" -eq 2 ]
  has "consistent.json: contradicts itself:"
  has "vectors were selected, but it has"
  [ ! -e merged.json ]
}

# edited CODE: the report in edited.json is that of fails.json, changed by the Python statements.
# `result` is the first failing vector, `other` one that passed, `becomes` changes its verdict.
edited() {
  "$PYTHON" - "$1" <<'P'
import json, sys
report = json.load(open("fails.json"))
results, totals = report["results"], report["totals"]
result = next((r for r in results if r["verdict"] == "fail"), results[0])
other = next(r for r in results if r["verdict"] == "pass")

def becomes(verdict, **members):
    totals[result["verdict"]] -= 1
    totals[verdict] += 1
    for member in ("first", "worst", "metrics"):
        result.pop(member, None)
    result.update(dict(verdict=verdict, reason="", deviating_ticks=0), **members)

exec(sys.argv[1])
json.dump(report, open("edited.json", "w"))
P
}

# refused MESSAGE: by `merge` and by `run --rerun-failed`.
refused() {
  for command in "merge edited.json --json merged.json" "run --rerun-failed edited.json"; do
    # shellcheck disable=SC2086
    run "$ATTEST" $command
    echo "$command: $status"
    [ "$status" -eq 2 ]
    has "edited.json: "
    has "$1"
    [ ! -e merged.json ]
  done
}

@test "an edited verdict is refused, and the vector and the contradiction are named" {
  "$ATTEST" run --group tpa --rate 250 --port fault:tpa-missing --no-diagnose --json fails.json \
    >/dev/null || true
  edited 'totals["fail"] -= 1; totals["pass"] += 1; result["verdict"] = "pass"'
  refused "contradicts itself: px4-v1.5.5/tpa/"
  refused "@250hz has the verdict pass, but has a deviation"
  edited 'becomes("pass", deviating_ticks=12)'
  refused "has the verdict pass, but has 12 deviating ticks"
  edited 'becomes("unsupported", deviating_ticks=12)'
  refused "has the verdict unsupported, but has 12 deviating ticks"
  edited 'becomes("pass", reason="the process died")'
  refused 'has the verdict pass, but has the reason `the process died`'
  edited 'becomes("pass", ticks=0)'
  refused "has the verdict pass, but has no tick that was compared"
  channel=out/vehicle_rates_setpoint.roll
  edited "becomes('pass', tightest={'ratio': 0.5, 'tick': 1, 'channel': '$channel'})"
  refused "has the verdict pass, but has a headroom of 0.5, below 1"
  edited 'result["first"]["tolerance"] = -1'
  refused "has a tolerance of -1"
  edited 'result["first"]["tolerance"] = "nan"'
  refused "has a tolerance of nan"
  edited 'result["applies"] = False'
  refused "does not apply to the port, and the verdict is fail"
  edited 'report["not_run"] = [dict(profile="px4-v1.5.5", group="tpa", rate="250", vectors=3)]'
  refused "and 3 were not run"
  edited 'result["rate"] = "333"; result["id"] = result["id"].replace("@250hz", "@333hz")'
  refused '@333hz is at 333 Hz, which `rates` does not have'
  edited 'result.update(name=other["name"])'
  refused "has the members of"
  edited 'result.update(other); totals["fail"] -= 1; totals["pass"] += 1'
  refused "twice"
  edited 'report["limits"]["timeout_s"] = "nan"'
  refused '`timeout_s` is nan'
  edited 'report["limits"]["file_mib"] = -1'
  refused '`limits.file_mib` is not a count'
  # What the suite contradicts.
  edited 'becomes("skip", exact_only=True)'
  refused "is skipped as a vector of the exact level, but its case is compared at every level"
  edited 'result.update(name="bent", id="px4-v1.5.5/tpa/bent@250hz")'
  refused "px4-v1.5.5/tpa/bent@250hz is no vector of the suite"
  edited 'for result in [r for r in results if r["verdict"] == "fail"]: becomes("pass")'
  run "$ATTEST" merge edited.json
  [ "$status" -eq 2 ]
  has 'edited.json: contradicts itself: it states `partial: px4-v1.3.4'
  has 'none: px4-v1.5.5'
  has ', but its results give `partial: '
  edited 'report["conformant"] = True'
  refused 'and `conformant`, but its results give `partial: '
}

@test "a pass of a flight whose metric is out of its bounds is refused" {
  "$ATTEST" run --filter '*/hover@250hz-iris-ode' --no-diagnose --json fails.json >/dev/null
  edited 'result["metrics"][0]["value"] = 1e6'
  refused "out of its bounds"
  edited 'result["metrics"][0]["max"] = "nan"'
  refused "has impossible bounds of the metric"
}

@test "what failed in the last run in a folder is run again" {
  run "$ATTEST" run --last-failed
  [ "$status" -eq 2 ]
  has "no vector failed in the last \`attest run\` in this folder"
  run "$ATTEST" run "${selected[@]}" --port fault:tpa-missing
  failed=$(grep -oE 'FAIL [0-9]+ of' <<<"$output")
  # A run that judged nothing is no last run.
  run "$ATTEST" run --profile v1.5.5 --rate 250 --port "lib:$PORTS/port_other_profiles.so"
  [ "$status" -eq 2 ]
  run "$ATTEST" run --last-failed --port fault:tpa-missing
  [ "$status" -eq 1 ]
  has "$failed ${failed//[^0-9]/} vectors failed, 0 passed"
  mkdir other
  cd other
  run "$ATTEST" run --last-failed
  [ "$status" -eq 2 ]
  cd ..
  run "$ATTEST" run --last-failed
  [ "$status" -eq 0 ]
  has "only --last-failed"
  run "$ATTEST" run --last-failed
  [ "$status" -eq 2 ]
}

@test "what failed in a report is run again" {
  run "$ATTEST" run "${selected[@]}" --port fault:tpa-missing --json all.json
  failed=$(grep -c '"verdict": "fail"' all.json)
  run "$ATTEST" run --port fault:tpa-missing --rerun-failed all.json
  [ "$status" -eq 1 ]
  has "$failed of $failed vectors failed, 0 passed"
  run "$ATTEST" run --rerun-failed all.json
  [ "$status" -eq 0 ]
  has "$failed vectors passed, 0 failed"
  run "$ATTEST" run --rerun-failed all.json --group attitude
  [ "$status" -eq 2 ]
  has "all.json: no selected vector failed in it; run without --rerun-failed"
  run "$ATTEST" run --rerun-failed all.json --json all.json
  [ "$status" -eq 2 ]
  has "all.json"
  run "$ATTEST" run --rerun-failed all.json --timing t.json
  [ "$status" -eq 2 ]
  has "leave out all other selections"
  cat >known.toml <<'T'
[expected]
"px4-v1.5.5/tpa/each_axis" = "not ported"
"px4-v1.5.5/rates/p_alone" = "not ported"
T
  # The second entry names nothing that was run, which is an error of a complete run only.
  run "$ATTEST" run --port fault:tpa-missing --rerun-failed all.json --expected-failures known.toml
  [ "$status" -eq 1 ]
  run "$ATTEST" run --rerun-failed "$SOURCE/README.md"
  [ "$status" -eq 2 ]
  has "README.md:1:1: is not JSON from here on"
  echo '{"schema": "attest-report-2"}' >other.json
  run "$ATTEST" run --rerun-failed other.json
  [ "$status" -eq 2 ]
  has "is no report of \`attest run --json\`"
}

@test "a JSON file that was cut, spoilt or joined is an error with its place" {
  "$ATTEST" run --group tpa --rate 250 --json all.json >/dev/null
  head -c 1000 all.json >cut.json
  last=$(($(wc -l <cut.json) + 1))
  : >empty.json
  sed '3s/:/=/' all.json >spoilt.json
  sed '2s/.*/&\n  "port": {},/' all.json >joined.json
  for wrong in "cut.json:$last:[0-9]*: ends inside of the JSON: it is empty or was cut off" \
    "empty.json:1:1: ends inside of the JSON" "spoilt.json:3:[0-9]*: is not JSON from here on" \
    "joined.json:[0-9]*:3: has \`port\` twice in one object"; do
    for command in merge "run --rerun-failed" "run --timing"; do
      run "$ATTEST" $command "${wrong%%:*}"
      [ "$status" -eq 2 ]
      grep -q "attest: error: $wrong" <<<"$output" || { echo "$output" && return 1; }
    done
  done
}

@test "what failed is run again at the same level and with the same parameters only" {
  tpa=(--port fault:tpa-missing --profile px4-v1.5.5 --group tpa --rate 250 --no-diagnose)
  run "$ATTEST" run "${tpa[@]}" --level exact --param MC_ROLLRATE_P=0.31 --json report.json
  [ "$status" -eq 1 ]
  for other in "" "--level exact" "--level exact --param MC_ROLLRATE_P=0.3"; do
    run "$ATTEST" run "${tpa[@]}" --rerun-failed report.json $other
    [ "$status" -eq 2 ]
    has "report.json: is of a run with --level exact --param MC_ROLLRATE_P=0.31, this one is with"
  done
  run "$ATTEST" run "${tpa[@]}" --rerun-failed report.json --level exact --param MC_ROLLRATE_P=0.31
  [ "$status" -eq 1 ]
}

@test "GitHub gets annotations and a job summary, GitLab a code quality report" {
  run env GITHUB_STEP_SUMMARY="$PWD/step.md" "$ATTEST" run "${selected[@]}" \
    --port fault:tpa-missing --github --code-quality quality.json
  [ "$status" -eq 1 ]
  [ "$(grep -c '^::error ' <<<"$output")" -eq 10 ]
  # The summary, which has words of the port, is between two lines with its hash.
  word=$(sed -n 's/^::stop-commands:://p' <<<"$output")
  [ "$(grep -c "^::$word::\$" <<<"$output")" -eq 1 ]
  [ "$(grep -c '^::warning ' <<<"$output")" -eq 1 ]
  has "::error title=fail px4-v1.5.5/tpa/"
  grep -q '^### attest: FAIL' step.md
  grep -q 'tpa-missing' step.md
  "$PYTHON" - <<'P'
import json
entries = json.load(open("quality.json"))
assert len({e["fingerprint"] for e in entries}) == len(entries) > 5
assert all(e["severity"] == "major" for e in entries)
P
}
