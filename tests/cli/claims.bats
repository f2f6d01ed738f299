load common

# value EXPRESSION: prints its value for the report `r`.
value() { python3 -c "import json; r = json.load(open('report.json')); print($1)"; }

@test "attest knows the suite of this tree as the released one" {
  hash=$("$SOURCE/ci/suite-hash")
  [ "$hash" = "$(cat "$SOURCE/golden/SUITE.sha256")" ] || {
    echo "cases or goldens have changed: ci/suite-hash --write, and build"
    return 1
  }
  "$ATTEST" run --group tpa --rate 250 --json report.json >/dev/null
  [ "$(value 'r["suite"]["sha256"]')" = "$hash" ]
  [ "$(value 'r["suite"]["released"]')" = True ]
}

@test "a case of one's own is a custom suite, and never conformant" {
  blessed_suite
  run "$ATTEST" --suite suite run --json report.json --badge badge.svg
  [ "$status" -eq 0 ]
  has "conformance: partial: px4-v1.5.5, numeric, 11 rates, all groups (because: custom suite)"
  [ "$(value 'r["conformant"]')" = False ]
  grep -q "px4-v1.5.5 numeric, partial" badge.svg
  cp -r "$SOURCE/golden/SUITE.sha256" suite/golden/ # has no effect
  run "$ATTEST" --suite suite run --json report.json
  has "custom suite"
}

@test "a filter gives a partial result that says so, in every report" {
  run "$ATTEST" run --group tpa --rate 250 --json report.json --junit junit.xml --badge badge.svg
  [ "$status" -eq 0 ]
  has "partial: px4-v1.5.5, numeric, 1 rate, group tpa (because: only --group tpa --rate 250;"
  has "no vector at 10 rates; "
  [ "$(value 'r["conformant"]')" = False ]
  [ "$(value '[c["profile"] for c in r["claims"]]')" = "['px4-v1.3.4', 'px4-v1.5.5']" ]
  grep -q 'name="conformance" value="partial: ' junit.xml
  grep -q "numeric, partial" badge.svg
  must_fail grep -q "#3a7d34" badge.svg
}

# hash_of_program SHARD: of the port in the report of that half of a run of ./port.py.
hash_of_program() {
  "$ATTEST" run --filter 'tpa/*@250hz' --shard "$1/2" --no-diagnose --json report.json \
    --port "proc:$PYTHON -B port.py $SOURCE/README.md --no-such-file" >/dev/null
  cp report.json "part$1.json"
  value 'r["port"]["sha256"]'
}

@test "the hash of a program covers all files that its command names" {
  echo "import sys; sys.path.insert(0, '$SOURCE/controller/starters/python')" >port.py
  # The files that the handshake names come after these.
  echo "import port; port.files_of_program = lambda: []; port.main()" >>port.py
  before=$(hash_of_program 1)
  [ "$before" = "$(sha256sum "$PYTHON" port.py "$SOURCE/README.md" | cut -d ' ' -f 1 |
    sha256sum | cut -d ' ' -f 1)" ]
  [ "$before" = "$(hash_of_program 2)" ]
  "$ATTEST" merge part1.json part2.json
  echo "# another version" >>port.py
  [ "$before" != "$(hash_of_program 2)" ]
  run "$ATTEST" merge part1.json part2.json
  [ "$status" -eq 2 ]
  has "part2.json"
}

@test "the reports name the port's file, the suite and the day" {
  run "$ATTEST" run --group tpa --rate 250 --port "lib:$STARTER" --json report.json \
    --junit junit.xml
  [ "$status" -eq 0 ]
  port=$(sha256sum "$STARTER" | cut -d ' ' -f 1)
  has "port ${port:0:12}, 2026-03-31"
  has "(released suite $(cut -c 1-12 "$SOURCE/golden/SUITE.sha256"))"
  [ "$(value 'r["port"]["sha256"]')" = "$port" ]
  [ "$(value 'r["date"]')" = 2026-03-31 ]
  grep -q "name=\"port.sha256\" value=\"$port\"" junit.xml
  SOURCE_DATE_EPOCH=today run "$ATTEST" run --group tpa --rate 250
  [ "$status" -eq 2 ]
  has 'SOURCE_DATE_EPOCH is `today`'
}

@test "unsupported groups and expected failures make a result partial" {
  run "$ATTEST" run --group tpa --group tailsitter --rate 250 \
    --port "lib:$PORTS/port_no_tailsitter.so"
  [ "$status" -eq 0 ]
  has "vectors unsupported (tailsitter)"
  "$ATTEST" run --group tpa --rate 250 --port fault:tpa-missing --no-diagnose \
    --write-expected known.toml >/dev/null || true
  run "$ATTEST" run --group tpa --rate 250 --port fault:tpa-missing --expected-failures known.toml
  has "expected failure"
  has "px4-v1.5.5, numeric, 1 rate"
}

@test "a port in its judge's process is held by nothing, and conforms to nothing" {
  run "$ATTEST" run --in-process --rate 250 --json report.json
  has "port not isolated: --in-process"
  [ "$(value 'r["limits"]')" = "{'own_process': False}" ]
  [ "$(value 'r["conformant"]')" = False ]
  run "$ATTEST" run --group tpa --rate 250 --timeout 3 --json report.json
  [ "$(value 'r["limits"]["own_process"], r["limits"]["timeout_s"]')" = "True 3.0" ]
}
