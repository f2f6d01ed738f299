# The installed suite, which is one archive. Set by CTest: INSTALLED (the installed attest), SOURCE
# (the tree), PORTS (test ports), PACK (the program that makes the archive), PYTHON.

load ../cli/common

attest=$INSTALLED/bin/attest
suite=$INSTALLED/share/attest/suite.zip

# same STATUS COMMAND...: exits with it, and has the same output, with the archive and with the
# folder of the source tree. Only a report of failures adds where the archive is.
same() {
  local times='s/ in [0-9.]* s$//' wanted=$1
  shift
  echo "$*"
  run "$attest" "$@"
  [ "$status" -eq "$wanted" ]
  sed "s|$suite|SUITE|g; $times; /^the files of the cases are in SUITE;/d" <<<"$output" >of_archive
  ATTEST_SUITE=$SOURCE run "$attest" "$@"
  [ "$status" -eq "$wanted" ]
  sed "s|$SOURCE|SUITE|g; $times" <<<"$output" >of_folder
  diff of_archive of_folder
}

@test "the archive gives the same results as the folder" {
  [ "$(cd "$INSTALLED/share/attest" && echo *)" = "ci include schemas starters suite.zip" ]
  same 0 list
  same 0 list --vehicles
  same 0 list --core
  same 0 doctor
  same 0 run --filter 'tpa/*@250hz' --level exact
  same 0 run --filter 'flight/gust@250hz*' --json -
  same 0 sim hover --rate 250:1000
  same 1 run --port fault:tpa-missing --filter 'px4-v1.5.5/tpa/*@250hz' --code-quality -
  same 2 run --filter 'no-such-case'
}

@test "a case in the archive is named by its path" {
  run "$attest" sim "$suite/cases/px4-v1.5.5/flight/hover.toml"
  [ "$status" -eq 0 ]
  run "$attest" sim "$suite/cases/px4-v1.5.5/flight/none.toml"
  [ "$status" -eq 2 ]
  run "$attest" run --port fault:tpa-missing --filter 'px4-v1.5.5/tpa/*@250hz'
  [ "$status" -eq 1 ]
  has "the files of the cases are in $suite; to copy them: attest list --extract DIR"
}

@test "the archive depends on names and bytes of the files alone" {
  mkdir -p {one,two}/{cases/b,golden,models}
  for folder in one two; do
    for file in cases/a cases/b/a golden/VERSION models/a.xml; do
      echo "$file" >$folder/$file
    done
  done
  rm one/cases/a
  echo cases/a >one/cases/a
  chmod 600 two/*/a
  touch -d 2001-01-01 two/cases/{a,b}
  for folder in one two; do "$PACK" $folder $folder.zip; done
  cmp one.zip two.zip
  "$PACK" "$SOURCE" again.zip
  cmp again.zip "$suite"
}

@test "list --extract makes a folder of the suite" {
  run "$attest" list --extract files
  [ "$status" -eq 0 ]
  has "files has the files of $suite. To use them: attest --suite files ..."
  for part in cases golden models; do diff -r "$SOURCE/$part" files/$part; done
  run "$attest" --suite files run --filter 'px4-v1.5.5/tpa/*@250hz'
  [ "$status" -eq 0 ]
  [[ $output != *"custom suite"* ]]
  run "$attest" list --extract files
  [ "$status" -eq 2 ]
  has "files: is in a suite"
  run "$attest" list --extract more --parameters
  [ "$status" -eq 2 ]
  run "$attest" list --extract more --group rates
  [ "$status" -eq 2 ]
  has "--extract copies the whole suite; leave out the options that select cases"
  [ ! -e more ]
  run "$attest" --suite files list --extract other
  [ "$status" -eq 2 ]
  has "files: is a folder already"
}

@test "attest does not change an archive" {
  cp "$suite" mine.zip
  for command in "--suite mine.zip bless --yes --reason mine" \
    "--suite mine.zip/ bless --yes --reason mine" \
    "vectors --from-log missing.ulg mine.zip" "hunt --out mine.zip"; do
    run "$attest" $command
    [ "$status" -eq 2 ]
    has "is an archive, which attest does not change; \`attest list --extract DIR\` makes a folder"
  done
  for command in "run --json" "sim hover --html"; do
    run "$attest" --suite mine.zip $command mine.zip
    [ "$status" -eq 2 ]
    has "mine.zip: is in a suite"
  done
  cmp "$suite" mine.zip
}

@test "a suite of one's own can have an archive as its base" {
  mkdir ours
  cp "$suite" base.zip
  for base in released ../base.zip; do
    echo "$base" >ours/BASE
    rm -rf ours/golden
    run "$attest" --suite ours bless --filter 'px4-v1.5.5/tpa/each_axis' --yes --reason mine
    [ "$status" -eq 0 ]
    run "$attest" --suite ours run --filter 'px4-v1.5.5/tpa/each_axis@250hz'
    [ "$status" -eq 0 ]
    has "custom suite"
  done
  head -c 1000000 "$suite" >base.zip
  run "$attest" --suite ours list
  [ "$status" -eq 2 ]
  has "base.zip: is no zip archive, or is damaged"
}

@test "a damaged archive is an error that names the file and the remedy" {
  remedy="restore the archive, or install attest anew; --suite DIR names a suite in a folder"
  head -c 1000000 "$suite" >cut.zip
  for command in run list "sim hover" doctor; do
    run "$attest" --suite cut.zip $command
    [ "$status" -ne 0 ]
    has "cut.zip: is no zip archive, or is damaged; $remedy"
  done
  golden=golden/px4-v1.16.0/rates/d_alone.csv
  "$PYTHON" - "$suite" $golden <<'P'
import sys, zipfile
place = zipfile.ZipFile(sys.argv[1]).getinfo(sys.argv[2]).header_offset + 200
bytes = bytearray(open(sys.argv[1], "rb").read())
bytes[place] ^= 255
open("bad.zip", "wb").write(bytes)
P
  run "$attest" --suite bad.zip run --filter "px4-v1.16.0/rates/d_alone@250hz"
  [ "$status" -eq 2 ]
  has "bad.zip/$golden: is damaged in its archive; $remedy"
  run "$attest" --suite bad.zip run --filter 'tpa/*@250hz'
  [ "$status" -eq 0 ]
}

@test "a port can neither read nor change the archive" {
  barrier=$("$attest" doctor | grep barrier || true)
  [[ $barrier != *"no barrier for files"* ]] || skip "this kernel has no Landlock"
  cp "$suite" mine.zip
  ln -s "$PWD/mine.zip" link.zip
  for own in "" mine.zip mine.zip/ link.zip; do
    export VICTIM=$PWD/mine.zip ATTEST_SUITE=$own
    [ -n "$own" ] || VICTIM=$suite
    for attack in reads_file reads_by_link writes_file; do
      echo "$attack $own"
      run "$attest" run --port "lib:$PORTS/hostile_$attack.so" --no-diagnose --jobs 1 --fail-fast \
        --filter 'px4-v1.5.5/rates/d_alone@250hz'
      [ "$status" -eq 1 ]
      has "fail: differs from the reference"
    done
  done
  run "$attest" run --port "lib:$PORTS/hostile_reads_file.so" --port-reads mine.zip \
    --no-diagnose --jobs 1 --filter 'px4-v1.5.5/rates/d_alone@250hz'
  [ "$status" -eq 0 ]
}

@test "a wrong port cannot have its ctest skipped by what it prints" {
  cp -r "$SOURCE/controller/starters/c" port
  cd port
  sed -i 's/rates_sp\[i\] - rates\[i\];/rates_sp[i] + rates[i];/' rate.c
  sed -i 's/^static int step(.*{$/&\n  puts("attest: error: no vector was compared");/
    1i #include <stdio.h>' unit.c
  cat >>CMakeLists.txt <<'C'
enable_testing()
attest_add_tests(TARGET attest_starter_c PROFILE px4-v1.5.5 px4-v1.16.0 ARGUMENTS --rate 250)
C
  cmake -B build -DCMAKE_PREFIX_PATH="$INSTALLED" >log 2>&1 || { cat log; false; }
  cmake --build build >log 2>&1 || { cat log; false; }
  run ctest --test-dir build -R '/(rates|yaw_filter)$' # v1.5.5 has no yaw filter
  [ "$status" -eq 8 ]
  [[ $output =~ attest_starter_c/rates' '\.*\*\*\*Failed ]]
  [[ $output =~ attest_starter_c/yaw_filter' '\.*\*\*\*Skipped ]]
}
