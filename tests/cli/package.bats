load common

# tried [COMMAND [PACKAGE]]: runs ci/package-try on stand-ins, of which the attest COMMAND fails.
tried() {
  local command
  mkdir -p usr/{bin,lib/attest}
  mkdir -p usr/share/{man/man1,bash-completion/completions,zsh/vendor-completions,doc/attest/docs}
  mkdir -p usr/share/attest
  echo archive >usr/share/attest/suite.zip
  for command in attest attest-run; do echo page | gzip >usr/share/man/man1/$command.1.gz; done
  tee usr/share/zsh/vendor-completions/_attest >usr/share/bash-completion/completions/attest \
    <<<completion
  echo document >usr/share/doc/attest/docs/ports.md
  fake apt-get <<<'rm -f "$LACKS"; [ ! -e no-apt ]'
  fake dpkg-query <<<'echo attest'
  fake attest <<'FAKE'
case "$*" in
  "$FAILS"*) exit ${FAILS_WITH:-1} ;;
  "new-port mine"*) mkdir -p mine && touch mine/check && chmod +x mine/check ;;
  *fault:*) exit 1 ;;
esac
FAKE
  ln -sf ../../fakes/attest usr/bin/attest
  FAILS=${1-no command} PATH="$PWD/fakes:$PATH" run "$SOURCE/ci/package-try" ${2-attest.deb usr}
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

@test "a package without manual, completion or suite fails the trial" {
  for file in man/man1/attest-run.1.gz bash-completion/completions/attest \
    zsh/vendor-completions/_attest doc/attest/docs/ports.md attest/suite.zip; do
    LACKS=usr/share/$file tried
    [ "$status" -eq 1 ]
    has "usr/share/$file"
  done
}

# tests/consumer/portable.bats has a package that lacks a library.
@test "a portable package is tried in its folder" {
  tried "no command" usr
  [ "$status" -eq 0 ]
  lacks "installed with"
  tried "sim" usr
  [ "$status" -eq 1 ]
  has "package: exit code 1 instead of 0: attest sim"
}
