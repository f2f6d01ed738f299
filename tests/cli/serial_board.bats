# The starter for a board on a serial line, with its program on the host.
load common

setup() {
  cd "$BATS_TEST_TMPDIR"
  cp "$ATTEST" attest
  export ATTEST_SUITE=$SOURCE PATH=$PWD:$PATH SOURCE_DATE_EPOCH=1774915200
  "$ATTEST" new-port mine --lang serial_board >/dev/null
}

# one OPTIONS...: judges a vector.
one() { run mine/check --filter px4-v1.5.5/rates/p_alone@250hz --no-diagnose "$@"; }

# results FAULTS: the verdicts and the deviations of a wrong port.
results() {
  FAULTS=$1 LAW=wrong mine/check --filter "px4-v1.5.5/tpa/t*@250hz" --no-diagnose \
    --json report.json >/dev/null || true
  "$PYTHON" -c 'import json; print(*json.load(open("report.json"))["results"], sep="\n")'
}

@test "a line that loses, repeats and changes bytes does not change a verdict" {
  FAULTS=2 one --level exact
  [ "$status" -eq 0 ]
  has "PASS 1 vector passed"
  cp -r mine/c mine/wrong
  sed -i 's/fabsf(thrust) - g/thrust * thrust - g/' mine/wrong/rate.c
  grep -q 'thrust \* thrust' mine/wrong/rate.c
  results 0 >clean
  results 1 >noisy
  grep -q "'verdict': 'fail'" clean
  sed -i "s/'seconds': [^,}]*//" clean noisy
  diff clean noisy
}

@test "units of v1.14 to v1.18 answer in several packets" {
  LAW=c_cascade run mine/check --group modes --rate 250 --profile px4-v1.16.0 --level exact
  [ "$status" -eq 0 ]
  has "PASS"
}

@test "a paced line is as slow as a real one" {
  cat >time_of.py <<'PACED'
import os, sys, time
sys.path.insert(0, "mine")
import bridge
read, write = os.pipe()
begin = time.monotonic()
bridge.Line(write, 9600, 0, paced=True).write(bytes(480))
assert os.read(read, 1000) == bytes(480)
assert time.monotonic() - begin >= 0.5
PACED
  "$PYTHON" time_of.py
  PACED=1 one
  [ "$status" -eq 0 ]
  has "PASS 1 vector passed"
}

impatient() { sed -i 's/default=5,/default=2,/' mine/bridge.py; }

@test "a line that is too bad is an error, not a verdict" {
  impatient
  FAULTS=60 one
  [ "$status" -eq 2 ]
  has "no answer from the board for 2 s"
}

# breaks STATEMENT: the board executes it at its 20th step.
breaks() {
  impatient
  sed -i "1i #include <unistd.h>" mine/c/unit.c
  sed -i "s|^static int step(.*{|&\n  static int steps;\n  if (++steps == 20) $1;|" mine/c/unit.c
  grep -q "steps == 20" mine/c/unit.c
  one
  [ "$status" -eq 1 ]
}

@test "a board that is silent breaks the protocol" {
  breaks "for (;;) pause()"
  has "protocol: at tick 19: "
  has "bridge: no answer from the board for 2 s"
  nothing_is_left
}

@test "a board that is reset breaks the protocol" {
  breaks 'execl("/proc/self/exe", "board", (char*)0)'
  has "protocol: at tick 19: "
  has "bridge: the board was reset"
}

@test "a line that is closed breaks the protocol" {
  breaks '_exit(1)'
  has "protocol: at tick 19: "
  has "bridge: the line was closed"
}

# The pseudo-terminal stays when a bridge ends, as a board does.
@test "a device serves one bridge after the other" {
  one
  [ "$status" -eq 0 ]
  cat >line.py <<'LINE'
import os, pty, subprocess, sys, termios
master, line = pty.openpty()
attributes = termios.tcgetattr(line)
attributes[0] = attributes[1] = attributes[3] = 0
termios.tcsetattr(line, termios.TCSANOW, attributes)
os.symlink(os.ttyname(line), "device")
subprocess.run(sys.argv[1:], stdin=master, stdout=master)
LINE
  "$PYTHON" line.py mine/board 3>&- &
  local line=$!
  for _ in $(seq 100); do [ -e device ] || sleep 0.1; done
  DEVICE=device run mine/check --group rates --rate 250
  pkill -P $line
  [ "$status" -eq 0 ]
  has "PASS 15 vectors passed"
  DEVICE=no_such_device run mine/check
  [ "$status" -eq 2 ]
  has "bridge: no_such_device: "
}
