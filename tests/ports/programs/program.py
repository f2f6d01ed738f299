#!/usr/bin/env python3
"""Programs that break the protocol of harness/port/PROTOCOL.md, each in one way, and some that keep
it in an unusual way:

    program.py MODE [--shared]

Apart from that they are the starter in Python. With --shared the frames are in shared memory.
"""

import json
import mmap
import os
import pathlib
import select
import signal
import struct
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "controller/starters/python"))
sys.dont_write_bytecode = True

import port  # noqa: E402  (the path had to be set first)

HELLO = {
    "protocol": 1,
    "name": "program",
    "version": "1",
    "profiles": ["px4-v1.5.5", "px4-v1.3.4"],
    "frames": "binary",
}
# What each mode answers to the handshake instead of HELLO.
HELLOS = {
    "hello_is_no_json": "ready",
    "hello_repeats": json.dumps(HELLO)[:-1] + ', "version": "2"}',
    "hello_repeats_escaped": json.dumps(HELLO)[:-1] + ', "v\\u0065rsion": "2"}',
    "hello_misspells": json.dumps(HELLO | {"fixed_setp": "250"}),
    "hello_in_batches": json.dumps(HELLO | {"batch": True}),
}


def answer(request, payload, **changed):
    """A frame that answers `request`, with some members of the header changed."""
    _, kind, unit, sequence = request
    header = {"size": len(payload), "kind": kind, "unit": unit, "sequence": sequence} | changed
    return port.HEADER.pack(*header.values()) + payload


# What each mode does instead of the answer to the 20th step.
def of_step(mode, request, payload, earlier):
    right = answer(request, payload)
    if mode == "garbage":
        return b"\xff" * 200
    if mode == "prints":
        return b"roll = 0.3\n" + right
    if mode == "half":
        sys.stdout.buffer.write(right[:40])
        sys.stdout.flush()
        sys.exit(0)
    if mode == "huge":
        return answer(request, payload, size=0xFFFFFFFF)
    if mode == "short":
        return answer(request, payload[:-4])
    if mode == "stale":
        return earlier
    if mode == "wrong_unit":
        return answer(request, payload, unit=99)
    if mode == "wrong_kind":
        return answer(request, payload, kind=port.CREATE)
    if mode == "no_result":
        return answer(request, struct.pack("<I", 77) + payload[4:])
    if mode == "exits":
        print("motor table lost", file=sys.stderr)
        sys.exit(3)
    if mode == "killed":
        os.kill(os.getpid(), signal.SIGSEGV)
    if mode == "hangs":
        time.sleep(100)
    if mode == "leaves_a_child":
        subprocess.Popen(["sleep", "100"])
        sys.exit(4)
    if mode == "closes_stdout":
        os.close(1)
        time.sleep(100)
    if mode == "floods_stderr":
        while True:
            sys.stderr.write("x" * 65536)
    return right


# What a mode does at a request that is not a step; the result that it answers, or None.
def of_other(mode, kind):
    if kind == port.DESTROY and mode == "exits_in_destroy":
        sys.exit(5)
    if kind == port.DESTROY and mode == "destroy_fails":
        return port.RESULT.pack(3)
    if kind == port.CREATE and mode == "create_fails":
        return port.RESULT.pack(3)
    return None


class SharedMemory:
    """Frames in memory shared with attest; read() and write() are those of a pair of pipes."""

    COUNTER = struct.Struct("<I")
    SIZE, ANSWERS, REQUEST, ANSWER = 528_384, 64, 4096, 266_240

    def __init__(self):
        self.memory = mmap.mmap(3, self.SIZE)
        self.answered = 0
        self.place = 0  # in the request

    def read(self, size):
        looks = 0
        while self.COUNTER.unpack_from(self.memory)[0] == self.answered:
            os.sched_yield()
            looks += 1
            if looks % 1000 == 0 and select.select([0], [], [], 0)[0]:
                return b""
        begin = self.REQUEST + self.place
        self.place += size
        return self.memory[begin : begin + size]

    def write(self, frame):
        self.memory[self.ANSWER : self.ANSWER + len(frame)] = frame
        self.place = 0
        self.answered += 1
        self.COUNTER.pack_into(self.memory, self.ANSWERS, self.answered)

    def flush(self):
        pass


def serve(mode, requests, answers):
    program, steps, earlier = port.Program(), 0, b""
    while len(header := requests.read(port.HEADER.size)) == port.HEADER.size:
        request = port.HEADER.unpack(header)
        size, kind, unit, _ = request
        payload = program.functions[kind](unit, requests.read(size))
        payload = of_other(mode, kind) or payload
        steps += kind == port.STEP
        is_special = kind == port.STEP and steps == 20
        if mode == "rolls" and kind == port.STEP:
            payload = payload[:4] + struct.pack("<f", 1) + payload[8:]
        frame = of_step(mode, request, payload, earlier) if is_special else answer(request, payload)
        if mode == "byte_by_byte":
            for byte in frame:
                answers.write(bytes([byte]))
                answers.flush()
        else:
            answers.write(frame)
            answers.flush()
        earlier = frame


def main():
    mode = sys.argv[1]
    requests, answers = sys.stdin.buffer, sys.stdout.buffer
    requests.readline()
    if "--shared" in sys.argv:
        HELLO["frames"] = "shared"
    if mode == "never_answers":
        time.sleep(100)
    if mode == "ends_at_once":
        sys.exit("no license found")
    if mode == "hello_has_no_end":
        answers.write(b"{" * 100_000)
        answers.flush()
        time.sleep(100)
    if mode == "one_unit":
        HELLO["lacks"] = ["instances"]
    if mode in ("counts_starts", "rolls", "one_unit"):
        with open(os.environ["STARTS"], "a", encoding="utf-8") as starts:
            starts.write("1\n")
    if mode == "hello_changes":
        starts = pathlib.Path(os.environ["STARTS"])
        if starts.read_text() != "0\n":
            HELLO["name"] = "other"
        starts.write_text("1\n")
    answers.write(HELLOS.get(mode, json.dumps(HELLO)).encode() + b"\n")
    answers.flush()
    if mode == "does_not_read":
        time.sleep(100)
    if "--shared" in sys.argv:
        requests = answers = SharedMemory()
    serve(mode, requests, answers)


if __name__ == "__main__":
    main()
