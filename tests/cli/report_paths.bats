load common

# kept FILE COMMAND...: the command writes FILE, a report or trace. Its port replaces FILE during
# the run, by a pipe without a reader or by a link to ./victim. KILL ends a command that opens the
# pipe. "{}" in COMMAND is FILE.
kept() {
  local file=$1 kind
  shift
  mkdir -p out # a port can make no file next to a trace that it replays
  for kind in pipes links; do
    rm -f "$file"
    MEDDLE_WITH="$PWD/victim=$file" run timeout -s KILL 60 "$ATTEST" "${@//\{\}/$file}" \
      --port "lib:$PORTS/hostile_$kind.so"
    echo "$kind: $*: $status"
    [ "$status" -le "${most:-0}" ]
    [ -f "$file" ] && [ ! -L "$file" ] && [ -s "$file" ]
    [ "$(<victim)" = "kept" ]
  done
}

@test "a port cannot turn a report into a pipe, or redirect it by a link" {
  echo kept >victim
  flight=(--rate 250 --vehicle iris --plant ode)
  vector=(--filter "px4-v1.5.5/rates/p_alone@250hz")
  "$ATTEST" record px4-v1.5.5/rates/p_alone --rate 250 --out right.csv
  for option in --json --junit --html --badge; do
    kept out/report run "${vector[@]}" $option {}
  done
  for option in --json --html; do
    kept out/report replay right.csv $option {}
    kept out/report time "${vector[@]}" --repeat 1 $option {}
  done
  kept out/report time "${vector[@]}" --repeat 1 --worst {}
  for file in out/flown.csv out/flown.ulg; do
    kept $file record px4-v1.5.5/rates/p_alone --rate 250 --out {}
    kept $file sim tilt_step_30 "${flight[@]}" --out {}
  done
  kept out/report sim tilt_step_30 "${flight[@]}" --html {}
  for option in --csv --html; do
    kept out/report sweep-rate "${flight[@]}" $option {}
  done
}

@test "a report of a flight in real time is not redirected" {
  echo kept >victim
  for option in --json --junit --html --record-timing; do
    most=2 kept out/report stress --rate 250 --duration 0.2 --no-cyclictest \
      --policy other $option {}
  done
}

@test "a port cannot redirect saved traces" {
  blessed_suite
  mkdir elsewhere
  MEDDLE_WITH="$PWD/elsewhere=saved/px4-v1.5.5" run timeout -s KILL 60 "$ATTEST" --suite suite run \
    --rate 250 --port "lib:$PORTS/hostile_wrong_links.so" --save-traces saved --no-diagnose \
    --in-process
  [ "$status" -ne 0 ]
  has "saved/px4-v1.5.5: is a link, which attest did not make"
  [ -z "$(ls -A elsewhere)" ]
}

@test "a pipe without a reader is an error, and one with a reader is written" {
  mkfifo pipe
  run timeout -s KILL 60 "$ATTEST" sim gust --rate 250 --html pipe
  [ "$status" -eq 2 ]
  has "pipe: cannot write the file: No such device or address"
  cat pipe >page.html 3>&- &
  "$ATTEST" sim gust --rate 250 --html pipe
  wait
  tail -c 8 page.html | grep -q "</html>"
}
