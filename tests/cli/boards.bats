# Ports on an emulated board. Needs arm-none-eabi-gcc with newlib, and qemu-system-arm.
load common

setup() {
  cd "$BATS_TEST_TMPDIR"
  cp "$ATTEST" attest
  export ATTEST_SUITE=$SOURCE PATH=$PWD:$PATH
  "$ATTEST" new-port mine --lang cortex_m >/dev/null
}

# conforms TARGET LAW OPTIONS...: the options of `check` give the bits of the reference.
conforms() {
  TARGET=$1 LAW=$2 run mine/check --level exact "${@:3}"
  [ "$status" -eq 0 ]
  has "PASS"
  has " passed, 0 failed"
}

@test "a Cortex-M4F conforms to the bit" {
  conforms m4f c --core --profile px4-v1.5.5
}

@test "a Cortex-M3 without floating point unit conforms to the bit" {
  conforms m3 c --group attitude --rate 250 --profile px4-v1.5.5
}

@test "the units and the laws of v1.14 to v1.18 are on the other processors" {
  conforms m33 c_cascade --group modes,rates --rate 250 --profile px4-v1.16.0
  conforms m7 c_law --group rate_law,attitude_law --rate 250 --profile px4-v1.16.0
}

# needs gcc-riscv64-unknown-elf, picolibc-riscv64-unknown-elf and qemu-system-misc
riscv() {
  command -v riscv64-unknown-elf-gcc >/dev/null || skip "no compiler for RISC-V"
  command -v qemu-system-riscv32 >/dev/null || skip "no emulator of RISC-V"
}

@test "a RISC-V conforms to the bit" {
  riscv
  conforms rv32 c --core --profile px4-v1.5.5
  conforms rv32 c_cascade --group modes,rates --rate 250 --profile px4-v1.16.0
}

# costs: of the first steps of a unit whose inputs are zero.
costs() {
  "$PYTHON" - qemu-system-arm -M mps2-an386 -display none -monitor none \
    -icount shift=5,sleep=off -semihosting-config enable=on,target=native \
    -kernel mine/port.elf <<'COSTS'
import struct, subprocess, sys
pipe = subprocess.PIPE
board = subprocess.Popen(sys.argv[1:], stdin=pipe, stdout=pipe)

def request(kind, payload):
    board.stdin.write(struct.pack("<4I", len(payload), kind, 1, 1) + payload)
    board.stdin.flush()
    return board.stdout.read(struct.unpack("<4I", board.stdout.read(16))[0])

board.stdin.write(b"{}\n")
board.stdin.flush()
board.stdout.readline()
request(1, struct.pack("<2I", 0, 10) + b"px4-v1.5.5")
for _ in range(3):
    print(*struct.unpack("<2I", request(4, bytes(128))[-8:]))
COSTS
}

@test "a step costs the same cycles in each run" {
  mine/check --filter px4-v1.5.5/rates/p_alone@250hz >/dev/null
  costs >once
  costs >twice
  diff once twice
  read -r cycles stack <once
  [ "$cycles" -gt 100 ]
  [ "$cycles" -lt 3000 ]
  [ "$stack" -gt 200 ]
  [ "$stack" -lt 2000 ]
}

@test "a step that takes longer than the counter of SysTick is counted" {
  local loop='for (volatile int i = 0; i < 4000000; ++i) continue;'
  sed -i "s|^static int step(.*{|&\n  $loop|" mine/c/unit.c
  mine/check --filter px4-v1.5.5/parameters/no_such >/dev/null || true
  read -r cycles _ < <(costs)
  [ "$cycles" -gt $((1 << 24)) ]
  [ "$cycles" -lt $((1 << 25)) ]
}

@test "a compiler that ignores NaN is caught" {
  CFLAGS=-Ofast run mine/check --group robustness --rate 250 --profile px4-v1.5.5 --no-diagnose
  [ "$status" -eq 1 ]
  has "non-finite"
}

@test "a fault of the processor is a crash, with its address" {
  sed -i 's|^static int step(.*{|&\n  __builtin_trap();|' mine/c/unit.c
  grep -q builtin_trap mine/c/unit.c
  run mine/check --filter px4-v1.5.5/rates/p_alone@250hz --no-diagnose
  [ "$status" -eq 1 ]
  has "crash: "
  has "it last printed: fault at 0x"
  riscv
  TARGET=rv32 run mine/check --filter px4-v1.5.5/rates/p_alone@250hz --no-diagnose
  [ "$status" -eq 1 ]
  has "it last printed: fault at 0x"
}

@test "a board with a UART reports its fault over the serial line" {
  "$ATTEST" new-port board --lang serial_board >/dev/null
  TARGET=m4f run board/check --filter px4-v1.5.5/rates/p_alone@250hz
  [ "$status" -eq 0 ]
  has "PASS 1 vector passed"
  sed -i 's|^static int step(.*{|&\n  __builtin_trap();|' board/c/unit.c
  TARGET=m4f run board/check --filter px4-v1.5.5/rates/p_alone@250hz --no-diagnose
  [ "$status" -eq 1 ]
  has "protocol: "
  has "the board has a fault at 0x"
}

@test "an unknown target is an error" {
  TARGET=m5 run mine/check
  [ "$status" -eq 2 ]
  has "TARGET=m5 is no target: m4f, m7, m33, m3, rv32"
}
