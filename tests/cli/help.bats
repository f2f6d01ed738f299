load common

commands=(run hunt replay sim stress sweep sweep-rate schedule time compare plot record faults list
  vectors bless new-port doctor smoke)

@test "each command shows examples of itself, with options that it has" {
  for command in "${commands[@]}"; do
    run "$ATTEST" "$command" --help
    [ "$status" -eq 0 ]
    has "Examples:"
    lacks "First steps"
    lacks "{false}"
    examples=$(sed -n '/^Examples:/,$p' <<<"$output" | grep '^  attest')
    [ -n "$examples" ]
    while read -r line; do
      [[ $line == "attest $command"* ]]
      # --suite is an option of attest itself.
      for option in $(grep -oE -- '--[a-z0-9-]+' <<<"$line" | grep -vx -- --suite); do
        grep -qE -- "^ +(-j,)?([a-z0-9,-]*,)?$option([ ,=]|$)" <<<"$output" || {
          echo "$command: $option"
          false
        }
      done
    done <<<"$examples"
  done
}

@test "help COMMAND is the help of the command" {
  for command in "${commands[@]}"; do
    [ "$("$ATTEST" help "$command")" = "$("$ATTEST" "$command" --help)" ]
  done
  [ "$("$ATTEST" help)" = "$("$ATTEST" --help)" ]
  run "$ATTEST" help rnu
  [ "$status" -eq 2 ]
  has 'unknown command `rnu`; did you mean `run`?'
}

@test "a misspelt option, case or rate gets a suggestion" {
  run "$ATTEST" run --fitler 'rates/*'
  [ "$status" -eq 2 ]
  has 'unknown option `--fitler`; did you mean `--filter`?; attest run --help shows them'
  run "$ATTEST" stress --seconds 3
  [ "$status" -eq 2 ]
  has "unknown option \`--seconds\`; did you mean \`--duration\`?"
  run "$ATTEST" sim hoover --rate 250 --out f.csv
  [ "$status" -eq 2 ]
  has 'no case matches `hoover`; did you mean `hover`?'
  run "$ATTEST" record sticks/yaw_stick_curve --profile v1.14.4
  [ "$status" -eq 2 ]
  has 'no case with --profile px4-v1.14.4 matches `sticks/yaw_stick_curve`; `attest list` shows'
  run "$ATTEST" run --group attitude --filter 'rates/*'
  [ "$status" -eq 2 ]
  has 'no case with --group attitude matches `rates/*`'
}

@test "what only another command takes is answered with what this one has" {
  cp "$STARTER" mine.so
  touch check
  make_suite
  "$ATTEST" new-port made --lang c
  while read -r command hint; do
    run "$ATTEST" ${command//+/ }
    [ "$status" -eq 2 ]
    has "$hint"
  done <<'HINTS'
stress+hover hover is a case, not a port; write: attest stress --case hover
run+p_alone p_alone is a case, not a port; write: attest run --filter p_alone
run+suite/cases/px4-v1.5.5/attitude/roll.toml write: attest --suite suite run --filter attitude/roll
run+made/check+--rate+250 made/check builds a port and runs attest itself: start it
smoke+hover hover is a case, not a port
list+faults too many arguments: `faults`; `attest faults --list` lists them
list+--faults `attest faults --list`
plot+--out+F+a.csv the page is --html F
hunt+--rate+250 a hunt varies the rate itself
mine.so did you mean `attest run mine.so`?
compare+mine.so+mine.so mine.so: is a library or program, not a trace; `attest run` runs a port
record+--rate+250+--case --case needs a value
record+mine.so+--rate+250 attest record needs CASE
sim+mine.so needs a case, or --timing
sim+hover+--case+hover the case is given twice, with --case and as the first argument
sim+--rate+250+mine.so+hover a case, not a port; write: attest sim --case hover --port mine.so
stress+mine.so+hover too many arguments: `hover`; --case chooses the flight
sim+saturation `saturation` is a group of cases; name one of them: `attest list --group saturation`
run+--port+mine.so+hover the port is given twice, as an argument and with --port; --filter
run+mine.so+hover too many arguments: `hover`; --filter chooses cases
run+--case+hover unknown option `--case`; --filter chooses cases
run+./port.so ./port.so: no such file; build it, as the script ./check does
list+attitude too many arguments: `attitude`; --group and --filter choose cases
new-port+mine+-l+c unknown option `-l`; attest new-port --help shows them
HINTS
}

@test "the beginning of a version is enough, if only one profile has it" {
  for version in v1.16 px4-v1.16 v1.16.0; do
    run "$ATTEST" list --profile $version --group rates
    [ "$status" -eq 0 ]
    has "px4-v1.16.0/rates/"
    lacks "px4-v1.5.5"
  done
  run "$ATTEST" list --profile v1
  [ "$status" -eq 2 ]
  has "no cases of profile \`v1\`"
}

@test "attest version is the same as --version" {
  run "$ATTEST" --version
  local version=$output
  run "$ATTEST" version
  [ "$status" -eq 0 ]
  [ "$output" = "$version" ]
}

@test "attest alone begins with new-port" {
  run "$ATTEST"
  [ "$status" -eq 2 ]
  [[ $(grep -m1 '^  attest ' <<<"$output") == "  attest new-port "* ]]
  run "$ATTEST" $(sed -nE '/new-port/s/^  attest (.*[^ ])  +.*/\1/p' <<<"$output")
  [ "$status" -eq 0 ]
  [ -x mine/check ]
}

@test "--rate and --rates are one option" {
  for option in --rate --rates; do
    run "$ATTEST" run --group tpa --profile px4-v1.5.5 "$option" 250,500
    [ "$status" -eq 0 ]
    has "2 rates)"
  done
}

@test "excluded cases are not run, and the result is partial" {
  run "$ATTEST" run --group rates --profile px4-v1.5.5 --rate 250 --exclude '*_alone' --json r.json
  [ "$status" -eq 0 ]
  lacks "conformant"
  grep -q '"conformant": false' r.json
  [ "$(grep -c '"id": .*_alone' r.json)" -eq 0 ]
  has "--exclude"
}

@test "a suite that was named is in the command that reproduces a failure" {
  blessed_suite
  run "$ATTEST" --suite suite run --port "lib:$PORTS/port_sign_flip.so" --no-diagnose
  [ "$status" -eq 1 ]
  has "reproduce: attest --suite suite run --port"
}

@test "each command has a manual page, in the form that man reads" {
  "$ATTEST" help --man pages
  all=$("$ATTEST" help | sed -n '/^Subcommands:/,/^$/p' | grep -c '^  [a-z]')
  [ "$(ls pages | wc -l)" -eq "$((all + 1))" ]
  for command in "${commands[@]}"; do
    page=pages/attest-$command.1
    head -n 1 "$page" | grep -q '^\.TH ATTEST'
    options=$("$ATTEST" help "$command" | grep -oE '^  (-[a-z],)?--[a-z0-9-]+')
    for option in $(grep -oE -- '--.*' <<<"$options"); do
      grep -qF -- "$(sed 's/-/\\-/g' <<<"$option")" "$page"
    done
  done
  command -v groff >/dev/null || skip "groff is not installed"
  [ -z "$(groff -man -ww -Tutf8 pages/*.1 2>&1 >/dev/null)" ]
}

@test "attest(1) has each environment variable that attest reads" {
  "$ATTEST" help --man pages
  read=$(grep -roh 'getenv("[A-Z_]*"' "$SOURCE/harness" | sort -u | cut -d'"' -f2)
  [ "$(wc -w <<<"$read")" -ge 6 ]
  # The C++ library reads this one, for the folder of temporary files.
  documented=$(sed -n '/^\.SH ENVIRONMENT/,/^\.SH SEE/p' pages/attest.1 | grep -oE 'fB[A-Z_]+' |
    cut -c3-)
  [ "$(sort -u <<<"$documented")" = "$(printf '%s\n' $read TMPDIR | sort -u)" ]
}

# completed WORDS...: what the last of these words of a command line can become. Without the trap
# with which bats follows each command, because it takes seconds for lists of all cases.
completed() {
  output=$(
    trap - DEBUG
    COMP_WORDS=("$@") COMP_CWORD=$(($# - 1))
    PATH=$(dirname "$ATTEST"):$PATH _attest || true # its status is that of compgen
    printf '%s\n' "${COMPREPLY[@]}" | sort -u | xargs
  )
}

@test "bash completes commands, options, fixed values and names of the suite" {
  source <("$ATTEST" help --completion bash)
  completed attest ru
  [ "$output" = run ]
  completed attest run --rerun
  [ "$output" = --rerun-failed ]
  completed attest run --level ""
  [ "$output" = "events exact numeric" ]
  completed attest new-port mine --lang p
  [ "$output" = "python python_cascade python_law" ]
  completed attest run --group att
  [ "$output" = "attitude attitude_law" ]
  completed attest sim flip_150_lev
  [ "$output" = "flip_150_level" ]
  completed attest sim --profile px4-v1.1
  [ "$output" = "px4-v1.14.4 px4-v1.15.4 px4-v1.16.0 px4-v1.17 px4-v1.18" ]
  completed attest run --vehicle h
  [ "$output" = "heavy_quad hexa hummingbird" ]
  completed attest run --json ""
  [ -z "$output" ]
  completed attest help sm
  [ "$output" = smoke ]
  completed attest run --filter roll_p
  [ -n "$output" ]
  completed attest faults quat-order-s
  [ "$output" = "quat-order-setpoint quat-order-state" ]
  run "$ATTEST" help --completion fish
  [ "$status" -eq 2 ]
}

# Bash gives the function the words that it has split at colons, and replaces only the last of them.
@test "bash completes the kinds of port, and what follows their colon" {
  source <("$ATTEST" help --completion bash)
  COMP_WORDBREAKS=$' \t\n"\'@><=;|&(:'
  mkdir -p "my ports/old"
  touch "my ports/"{mine.so,notes.txt,program}
  chmod +x "my ports/program"
  completed attest smoke --port ""
  [ "$output" = "builtin fault: lib: proc: recorded:" ]
  completed attest run li
  [ "$output" = "lib:" ]
  completed attest run --port fault : tpa-m
  [ "$output" = tpa-missing ]
  completed attest run --port lib :
  [ "$output" = 'my ports/' ]
  completed attest run --port lib : 'my\ ports/'
  [ "$output" = 'my ports/mine.so my ports/old/' ]
  completed attest run --port proc : 'my\ ports/p'
  [ "$output" = 'my ports/program' ]
  completed attest run --port recorded : 'my\ ports/'
  [ "$output" = 'my ports/old/' ]
  completed attest run --port ./my # files are completed by the shell
  [ -z "$output" ]
}

@test "names of files are completed without being expanded" {
  make_suite
  cp suite/cases/px4-v1.5.5/attitude/{roll,'a$(touch pwned) "b'}.toml
  export ATTEST_SUITE=$PWD/suite
  source <("$ATTEST" help --completion bash)
  completed() {
    COMP_WORDS=("$@") COMP_CWORD=$(($# - 1))
    PATH=$(dirname "$ATTEST"):$PATH _attest || true
  }
  completed attest sim a
  [ "${#COMPREPLY[@]}" -eq 1 ]
  [ "${COMPREPLY[0]}" = 'a\$\(touch\ pwned\)\ \"b' ]
  completed attest sim 'a\$'
  [ "${#COMPREPLY[@]}" -eq 1 ]
  eval "name=${COMPREPLY[0]}"
  [ "$name" = 'a$(touch pwned) "b' ]
  [ ! -e pwned ]
}

@test "zsh completes the same, from the first time on" {
  command -v zsh >/dev/null || skip "zsh is not installed"
  "$ATTEST" help --completion zsh >_attest
  zsh -n _attest
  touch mine.so
  # A shell in a terminal of its own, whose first TAB loads the file.
  cat >tab.zsh <<'ZSH'
zmodload zsh/zpty
zpty -b shell 'TERM=dumb zsh -fi'
zpty -w shell "fpath=($PWD \$fpath); autoload -Uz compinit; compinit -u -D; print re''ady"
zpty -r -m shell line '*ready*'
zpty -w -n shell $'attest new-port mine --lang pyt\t'
zpty -r -m shell line '*--lang python*'
zpty -w -n shell $'\C-uattest ru\t'
zpty -r -m shell line '*attest run*'
zpty -w -n shell $'\C-uattest run --port fault:tpa-mis\t'
zpty -r -m shell line '*fault:tpa-missing*'
zpty -w -n shell $'\C-uattest run li\t./mi\t'
zpty -r -m shell line '*lib:./mine.so*'
zpty -w -n shell $'\C-uattest help smo\t'
zpty -r -m shell line '*help smoke*'
# Descriptions, one of them of a name with a colon.
zpty -w -n shell $'\C-uattest faults quat-order-s\t\t'
zpty -r -m shell line "*takes the setpoint's quaternion as x, y, z, w*"
zpty -w -n shell $'\C-uattest sim hover_\t\t'
zpty -r -m shell line "*-- *hover*"
zpty -w -n shell $'\C-uattest record --profile px4-v1.16\t'
zpty -r -m shell line '*px4-v1.16.0*'
print completed
zpty -d shell
ZSH
  PATH=$(dirname "$ATTEST"):$PATH run timeout 30 zsh -f tab.zsh
  has completed
}
