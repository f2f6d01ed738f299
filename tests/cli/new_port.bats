load common

setup_file() {
  export PYTHONDONTWRITEBYTECODE=1
}

# made LANGUAGE TOOL [GROUP]: a new port of that language conforms to a group, by its own check.
made() {
  local group=${3:-rates}
  command -v "$2" >/dev/null || skip "no $2"
  run "$ATTEST" new-port mine --lang "$1"
  [ "$status" -eq 0 ]
  has "mine/check"
  cp "$ATTEST" attest
  export ATTEST_SUITE=$SOURCE PATH=$PWD:$PATH
  run mine/check --group "$group" --rate 250
  [ "$status" -eq 0 ]
  has "PASS"
  # Paths are relative to the folder in which check was called, those of the report too.
  run mine/check --group "$group" --rate 250 --html report.html --json report.json
  [ "$status" -eq 0 ]
  [ -s report.html ]
  grep -q '"specification": ".*mine/' report.json
  grep -q "uses: ./.github/actions/attest" mine/.github/workflows/attest.yml
  grep -q "./check --github" mine/.github/actions/attest/action.yml
  grep -q "./check --html" mine/.gitlab-ci.yml
  [ -x mine/install-attest ]
  # Only what `new-port` made is there for git.
  mkdir mine/reports  # as the CI job does
  touch mine/reports/attest.html
  git init -q mine
  local made='\.(so|o|elf|pyc)$|/(build|target)/|reports/|board$'
  [ -z "$(git -C mine status --short -uall | grep -E "$made")" ]
}

@test "a new port in C" { made c cc; }
@test "a new port in C of the cascade" {
  made c_cascade cc
  has "partial: px4-v1.16.0, "
  lacks "px4-v1.5.5"
}
@test "a new port in C of the two laws alone" {
  made c_law cc rate_law
  has "conformant: rate_law of px4-v1.18 "
  has "the port does not support profile px4-v1.5.5"
}
@test "a new port in C++" { made cpp c++; }
@test "a new port in Python" { made python python3; }
@test "a new port in Python of the cascade" {
  made python_cascade python3
  has "partial: px4-v1.16.0, "
  lacks "px4-v1.5.5"
}
@test "a new port in Python of the two laws alone" {
  made python_law python3 rate_law
  has "conformant: rate_law of px4-v1.18 "
  has "the port does not support profile px4-v1.5.5"
}
@test "a new port in Octave of the two laws alone" {
  made octave octave-cli rate_law
  has "conformant: rate_law of px4-v1.18 "
  has "the port does not support profile px4-v1.5.5"
}
@test "a new port in Rust" { made rust cargo; }
@test "a new port of a Simulink model" { made simulink cc; }

@test "nothing is overwritten, and a typo gets a suggestion" {
  run "$ATTEST" new-port mine --lang pyton
  [ "$status" -eq 2 ]
  has "no starter in \`pyton\`; did you mean \`python\`?"
  has "; there are c, c_cascade, c_law, cortex_m, cpp, octave, python, "
  has ", python, python_cascade, python_law, rust, serial_board, simulink"
  [ ! -e mine ]
  run "$ATTEST" new-port mine --lang c++
  [ "$status" -eq 2 ]
  has "no starter in \`c++\`; did you mean \`cpp\`?"
  mkdir mine
  echo mine >mine/file
  run "$ATTEST" new-port mine --lang c
  [ "$status" -eq 2 ]
  has "mine: exists; name a new folder"
  [ "$(ls mine)" = file ]
  run "$ATTEST" new-port file/below --lang c
  [ "$status" -eq 0 ]
  run "$ATTEST" new-port slash/ --lang c
  [ "$status" -eq 0 ]
  [ -x slash/check ]
  [ "$(ls -d slash*)" = slash ]
  run "$ATTEST" new-port mine/file/below --lang c
  [ "$status" -eq 2 ]
  has "mine/file/below: cannot be made"
}

@test "check and new-port say which tool is missing" {
  mkdir bin
  for tool in sh dirname; do ln -s "$(command -v $tool)" bin; done
  PATH=$PWD/bin run "$ATTEST" new-port mine --lang python
  [ "$status" -eq 0 ]
  has "note: python3 is not installed; mine/packages.txt names its package"
  PATH=$PWD/bin run mine/check
  [ "$status" -eq 2 ]
  has "check: python3 is missing: change PATH, or install it"
  PATH=$PWD/bin run "$ATTEST" new-port laws --lang octave
  [ "$status" -eq 0 ]
  has "note: octave-cli is not installed; laws/packages.txt names its package"
  PATH=$PWD/bin run laws/check
  [ "$status" -eq 2 ]
  has "check: octave-cli is missing: change PATH, or install it"
}
