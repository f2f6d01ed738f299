#!/usr/bin/env python3
"""Checks the layout of all C and C++ files with clang-format; `format.py --fix` rewrites them."""

import pathlib
import re
import shutil
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
import repository  # noqa: E402  (the path had to be set first)

TOOL = "clang-format-14"  # another version lays out differently
SKIPPED = 77


def main(arguments: list[str]) -> int:
    if arguments not in ([], ["--fix"]):
        print(__doc__, file=sys.stderr)
        return 2
    if shutil.which(TOOL) is None:
        print(f"skipped: {TOOL} is not installed")
        return SKIPPED
    mode = ["-i"] if arguments else ["--dry-run", "-Werror"]
    paths = [path for path in repository.files() if path.endswith((".c", ".h", ".cpp", ".hpp"))]
    command = [TOOL, *mode, "--", *paths]
    done = subprocess.run(
        command, cwd=repository.ROOT, stderr=subprocess.PIPE, text=True, check=False
    )
    if done.returncode != 0:
        lines = re.findall(r"^(.+?:\d+):\d+: error:", done.stderr, re.MULTILINE)
        for line in dict.fromkeys(lines):  # a line may be wrong at several columns
            print(f"{line}: not laid out by .clang-format: run tests/tidy/format.py --fix")
        if not lines:
            print(done.stderr)
    return done.returncode


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
