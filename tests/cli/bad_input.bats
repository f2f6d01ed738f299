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
  has ".csv: cannot write the file: File too large"
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

@test "no report may overwrite a file of the suite" {
  blessed_suite
  case_file=suite/cases/px4-v1.5.5/attitude/roll.toml
  golden=suite/golden/px4-v1.5.5/attitude/roll/250hz.csv
  ln -s suite/golden alias
  before=$(cat $case_file $golden)
  for target in $case_file $golden alias/px4-v1.5.5/attitude/roll/250hz.csv; do
    run "$ATTEST" --suite suite run --json $target
    [ "$status" -eq 2 ]
    has "$target: is a file of the suite"
  done
  for folder in suite/golden suite/cases alias/px4-v1.5.5; do
    run "$ATTEST" --suite suite vectors $folder
    [ "$status" -eq 2 ]
    has "$folder: is a folder of the suite"
  done
  [ "$before" = "$(cat $case_file $golden)" ]
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
