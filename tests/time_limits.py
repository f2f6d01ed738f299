#!/usr/bin/env python3
"""Every test of a build has a time limit: a test that hangs fails and does not block the rest.

Usage: time_limits.py CTEST BUILD_DIR
"""

import json
import subprocess
import sys


def without_limit(tests: list[dict]) -> list[str]:
    """The names of the tests without a TIMEOUT, or with TIMEOUT 0, which means no limit."""
    found = []
    for test in tests:
        properties = {one["name"]: one["value"] for one in test.get("properties", [])}
        if not properties.get("TIMEOUT", 0) > 0:
            found.append(test["name"])
    return found


def main() -> int:
    ctest, build = sys.argv[1:]
    listed = subprocess.run(
        [ctest, "--show-only=json-v1", "--test-dir", build],
        stdout=subprocess.PIPE,
        text=True,
        check=True,
    )
    tests = json.loads(listed.stdout)["tests"]
    found = without_limit(tests)
    for name in found:
        print(f"{name}: has no TIMEOUT: call attest_test_defaults() in its folder")
    print(f"{len(tests)} tests, {len(found)} without a time limit")
    return 1 if found or not tests else 0


if __name__ == "__main__":
    sys.exit(main())
