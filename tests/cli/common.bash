# Set by CTest: ATTEST (the binary), SOURCE (the tree), PORTS (test ports), STARTER (the C starter), PYTHON.

setup() {
  cd "$BATS_TEST_TMPDIR"
  unset NO_COLOR ATTEST_SUITE
  export SOURCE_DATE_EPOCH=1774915200 # reports do not depend on the day
  export XDG_STATE_HOME=$BATS_TEST_TMPDIR/state
}

# A suite of one quick case, without golden, in ./suite.
make_suite() {
  mkdir -p suite/cases/px4-v1.5.5/attitude suite/golden
  cp -r "$SOURCE/golden/recorded" suite/golden/
  cat >suite/cases/px4-v1.5.5/attitude/roll.toml <<'CASE'
schema = 1
profiles = ["px4-v1.5.5"]
group = "attitude"
why = "A level vehicle is asked to roll."
duration_ticks = 30

[control_state]
roll_rate = { signal = "sine", amplitude = 0.3, cycles = 2 }
pitch_rate = { signal = "sine", amplitude = 0.2, cycles = 3 }

[vehicle_attitude_setpoint]
q_d = { tilt_deg = { signal = "ramp", from = 0, to = 20, end_ticks = 25 } }
CASE
}

blessed_suite() {
  make_suite
  "$ATTEST" --suite suite bless --yes --reason "a test" >/dev/null
}

# has TEXT: the output of the last `run` contains it.
has() {
  [[ $output == *"$1"* ]] || {
    echo "expected: $1"
    echo "output:   $output"
    return 1
  }
}

# must_fail COMMAND...: it has to fail. `set -e` ignores the status of `! COMMAND`.
must_fail() {
  if "$@"; then
    echo "expected to fail: $*"
    return 1
  fi
}

# ends PATTERN: its last line matches.
ends() {
  [[ ${lines[-1]} == $1 ]] || {
    echo "expected: $1"
    echo "at the end of: $output"
    return 1
  }
}

lacks() {
  [[ $output != *"$1"* ]] || {
    echo "not expected: $1"
    echo "output:       $output"
    return 1
  }
}

# rate_only NAME [SED]: builds ./NAME.so, the C starter of the cascade without its attitude unit,
# with its rate unit changed by SED.
rate_only() {
  local from="$SOURCE/controller/starters/c_cascade"
  mkdir -p "$1"
  cp "$from"/*.c "$from"/*.h "$1/"
  sed -i '/{ATTEST_EXTENSION_ATTITUDE_UNIT/d' "$1/port.c"
  sed -i "${2:-}" "$1"/rate*.c
  cc -O2 -std=c11 -ffp-contract=off -fPIC -shared -I"$SOURCE/controller" -o "$1.so" "$1"/*.c -lm
}

# fake PROGRAM: the script on stdin replaces it, in the folder ./fakes.
fake() {
  mkdir -p fakes
  { echo '#!/bin/sh' && cat; } >"fakes/$1"
  chmod +x "fakes/$1"
}

# Waits until the command line of no process names this test's folder.
nothing_is_left() {
  local pattern="${BATS_TEST_TMPDIR%?}[${BATS_TEST_TMPDIR: -1}]"
  for _ in $(seq 50); do
    grep -qa -- "$pattern" /proc/[0-9]*/cmdline 2>/dev/null || return 0
    sleep 0.1
  done
  echo "left: $(grep -la -- "$pattern" /proc/[0-9]*/cmdline)"
  return 1
}

# accept_edit GOLDEN: updates the provenance of its profiles, as if attest had written the golden.
accept_edit() {
  python3 - "$1" <<'SEAL'
import hashlib, pathlib, re, sys
golden = pathlib.Path(sys.argv[1])
root = golden.parents[2]
header, *rows = [line.partition(",") for line in golden.open()]
goldens, profiles = {}, []
for cell, _, rest in rows:
    profiles = cell.split() or profiles
    for profile in profiles:
        goldens[profile] = goldens.get(profile, header[2]) + rest
prefix = "# SHA-256 of the lines above: "
for profile, golden_of_profile in goldens.items():
    path = root / profile / "provenance.toml"
    text = path.read_text().split(prefix)[0]
    begin = text.index(f"['{golden.relative_to(root).with_suffix('')}']")
    place = re.compile(r"^sha256 = .*$", re.MULTILINE).search(text, begin)
    hash_of_golden = hashlib.sha256(golden_of_profile.encode()).hexdigest()
    text = text[: place.start()] + f"sha256 = '{hash_of_golden}'" + text[place.end() :]
    path.write_text(text + prefix + hashlib.sha256(text.encode()).hexdigest() + "\n")
SEAL
}

# cascade_tasks RATE ATTITUDE_RATE: writes ./tasks.toml, the tasks of a flight of the cascade at
# these rates [Hz].
cascade_tasks() {
  cat >tasks.toml <<TASKS
[task.unit]
rate_hz = $1
execution_us = 60
priority = 30

[task.attitude_unit]
trigger = "estimator"
execution_us = 90
priority = 20

[task.estimator]
rate_hz = $2
execution_us = [800, 2200]
priority = 10
TASKS
}
