# The scripts in ci/, without what they do: their usage, and what ci/bootstrap leaves behind.

load common

# Programs that a script may start only after it has read its options.
no_work() {
  for program in apt-get attest cmake dpkg-checkbuilddeps dpkg-buildpackage sbatch sudo; do
    fake $program <<<"echo \"$program\" >>$PWD/called; exit 1"
  done
  PATH="$PWD/fakes:$PATH"
}

@test "every script prints its usage, and refuses unknown options before it does anything" {
  no_work
  for script in "$SOURCE"/ci/*; do
    [ -f "$script" ] || continue
    for help in --help -h; do
      run "$script" $help
      [ "$status" -eq 0 ]
      [[ $output == "usage: "*"$(basename "$script")"* ]]
    done
    # The options of ci/quickstart are those of `attest run`, which it builds first.
    [ "$(basename "$script")" = quickstart ] && continue
    run "$script" --no-such-option
    [ "$status" -eq 2 ]
    has "usage: "
  done
  [ ! -e called ]
}

# bootstrapped SCRIPT: runs ci/bootstrap with that shell script as apt-get, which prints what
# policy-rc.d says meanwhile.
bootstrapped() {
  export POLICY_RC_D=$PWD/policy-rc.d
  fake dpkg-checkbuilddeps <<<'exit 1'
  fake sudo <<<'exec "$@"'
  fake apt-get <<<"cd '$PWD'; $1"
  PATH="$PWD/fakes:$PATH" "$SOURCE/ci/bootstrap" >log 2>&1 &
}

appears() {
  for _ in $(seq 600); do
    [ ! -e "$1" ] || return 0
    sleep 0.1
  done
  return 1
}

ended() {
  wait $! && status=0 || status=$?
}

@test "bootstrap starts no daemon, and leaves no policy however it ends" {
  bootstrapped './policy-rc.d; echo "policy $?"'
  ended
  [ "$status" -eq 0 ]
  grep -q "policy 101" log
  [ ! -e policy-rc.d ]
  for signal in TERM HUP; do
    # The signal comes while apt-get works: the policy stays until apt-get has ended.
    bootstrapped 'touch began; sleep 1; ./policy-rc.d; echo "policy $?" >>during'
    appears began
    kill -$signal $!
    ended
    [ "$status" -gt 128 ]
    [ "$(sort -u during)" = "policy 101" ]
    [ ! -e policy-rc.d ]
    rm began
  done
}

@test "a policy that a killed bootstrap has left is removed by the next" {
  bootstrapped "touch began; sleep 2; touch ended"
  appears began
  kill -KILL $!
  ended
  [ -e policy-rc.d ]
  fake dpkg-checkbuilddeps <<<'exit 0' # also if there is nothing to install
  POLICY_RC_D=$PWD/policy-rc.d PATH="$PWD/fakes:$PATH" run "$SOURCE/ci/bootstrap"
  [ "$status" -eq 0 ]
  [ ! -e policy-rc.d ]
}

@test "bootstrap keeps a policy that is not its own, and that of another one that runs" {
  printf '#!/bin/sh\nexit 101\n' >policy-rc.d
  chmod +x policy-rc.d
  bootstrapped true
  ended
  [ "$status" -eq 0 ]
  [ -e policy-rc.d ]
  rm policy-rc.d
  bootstrapped "touch began; while [ ! -e go ]; do sleep 0.1; done"
  appears began
  fake dpkg-checkbuilddeps <<<'exit 0'
  POLICY_RC_D=$PWD/policy-rc.d PATH="$PWD/fakes:$PATH" run "$SOURCE/ci/bootstrap"
  [ "$status" -eq 0 ]
  [ -e policy-rc.d ]
  touch go
  ended
  [ ! -e policy-rc.d ]
}
