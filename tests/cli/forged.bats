load common

# Ports that answer in place of their process. Their comments are in tests/ports/hostile.

# judged PORT: runs it on two vectors of each case, the second of them forged.
judged() {
  run "$ATTEST" run --port "lib:$PORTS/hostile_forged_$1.so" --filter 'px4-v1.5.5/rates/*@250hz' \
    --filter 'px4-v1.5.5/rates/*@100hz' --json report.json --badge badge.svg --no-diagnose "${@:2}"
}

is_no_conformance() {
  grep -q '"conformant": false' report.json
  lacks '"exact_only"'
  grep -q "partial\|does not conform" badge.svg
}

@test "a port cannot answer that it lacks a profile that it had when it was described" {
  judged skip
  [ "$status" -eq 1 ]
  has 'protocol: create("px4-v1.5.5") returned NULL; it made a unit when the port was asked first'
  lacks " skip"
  is_no_conformance
}

@test "an answer that is only a fault does not skip a vector" {
  judged skips_alone
  [ "$status" -eq 1 ]
  has "protocol: the port wrote on the socket on which its process answers"
  lacks " skip"
  is_no_conformance
}

@test "an answer cannot have a fault that only the judge finds" {
  judged unanswered
  [ "$status" -eq 1 ]
  has "8 protocol"
  lacks " skip"
  is_no_conformance
}

@test "unsupported with the reason of a good skip makes the port partial" {
  judged unsupported
  [ "$status" -eq 0 ]
  has " vectors unsupported (rates)"
  is_no_conformance
}

@test "a merged report has good skips by their flag, not by their text" {
  for part in 1 2; do
    "$ATTEST" run --filter 'px4-v1.5.5/large_angle/*@250hz' --shard $part/2 --json $part.json
  done
  "$ATTEST" merge 1.json 2.json --json merged.json
  [ "$(grep -c '"exact_only": true' merged.json)" -eq 4 ]
  grep -v '"exact_only"' 2.json >edited.json
  run "$ATTEST" merge 1.json edited.json
  has "skipped (large_angle)"
}

@test "what a port declares is in its range" {
  judged bits
  [ "$status" -eq 2 ]
  has '`says.fraction_bits` is -60; it must be from 16 to 32'
  judged step
  [ "$status" -eq 2 ]
  has '`says.fixed_step` is wrong: `-250` is not a rate'
  judged modules
  [ "$status" -eq 2 ]
  has '`says.modules` is 255; it must be at most 127'
}

@test "what a port declared before the run holds for the whole run" {
  judged bits_later
  [ "$status" -eq 1 ]
  has 'its attest.arithmetic is `fixed:20`, it was `none` when the port was asked first'
  is_no_conformance
  rm loaded
  judged name_later
  [ "$status" -eq 1 ]
  has 'protocol: the port wrote on the socket on which its process answers: `name` has a character'
  is_no_conformance
}
