load common

@test "what fails is written down, filled in, and then accepted" {
  run "$ATTEST" run --port fault:tpa-missing --group tpa --rate 250 --write-expected known.toml
  [ "$status" -eq 1 ]
  grep -q "px4-v1.5.5/tpa/each_axis@250hz" known.toml  # the other rates were not seen to fail
  run "$ATTEST" run --port fault:tpa-missing --group tpa --write-expected all.toml
  grep -q "px4-v1.5.5/tpa/each_axis@\*" all.toml
  run "$ATTEST" run --port fault:tpa-missing --group tpa --rate 250 --expected-failures known.toml
  [ "$status" -eq 0 ]
  has "xfail: fail: say why this is accepted"
  has "partial: px4-v1.3.4, numeric, 1 rate, group tpa (because: "
}

@test "an expected failure that passes fails the run" {
  cat >known.toml <<'T'
[expected]
"px4-v1.5.5/tpa/each_axis" = "not ported"
T
  run "$ATTEST" run --group tpa --rate 250 --expected-failures known.toml
  [ "$status" -eq 1 ]
  has "xpass: expected to fail: not ported"
  echo '"px4-v1.5.5/tpa/each" = 3' >>known.toml
  run "$ATTEST" run --group tpa --expected-failures known.toml
  [ "$status" -eq 2 ]
  has "known.toml:3:"
}

@test "a run ends with what conforms, and a badge says it" {
  run "$ATTEST" run --group tpa --group rates --level exact --badge badge.svg
  [ "$status" -eq 0 ]
  cases=$(cat "$SOURCE/cases/VERSION") golden=$(cat "$SOURCE/golden/VERSION")
  has "px4-v1.5.5, exact, 11 rates, groups rates, tpa (because: only --group "
  has "cases $cases, golden $golden (released suite "
  grep -q "px4-v1.5.5 exact, partial" badge.svg
}

@test "a failure that is expected does not end a run that ends with the first" {
  cat >known.toml <<'T'
[expected]
"px4-v1.5.5/tpa/each_axis@*" = "not ported"
T
  run "$ATTEST" run --group tpa --rate 250 --port fault:tpa-missing --expected-failures known.toml \
    --fail-fast --no-diagnose
  [ "$status" -eq 1 ]
  has "stopped early"
}

@test "a run in which every failure is excused and no vector passed has no conclusion" {
  cat >known.toml <<'T'
[expected]
"px4-v1.5.5/rates/p_alone" = "not ported"
T
  run "$ATTEST" run --filter px4-v1.5.5/rates/p_alone@250hz --port "lib:$PORTS/port_silent.so" \
    --expected-failures known.toml
  [ "$status" -eq 2 ]
  has "NONE 0 vectors passed, 0 failed; 1 xfail"
  has "conformance: none: no vector passed"
  has "no vector passed: every selected vector was an expected failure, skipped or unsupported"
}

@test "an entry for a failure does not excuse a crash; one for a crash does" {
  selected=(--filter px4-v1.5.5/rates/p_alone@250hz --filter px4-v1.5.5/rates/d_alone@250hz)
  run "$ATTEST" run "${selected[@]}" --port "lib:$PORTS/port_silent.so" --write-expected known.toml
  grep -q "p_alone@250hz' = 'fail: say why" known.toml
  run "$ATTEST" run "${selected[@]}" --port "lib:$PORTS/port_crash.so" \
    --expected-failures known.toml
  [ "$status" -eq 1 ]
  has "the list of expected failures excuses fail here, not crash"
  for pattern in '*hz' 'px4-v1.5.5/[a-z]*'; do
    printf '[expected]\n"%s" = "x"\n' "$pattern" >all.toml
    run "$ATTEST" run "${selected[@]}" --expected-failures all.toml
    [ "$status" -eq 2 ]
    has "all.toml:2:1: \`$pattern\` would excuse every case of px4-"
  done
}
