# The jobs of CI in ci/examples, which `attest new-port` copies.

load common

# installed: runs install-attest in an empty folder, with stand-ins for the programs that it calls.
# They write their arguments to ./called. FAKES_ONLY: without the programs of this machine.
installed() {
  fake apt-get <<<'echo "apt-get $*" >>"$CALLED"'
  fake curl <<<'echo "curl $*" >>"$CALLED"; [ -z "$OFFLINE" ]'
  export CALLED=$PWD/called OFFLINE=${OFFLINE-} PREFIX=$PWD/usr
  rm -f called
  PATH="$PWD/fakes${FAKES_ONLY-:$PATH}" run /bin/sh "$SOURCE/ci/examples/install-attest"
}

@test "without a package of attest, CI says what to do" {
  unset ATTEST_PACKAGE_URL
  for url in unset ""; do
    [ "$url" = unset ] || export ATTEST_PACKAGE_URL=$url # GitHub sets a missing variable to ""
    FAKES_ONLY="" installed
    [ "$status" -eq 2 ]
    has "install-attest: there is no package of attest. Add attest_VERSION_amd64.deb"
    has "variable ATTEST_PACKAGE_URL to its URL"
    has "the file from which you installed attest"
    [ ! -e called ]
  done
}

@test "CI uses the attest of its image, if there is no package" {
  unset ATTEST_PACKAGE_URL
  fake attest <<<'echo "attest 9.8.7"'
  echo gcc >packages.txt
  installed
  [ "$status" -eq 0 ]
  grep -q "^apt-get install .* gcc$" called
  has "install-attest: attest 9.8.7 is installed already"
}

@test "CI takes the package from the repository, or from a URL" {
  touch attest_0.1.0_amd64.deb
  echo "gcc libc6-dev" >packages.txt
  installed
  [ "$status" -eq 0 ]
  grep -q "^apt-get install .* ca-certificates .* gcc libc6-dev$" called
  grep -q "^apt-get install .* ./attest_0.1.0_amd64.deb$" called
  # A URL comes first.
  export ATTEST_PACKAGE_URL="https://example.org/a/attest_0.2.0_amd64.deb?token=1"
  installed
  [ "$status" -eq 0 ]
  grep -q "^curl .*/attest_0.2.0_amd64.deb $ATTEST_PACKAGE_URL$" called
  grep -q "^apt-get install .*/attest_0.2.0_amd64.deb$" called
  OFFLINE=yes installed
  [ "$status" -eq 2 ]
  has "install-attest: ATTEST_PACKAGE_URL is https://example.org/"
}

@test "CI unpacks a portable package" {
  mkdir -p attest-0.1.0-linux-x86_64/bin usr
  touch attest-0.1.0-linux-x86_64/bin/attest
  tar --create --auto-compress --file attest-0.1.0-linux-x86_64.tar.xz attest-0.1.0-linux-x86_64
  unset ATTEST_PACKAGE_URL
  installed
  [ "$status" -eq 0 ]
  [ -f usr/bin/attest ]
}

@test "the scripts in the examples are right" {
  "$PYTHON" -c "import yaml" 2>/dev/null || skip "no python3-yaml"
  command -v shellcheck >/dev/null || skip "no shellcheck"
  shellcheck "$SOURCE/ci/examples/install-attest"
  for file in "$SOURCE"/ci/examples/*.yml; do
    folder=$(basename "$file" .yml)
    "$PYTHON" "$SOURCE/tests/cli/run_workflow.py" --scripts "$folder" "$file"
    [ "$(cat "$folder"/*.sh | wc -l)" -ge 2 ]
    shellcheck --exclude=SC2034 "$folder"/*.sh
  done
}

@test "the jobs with shards give the report of one machine" {
  "$PYTHON" -c "import yaml" 2>/dev/null || skip "no python3-yaml"
  "$ATTEST" new-port mine --lang c --quiet
  cd mine
  # Two groups at one rate, so that the test is short.
  fake attest <<'FAKE'
case "$*" in
  "run "*--help) exec "$ATTEST" "$@" ;;
  "run "*) exec "$ATTEST" "$@" --group attitude,rates --rate 250 ;;
esac
exec "$ATTEST" "$@"
FAKE
  export ATTEST GITHUB_STEP_SUMMARY=$PWD/summary.md PATH="$PWD/fakes:$PATH"
  mkdir reports
  ./check --quiet --json one.json
  for service in github gitlab; do
    rm -rf shards reports
    "$PYTHON" "$SOURCE/tests/cli/run_workflow.py" "$SOURCE/ci/examples/$service-shards.yml"
    [ "$(ls shards)" = "$(printf '%s\n' {1..4}.json)" ]
    [ -s reports/attest.html ]
    [ -s reports/attest.junit.xml ]
    [ $service = gitlab ] || diff one.json reports/attest.json
  done
  grep -q "| attitude |" summary.md
  # A wrong port fails only the last job.
  sed -i 's/a\[2\] \* b\[0\] - a\[0\] \* b\[2\]/a[2] * b[0] + a[0] * b[2]/' vector.h
  run "$PYTHON" "$SOURCE/tests/cli/run_workflow.py" "$SOURCE/ci/examples/github-shards.yml"
  [ "$status" -ne 0 ]
  has "attest merge shards"
  has "it looks like"
}
