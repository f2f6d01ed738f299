"""Judges a right port again and again while busy loops take the CPU from it.

usage: busy.py ATTEST [RUNS]

Prints how many runs ended with which result. Exits 1 if one did not pass.
"""

import collections
import re
import subprocess
import sys
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]
# The slowest right port: each answer needs switches between two processes. The limit is a tenth of
# the usual one.
PORT = f"proc:{sys.executable} {SOURCE}/controller/starters/python/port.py"
RUN = ["run", "--port", PORT, "--filter", "rates/*", "--timeout", "1", "--no-diagnose"]
BUSY_LOOPS = 8


def result_of(attest: str) -> str:
    """The line of the verdict, without its time."""
    run = subprocess.run([attest, *RUN], capture_output=True, text=True, check=False)
    lines = re.findall(r"^(?:PASS|FAIL) .*", run.stdout, re.MULTILINE)
    return re.sub(r" in [0-9.]+ s$", "", lines[0]) if lines else run.stderr


def main() -> int:
    attest, runs = sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 20
    loop = [sys.executable, "-c", "while True: pass"]
    loops = [subprocess.Popen(loop) for _ in range(BUSY_LOOPS)]
    try:
        results = collections.Counter(result_of(attest) for _ in range(runs))
    finally:
        for running in loops:
            running.kill()
    for result, count in results.most_common():
        print(f"{count} of {runs} runs with {BUSY_LOOPS} busy loops: {result}")
    return 0 if all(result.startswith("PASS") for result in results) else 1


if __name__ == "__main__":
    sys.exit(main())
