#!/usr/bin/env python3
"""Connects attest with a board on a serial line: the program of `--port "proc:bridge.py DEVICE"`.

serial.c says what is on the line. Faults of the line are repaired. If that takes too long, the
bridge writes what is wrong instead of an answer, and the verdict of attest is `protocol`.
"""

import argparse
import atexit
import fcntl
import os
import pty
import random
import select
import struct
import subprocess
import sys
import termios
import time
import zlib

START, LAST, FAULT, DAMAGED, NO_SESSION = 0, 250, 253, 254, 255
MAX_DATA, MIN_DATA = 240, 16  # bytes in a packet


class LineError(Exception):
    """The board cannot answer, with the reason."""


class Line:
    """A serial line, and the faults that it is asked to make.

    paced: the line itself has no rate, so that bytes take the time that they take at `baud`.
    """

    def __init__(self, file: int, baud: int, faults_percent: float, paced: bool):
        self._file = file
        self._paced = paced
        self._faults = faults_percent / 100
        self._random = random.Random(1)
        self.seconds_per_byte = 10 / baud  # with start bit and stop bit

    def write(self, data: bytes) -> None:
        data = self._with_faults(data)
        self._pace(data)
        while data:
            data = data[os.write(self._file, data) :]

    def read(self, seconds: float) -> bytes:
        """What has arrived. Empty after `seconds` without a byte."""
        if not select.select([self._file], [], [], seconds)[0]:
            return b""
        try:
            data = os.read(self._file, 4096)
        except OSError:  # a pseudo-terminal without a program
            data = b""
        if not data:
            raise LineError("the line was closed")
        self._pace(data)
        return self._with_faults(data)

    def _pace(self, data: bytes) -> None:
        if self._paced:
            time.sleep(len(data) * self.seconds_per_byte)

    def _with_faults(self, data: bytes) -> bytes:
        """Loses, repeats or changes some bytes."""
        if not self._faults:
            return data
        result = bytearray()
        for byte in data:
            if self._random.random() >= self._faults:
                result.append(byte)
                continue
            kind = self._random.randrange(3)
            if kind == 1:
                result += bytes([byte, byte])
            elif kind == 2:
                result.append(self._random.randrange(256))
        return bytes(result)


def encode(packet: bytes) -> bytes:
    """COBS, between zero bytes."""
    packet += struct.pack("<I", zlib.crc32(packet))
    return b"\0" + b"".join(bytes([len(p) + 1]) + p for p in packet.split(b"\0")) + b"\0"


def decode(line: bytes) -> bytes | None:
    """Returns None if the packet is damaged."""
    parts = []
    while line:
        parts.append(line[1 : line[0]])
        if len(parts[-1]) != line[0] - 1:
            return None
        line = line[line[0] :]
    packet = b"\0".join(parts)
    data, crc = packet[:-4], packet[-4:]
    return data if data and crc == struct.pack("<I", zlib.crc32(data)) else None


class Board:
    """A reliable stream of bytes in both directions: data is sent, then the answer is read."""

    def __init__(self, line: Line, patience: float):
        self._line = line
        self._patience = patience  # [s] without an answer
        self._sequence = START
        self._unread = b""
        self._data_max = MAX_DATA  # less on a bad line, on which long packets do not arrive
        self._round_trip(b"")

    def send(self, data: bytes) -> bytes:
        """Returns what the board answered to the last packet."""
        answer = b""
        while data:
            piece, data = data[: self._data_max], data[self._data_max :]
            answer = self._next(piece)
        return answer

    def more(self) -> bytes:
        return self._next(b"")

    def _next(self, data: bytes) -> bytes:
        self._sequence = self._sequence % LAST + 1
        return self._round_trip(data)

    def _round_trip(self, data: bytes) -> bytes:
        packet = encode(bytes([self._sequence, self._data_max]) + data)
        wait = 0.05 + (len(packet) + 2 * MAX_DATA) * self._line.seconds_per_byte
        end = time.monotonic() + self._patience
        while time.monotonic() < end:
            self._line.write(packet)
            answer = self._answer(wait)
            if answer is not None:
                self._data_max = min(self._data_max + 4, MAX_DATA)
                return answer
            self._data_max = max(self._data_max // 2, MIN_DATA)
        raise LineError(f"no answer from the board for {self._patience:g} s")

    def _answer(self, wait: float) -> bytes | None:
        """Returns None if the packet must be sent again."""
        end = time.monotonic() + wait
        while (left := end - time.monotonic()) > 0:
            line, zero, rest = self._unread.partition(b"\0")
            if not zero:
                self._unread += self._line.read(left)
                continue
            self._unread = rest
            if not line:
                continue
            packet = decode(line)
            if packet is None or packet[0] == DAMAGED:
                return None
            if packet[0] == FAULT:
                raise LineError(f"the board has a {packet[1:].decode(errors='replace').strip()}")
            if packet[0] == NO_SESSION and self._sequence != START:
                raise LineError("the board was reset")
            if packet[0] == self._sequence:
                return packet[1:]
        return None


def serve(board: Board) -> None:
    """Passes the requests of attest to the board, until attest closes stdin."""
    hello = sys.stdin.buffer.readline()
    if not hello:
        return
    answer = board.send(hello)
    while not answer.endswith(b"\n"):
        answer += board.more()
    write(answer)
    while header := sys.stdin.buffer.read(16):
        answer = board.send(header + sys.stdin.buffer.read(struct.unpack_from("<I", header)[0]))
        while len(answer) < 16 or len(answer) < 16 + struct.unpack_from("<I", answer)[0]:
            answer += board.more()
        write(answer)


def write(answer: bytes) -> None:
    sys.stdout.buffer.write(answer)
    sys.stdout.buffer.flush()


def set_raw(file: int, baud: int) -> None:
    """All bytes as they are, 8 bits, no flow control."""
    speed = getattr(termios, f"B{baud}", None)
    if speed is None:
        sys.exit(f"bridge: {baud} baud: this system has no such rate")
    attributes = termios.tcgetattr(file)
    control = termios.CS8 | termios.CREAD | termios.CLOCAL
    attributes[:6] = [0, 0, control, 0, speed, speed]
    termios.tcsetattr(file, termios.TCSANOW, attributes)
    termios.tcflush(file, termios.TCIOFLUSH)


def open_device(path: str, baud: int) -> int:
    try:
        file = os.open(path, os.O_RDWR | os.O_NOCTTY)
        fcntl.flock(file, fcntl.LOCK_EX)  # waits for another bridge to end
        set_raw(file, baud)
    except (OSError, termios.error) as error:
        sys.exit(f"bridge: {path}: {error}")
    return file


def start_program(command: list[str], baud: int) -> int:
    file, line = pty.openpty()
    set_raw(line, baud)
    program = subprocess.Popen(command, stdin=line, stdout=line)
    atexit.register(program.kill)
    os.close(line)
    return file


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--baud", type=int, default=115200, help="default: %(default)s")
    parser.add_argument(
        "--faults", type=float, default=0, metavar="PERCENT",
        help="lose, repeat or change this share of all bytes, as a test",
    )
    parser.add_argument(
        "--paced", action="store_true", help="with --program: as slow as a line of that rate",
    )
    parser.add_argument(
        "--patience", type=float, default=5, metavar="SECONDS",
        help="how long a board may give no right answer; default: %(default)s",
    )
    parser.add_argument(
        "--program", nargs=argparse.REMAINDER, metavar="COMMAND",
        help="start a program, whose stdin and stdout are the line, in place of a device",
    )
    parser.add_argument("device", nargs="?", help="such as /dev/ttyUSB0")
    arguments = parser.parse_args()
    if not arguments.device and not arguments.program:
        parser.error("name a device")
    if arguments.program:
        file = start_program(arguments.program, arguments.baud)
    else:
        file = open_device(arguments.device, arguments.baud)
    line = Line(file, arguments.baud, arguments.faults, arguments.paced)
    try:
        serve(Board(line, arguments.patience))
    except LineError as error:
        print(f"bridge: {error}", file=sys.stderr)
        write(b"no answer from the board")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
