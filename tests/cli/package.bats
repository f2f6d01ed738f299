load common

# tried [COMMAND]: runs ci/package-try on stand-ins, of which the attest COMMAND fails.
tried() {
  local command
  mkdir -p usr/share/{man/man1,bash-completion/completions,zsh/vendor-completions}
  for command in attest attest-run; do echo page | gzip >usr/share/man/man1/$command.1.gz; done
  tee usr/share/zsh/vendor-completions/_attest >usr/share/bash-completion/completions/attest \
    <<<completion
  fake apt-get <<<'rm -f "$LACKS"; [ ! -e no-apt ]'
  fake dpkg-query <<<'echo attest'
  fake attest <<'FAKE'
case "$*" in
  "$FAILS"*) exit ${FAILS_WITH:-1} ;;
  "new-port mine"*) mkdir -p mine && touch mine/check && chmod +x mine/check ;;
  *fault:*) exit 1 ;;
esac
FAKE
  FAILS=${1-no command} PATH="$PWD/fakes:$PATH" run "$SOURCE/ci/package-try" attest.deb usr
}

@test "a package is tried, step by step" {
  tried
  [ "$status" -eq 0 ]
  has "installed with 1 packages"
}

@test "each step that fails on a package fails the trial, and is named" {
  for step in "run --level" "run --group" "new-port" "sim" "replay"; do
    tried "$step"
    [ "$status" -eq 1 ]
    has "package: exit code 1 instead of 0: attest $step"
  done
  FAILS_WITH=0 tried "run --port"
  [ "$status" -eq 1 ]
  has "package: exit code 0 instead of 1: attest run --port fault:tpa-missing"
  FAILS_WITH=2 tried "run --port"
  [ "$status" -eq 1 ]
  touch no-apt
  tried
  [ "$status" -eq 1 ]
  has "package: exit code 1 instead of 0: apt-get install"
}

@test "a package without manual or completion fails the trial" {
  for file in man/man1/attest-run.1.gz bash-completion/completions/attest \
    zsh/vendor-completions/_attest; do
    LACKS=usr/share/$file tried
    [ "$status" -eq 1 ]
    has "usr/share/$file"
  done
}
