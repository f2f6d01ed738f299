#!/usr/bin/env python3
"""The example in bytes of harness/port/PROTOCOL.md.

    example.py                 a port that takes those requests only, and gives those answers
    example.py check COMMAND   makes the requests of the program COMMAND, and compares its answers
"""

import pathlib
import re
import subprocess
import sys

PROTOCOL = pathlib.Path(__file__).resolve().parents[3] / "harness/port/PROTOCOL.md"
HELLO = (
    b'{"protocol":1,"name":"example","version":"1","profiles":["px4-v1.5.5"],"frames":"binary"}\n'
)


def frames():
    """Pairs of a request and its answer."""
    found = []
    for mark, words in re.findall(r"^    ([<>]) ([0-9a-f ]+)$", PROTOCOL.read_text(), re.MULTILINE):
        if not found or found[-1][0] != mark:
            found.append((mark, b""))
        found[-1] = (mark, found[-1][1] + bytes.fromhex(words))
    assert len(found) == 8 and [mark for mark, _ in found] == [">", "<"] * 4, "the example changed"
    return [(found[i][1], found[i + 1][1]) for i in range(0, len(found), 2)]


def port():
    requests, answers = sys.stdin.buffer, sys.stdout.buffer
    requests.readline()
    answers.write(HELLO)
    answers.flush()
    for request, answer in frames():
        got = requests.read(len(request))
        if got != request:
            sys.exit(f"got {got.hex(' ', 4)} instead of {request.hex(' ', 4)}")
        answers.write(answer)
        answers.flush()


def check(command):
    program = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE)
    program.stdin.write(b'{"attest":"0.1.0","protocol":1}\n')
    program.stdin.flush()
    print(program.stdout.readline().decode(), end="")
    for request, answer in frames():
        program.stdin.write(request)
        program.stdin.flush()
        got = program.stdout.read(len(answer))
        if got != answer:
            sys.exit(f"answered {got.hex(' ', 4)} instead of {answer.hex(' ', 4)}")
    program.stdin.close()
    sys.exit(program.wait())


if __name__ == "__main__":
    check(sys.argv[2:]) if sys.argv[1:2] == ["check"] else port()
