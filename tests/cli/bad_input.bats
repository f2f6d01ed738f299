load common

# refused TEXT COMMAND...: it ends in bounded time and memory, with exit code 2 and that text.
refused() {
  local text=$1 memory=4000000
  shift
  ! nm "$ATTEST" | grep -q __asan_init || memory=unlimited # sanitizers reserve terabytes
  run timeout 30 bash -c "ulimit -v $memory"'; exec "$@"' - "$@"
  [ "$status" -eq 2 ] || {
    echo "status $status of: $*"
    echo "$output"
    return 1
  }
  has "$text"
}

@test "what is no regular file, or too large, is refused wherever a file is read" {
  mkfifo pipe
  truncate -s 10G sparse
  mkdir folder
  for file in pipe /dev/zero folder sparse; do
    refused "$file: " "$ATTEST" run --timing $file
    refused "$file: " "$ATTEST" run --group tpa --expected-failures $file
    refused "$file: " "$ATTEST" run --group tpa --port "lib:$file"
    refused "$file: " "$ATTEST" schedule $file
    refused "$file:" "$ATTEST" replay $file
    refused "$file:" "$ATTEST" compare $file $file
    [ $file = folder ] || refused "$file: " "$ATTEST" sim $file --rate 250 --out flown.csv
  done
}

@test "nested tables of any depth are an error, whatever file they are in" {
  make_suite
  deep=$(printf 'a.%.0s' $(seq 50000))a
  echo "[$deep]" >deep.toml
  refused "deep.toml:1:65: tables or arrays are nested" "$ATTEST" run --expected-failures deep.toml
  refused "deep.toml:1:65: tables or arrays are nested" "$ATTEST" schedule deep.toml
  echo "$deep = 1" >suite/cases/px4-v1.5.5/attitude/deep.toml
  refused "deep.toml:1:64: tables or arrays are nested" "$ATTEST" --suite suite run
}

@test "a file that may not grow is named, and the old one stays" {
  echo old >report.json
  for blocks in 0 1; do
    run bash -c "ulimit -f $blocks; exec \"$ATTEST\" run --group tpa --json report.json" \
      >/dev/null 2>&1
    [ "$status" -eq 2 ]
    has "report.json: cannot write the file: File too large (\`ulimit -f\`"
    [ "$(cat report.json)" = old ]
    run bash -c "ulimit -f $blocks; exec \"$ATTEST\" sim flight/hover --rate 250 --out flown.csv"
    [ "$status" -eq 2 ]
    has "flown.csv: cannot write the file: File too large"
    [ ! -e flown.csv ]
  done
  make_suite
  run bash -c "ulimit -f 0; exec \"$ATTEST\" --suite suite bless --yes --reason r"
  [ "$status" -eq 2 ]
  has ".csv.new: cannot write the file: File too large"
  [ -z "$(find suite -name '*.new')" ]
}

@test "without enough descriptors there is an error, and no verdict" {
  # With fewer than 5 descriptors the dynamic linker cannot load the program. Those of bats are
  # closed.
  for limit in 5 6 7 8 9 10 14; do
    code=0
    (
      exec 3>&- 4>&- 5>&- 6>&- 7>&- 8>&- 9>&-
      ulimit -n $limit
      exec "$ATTEST" run --group tpa --port "lib:$PORTS/port_sign_flip.so"
    ) >out.txt 2>&1 || code=$?
    output=$(cat out.txt)
    [ "$code" -eq 2 ]
    has "too few files can be opened"
    lacks "FAIL"
  done
}

@test "no report may overwrite what the command reads" {
  port=port.so
  cp "$PORTS/port_sign_flip.so" $port
  printf '[expected]\n"px4-v1.5.5/tpa/each_axis" = "known"\n' >known.toml
  ln -s known.toml link.toml
  before=$(cat $port known.toml | sha256sum)
  for target in $port known.toml ./link.toml; do
    for report in --json --junit --badge; do
      run "$ATTEST" run --group tpa --port lib:./$port --expected-failures known.toml \
        $report $target
      [ "$status" -eq 2 ]
      has "$target: is read by this command"
    done
  done
  [ "$before" = "$(cat $port known.toml | sha256sum)" ]
  printf '[task.unit]\nrate_hz = 250\nexecution_us = 10\npriority = 1\n' >tasks.toml
  run "$ATTEST" schedule tasks.toml --record-timing tasks.toml
  [ "$status" -eq 2 ]
  has "tasks.toml: is read by this command"
  "$ATTEST" schedule tasks.toml --record-timing timing.json >/dev/null
  run "$ATTEST" run --timing timing.json --json timing.json
  has "timing.json: is read by this command"
  run "$ATTEST" sim --timing timing.json --out timing.json
  has "timing.json: is read by this command"
  for report in --json --worst; do
    run "$ATTEST" time --port lib:./$port --group tpa $report $port
    has "$port: is read by this command"
  done
  run "$ATTEST" sweep-rate --port lib:./$port --csv $port
  has "$port: is read by this command"
  run "$ATTEST" stress --port lib:./$port --record-timing $port
  has "$port: is read by this command"
}

@test "no command but bless writes into a suite" {
  blessed_suite
  ln -s "$PWD/suite/golden" alias
  ln -s suite/golden/new.csv dangling
  cp -r suite other
  echo released >suite/BASE
  find suite other -type f -exec sha256sum {} + | sort >before
  sim=(sim hover --rate 250 --out)
  # Existing files and new ones; by a link, a link without a target and a detour; of the suite in
  # use and of another one.
  for target in suite/cases/px4-v1.5.5/attitude/roll.toml suite/cases/new.csv suite/BASE \
    suite/golden/px4-v1.5.5/attitude/roll.csv alias/new.csv dangling suite/../other/golden/x \
    "$PWD/other/cases/new.csv" "$SOURCE/models/new.csv"; do
    for command in "run --json" "sim hover --rate 250 --html" "record roll --rate 250 --out"; do
      run "$ATTEST" --suite suite $command "$target"
      [ "$status" -eq 2 ]
      has "$target: is in a suite"
    done
  done
  for folder in suite suite/golden suite/cases/new alias/px4-v1.5.5 other ./other/ other/golden \
    "$SOURCE" "$SOURCE/models/new"; do
    for command in vectors "new-port --lang c" "run --save-traces" "help --man" \
      "sweep $SOURCE/controller/starters/c/README.md --out"; do
      run "$ATTEST" --suite suite $command "$folder"
      [ "$status" -eq 2 ]
      has "$folder: is in a suite"
    done
  done
  find suite other -type f -exec sha256sum {} + | sort | diff before -
  [ -L dangling ]
}

@test "no command writes into the data of an installation" {
  mkdir -p installed/{bin,share/attest/starters}
  cp "$ATTEST" installed/bin/attest
  cp -r "$SOURCE/models" installed/share/attest/
  make_suite
  mv suite/* installed/share/attest/
  ln -s installed/share/attest data
  find installed | sort >before
  make_suite
  for folder in installed/share/attest data installed/share/attest/new data/starters/new; do
    for command in vectors "--suite suite vectors" "new-port --lang c" "help --man" \
      "vectors --from-log missing.ulg"; do
      run installed/bin/attest $command $folder
      [ "$status" -eq 2 ]
      has ": is in "
    done
  done
  run installed/bin/attest sim hover --rate 250 --html data/new.html
  [ "$status" -eq 2 ]
  has "data/new.html: is in the data of this attest"
  find installed | sort | diff before -
}

@test "a report at a link goes to the file that the link names" {
  ln -s kept/page.html page.html
  run "$ATTEST" sim gust --rate 250 --html page.html
  [ "$status" -eq 2 ]
  has "page.html: cannot create kept/page.html, to which it links: No such file or directory"
  mkdir kept
  for _ in new old; do
    run "$ATTEST" sim gust --rate 250 --html page.html
    [ "$status" -eq 0 ]
    [ -L page.html ]
    tail -c 8 kept/page.html | grep -q "</html>"
  done
  run "$ATTEST" sim gust --rate 250 --html page.html --out kept/page.html
  [ "$status" -eq 2 ]
  has "is asked for twice"
  ln -s loop loop
  run "$ATTEST" sim gust --rate 250 --html loop
  [ "$status" -eq 2 ]
  has "loop: cannot create the file: Too many levels of symbolic links"
}

@test "more ticks than fit in memory are refused before the port is called" {
  make_suite
  sed -i 's/duration_ticks = 30/duration_s = 120/; s/end_ticks = 25/end_s = 1/' \
    suite/cases/px4-v1.5.5/attitude/roll.toml
  run "$ATTEST" --suite suite record roll --rate 1000000 --out roll.csv
  [ "$status" -eq 2 ]
  has "roll.toml: is 120000000 ticks at 1000000 Hz, and at most 1000000 are possible; use a lower"
  [ ! -e roll.csv ]
  run "$ATTEST" stress --rates 1000000 --duration 3600
  [ "$status" -eq 2 ]
  has "hover.toml: is 3600000000 ticks at 1000000 Hz, and at most 30000000 are possible"
  printf '%s\n' '[task.unit]' 'rate_hz = 900000' 'execution_us = 1' 'priority = 2' >tasks.toml
  run "$ATTEST" schedule tasks.toml
  [ "$status" -eq 2 ]
  has "00000 ticks at 900000 Hz, and at most 1000000 are possible"
  printf '%s\n' 'schema = 1' 'case = "px4-v1.5.5/flight/hover"' 'rate = 1000000' \
    'design = "monte_carlo"' 'samples = 1' '[disperse.mass]' 'keys = ["vehicle.mass_kg"]' \
    'distribution = "uniform"' 'low = 1' 'high = 2' >sweep.toml
  for command in "sim hover --rate 1000000 --out f.csv" "sweep-rate --rates 1000000" \
    "sweep sweep.toml --out out"; do
    run "$ATTEST" $command
    [ "$status" -eq 2 ]
    has "000000 ticks at 1000000 Hz, and at most 1000000 are possible"
  done
}

@test "too little memory is an error that says so" {
  nm "$ATTEST" | grep -q __asan_init && skip "sanitizers need address space"
  make_suite
  sed -i 's/duration_ticks = 30/duration_s = 120/; s/end_ticks = 25/end_s = 1/' \
    suite/cases/px4-v1.5.5/attitude/roll.toml
  run bash -c "ulimit -v 300000; exec \"$ATTEST\" --suite suite record roll --rate 8000 --out x.csv"
  [ "$status" -eq 2 ]
  [ "$output" = "attest: error: out of memory; \`ulimit -v\` or the machine limits it" ]
}

@test "an output is never one of the files that are read, with or without a suite" {
  for file in a.csv b.csv; do "$ATTEST" sim gust --rate 250 --out $file; done
  cp "$SOURCE"/golden/recorded/px4-v1.5.5/{fuzz_250hz.csv,provenance.toml} .
  cp a.csv a.html
  sha256sum *.csv *.toml *.html >before
  ln -s a.csv link.csv
  for suite in "$SOURCE" nowhere; do
    for command in "compare a.csv b.csv --by-time --html a.csv" "plot a.csv b.csv --html b.csv" \
      "compare a.csv b.csv --html ./b.csv" "compare a.csv b.csv --by-time --html link.csv" \
      "plot a.html" "replay fuzz_250hz.csv --html fuzz_250hz.csv" \
      "replay fuzz_250hz.csv --html provenance.toml"; do
      ATTEST_SUITE=$suite run "$ATTEST" $command
      [ "$status" -eq 2 ]
      has "would be overwritten"
      sha256sum --quiet --check before
    done
  done
  run "$ATTEST" plot missing.csv --html missing.csv
  has "would be overwritten"
}

# wrong MESSAGE ARGUMENTS: the command ends with this error and exit code 2.
wrong() {
  run "$ATTEST" "${@:2}"
  [ "$status" -eq 2 ]
  has "attest: error: $1"
}

@test "an error says what is wrong, where, and what to do" {
  local missing="cannot open the file: No such file or directory"
  mkdir folder
  echo hello >text.csv
  cp text.csv text.so
  cp "$SOURCE/golden/recorded/px4-v1.5.5/fuzz_250hz.csv" good.csv
  wrong "god.csv: $missing; did you mean \`good.csv\`?" replay god.csv
  wrong "no/a.csv: $missing; there is no folder no" compare good.csv no/a.csv
  local packed="an installation has its suite packed: \`attest list --extract DIR\` makes DIR"
  wrong "golden/recorded/a.csv: $missing; there is no folder golden/recorded; $packed/golden/reco" \
    replay golden/recorded/a.csv
  wrong "flight.ulg: $missing; the path begins in $PWD" hunt --log flight.ulg
  wrong "none.toml: $missing" sim none.toml
  wrong "folder: not a regular file but a directory; name a file" plot folder
  wrong "text.csv:1:1: unknown column \`hello\`; \`attest list --channels\` shows" replay text.csv
  wrong "no/x.csv: cannot create the file: No such file or directory; make the folder no first" \
    sim hover --out no/x.csv
  wrong "no profile \`v1.6\`; there are px4-v1.5.5, " replay good.csv --profile v1.6
  wrong "no cases of profile \`1.5.5\`; did you mean \`px4-v1.5.5\`?" run --profile 1.5.5
  wrong "no cases of profile \`px4-v1.18.0\`; did you mean \`px4-v1.18\`?" run --profile px4-v1.18.0
  wrong "--within: \`-1\` is no number of at least 0; " replay good.csv --within -1
  wrong "--at-least: \`2\` is no number from 0 to 1; " replay good.csv --at-least 2
  wrong "--jobs: \`x\` is no whole number from 1 to 1024; " run --jobs x
  wrong "--seed: \`-1\` is no whole number of at least 0; " hunt --seed -1
  wrong "--seed: \`18446744073709551616\` is no whole" hunt --seed 18446744073709551616
  wrong "--shift abc: write a whole number of microseconds" compare good.csv good.csv --shift abc
  wrong "no case matches \`atitude/*\`; did you mean \`attitude/*\`?" run --filter 'atitude/*'
  wrong "no case matches \`rates/p_alon\`; did you mean \`rates/p_alone\`" run --filter rates/p_alon
  wrong "too many arguments: \`two\`; --filter chooses cases; attest run --help" run text.so two
  wrong "--json needs a value; attest run --help" run --json
  wrong "attest record needs CASE; attest record --help" record
  wrong "attest sweep needs SWEEP.toml and --out; attest sweep --help" sweep
  for page in sweeps timing; do
    { "$ATTEST" sweep --help && "$ATTEST" schedule --help; } | tr -s ' \n' ' ' >help.txt
    grep -q "docs/$page.md has an example" help.txt
  done
  wrong "text.csv: is not a folder; name a folder, which need not exist" hunt --out text.csv
  wrong "--port-reads: there is no file or folder none" --port-reads none list
  wrong "none: no program of this name is in PATH; for a file in this folder, write ./" \
    run --port proc:none
  run "$ATTEST" run --port lib:text.so
  [ "$status" -eq 2 ]
  has "file too short; build it with \`cc -shared -fPIC\`"
}
