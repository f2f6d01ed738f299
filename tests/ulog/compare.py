#!/usr/bin/env python3
"""Compares what attest and the npm package @foxglove/ulog read of ULog files, value for value.

    compare.py --print PROGRAM [--logs PROGRAM] [FILE...]

  --print  attest_ulog_print
  --logs   attest_ulog_logs, which writes files to compare in addition
Exits 77 without node or the package, which `npm ci` in this folder installs.
"""

import argparse
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
SKIPPED = 77
MOST_DIFFERENCES = 5  # to print for a file
# The damage that a file is made with: the message that is cut off before the appended data.
DAMAGED = {"appended.ulg"}


def why_skipped():
    if shutil.which("node") is None:
        return "node is not installed"
    if not (HERE / "node_modules/@foxglove/ulog").is_dir():
        return "@foxglove/ulog is not installed; run `npm ci` in tests/ulog"
    return None


def lines_of(command, statuses):
    """The objects that the program prints, as sorted texts that are equal if the values are."""
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode not in statuses:
        sys.exit(f"{' '.join(map(str, command))} exits {done.returncode}:\n{done.stderr}")
    objects = [json.loads(line, parse_int=float) for line in done.stdout.splitlines()]
    return sorted(json.dumps(each, sort_keys=True) for each in objects)


def only_in(lines, others):
    left = list(lines)
    counts = {}
    for line in others:
        counts[line] = counts.get(line, 0) + 1
    out = []
    for line in left:
        if counts.get(line, 0) > 0:
            counts[line] -= 1
        else:
            out.append(line)
    return out


def is_same(file, program):
    statuses = {1} if file.name in DAMAGED else {0}
    # The package leaves out empty texts of several parts, which PX4 writes as `char[0]`.
    ours = lines_of([program, file], statuses)
    ours = [line for line in ours if '"multi": "char[0] ' not in line]
    theirs = lines_of(["node", HERE / "foxglove.mjs", file], {0})
    if ours == theirs:
        print(f"same  {file.name}: {len(ours)} lines")
        return True
    print(f"OTHER {file.name}: {len(ours)} lines of attest, {len(theirs)} of foxglove")
    for line in only_in(ours, theirs)[:MOST_DIFFERENCES]:
        print(f"  attest   {line}")
    for line in only_in(theirs, ours)[:MOST_DIFFERENCES]:
        print(f"  foxglove {line}")
    return False


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("--print", required=True)
    parser.add_argument("--logs")
    parser.add_argument("files", nargs="*", type=pathlib.Path)
    args = parser.parse_args()
    if reason := why_skipped():
        print(f"skipped: {reason}")
        return SKIPPED
    with tempfile.TemporaryDirectory() as folder:
        if args.logs:
            subprocess.run([args.logs, folder], check=True)
        files = [*sorted(pathlib.Path(folder).glob("*.ulg")), *args.files]
        results = [is_same(file, args.print) for file in files]
    return 0 if results and all(results) else 1


if __name__ == "__main__":
    sys.exit(main())
