#!/usr/bin/env python3
"""Measures how many mistakes of a port the diagnosis names: `naming.py ATTEST`.

A port here is the reference with one fault of the catalogue, or several at once, of different
stages of the law (`attest run --port fault:A+B+C`). It is run through the cases in open loop of one
profile at 250 Hz. A suspect of the report is right if the port has it, or a fault that the report
calls equally good; otherwise it is wrong.

Prints a table by the number of mistakes. Exits 1 if a share misses its bound.
"""

import argparse
import concurrent.futures
import json
import os
import pathlib
import random
import re
import subprocess
import sys
import tempfile
from typing import NamedTuple

PROFILES = ("px4-v1.16.0", "px4-v1.5.5")
COUNTS = (1, 2, 3, 5)  # mistakes of a port; the name of a port has at most 200 bytes
PORTS_OF_EACH = 6  # with that many mistakes, of each profile
SEED = 40
# Groups of other modules, whose faults do not act in the units.
LEFT_OUT = ("mixer", "battery_status")
LEAST_RIGHT = 0.75
MOST_WRONG = 0.03


class Fault(NamedTuple):
    name: str
    group: str
    stage: str


class Score(NamedTuple):
    mistakes: int = 0
    right: int = 0
    wrong: int = 0
    unexplained: int = 0  # failing vectors
    failing: int = 0

    def plus(self, other: "Score") -> "Score":
        return Score(*(a + b for a, b in zip(self, other)))


def faults_of(attest: str, profile: str) -> list[Fault]:
    """The faults that a profile can tell from the law, in the groups that are run."""
    command = [attest, "faults", "--list", "--profile", profile]
    listed = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    found = []
    for line in listed.splitlines():
        words = re.split(r"\s{2,}", line.strip())
        if len(words) >= 4 and profile in words[3] and words[1] not in LEFT_OUT:
            found.append(Fault(*words[:3]))
    return found


def of_different_stages(faults: list[Fault], count: int, chosen: random.Random) -> list[str]:
    names: dict[str, str] = {}
    for fault in chosen.sample(faults, len(faults)):
        if len(names) < count:
            names.setdefault(fault.stage, fault.name)
    return list(names.values())


def score(
    attest: str, profile: str, groups: set[str], port: list[str]
) -> tuple[Score, list[str]]:
    """The score of a port in these groups of cases, and its suspects that are wrong."""
    with tempfile.TemporaryDirectory() as folder:
        report = pathlib.Path(folder) / "report.json"
        command = [attest, "-q", "run", "--port", "fault:" + "+".join(port), "--rate", "250"]
        command += ["--profile", profile, "--json", report, "--jobs", "1"]
        command += ["--group", ",".join(sorted(groups))]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode == 0:
            return Score(), []  # the mistakes show at other rates only
        if done.returncode != 1:
            sys.exit(f"{' '.join(map(str, command))}\n{done.stdout}{done.stderr}")
        found = json.loads(report.read_text()).get("diagnosis", {"suspects": []})
    named, wrong = set(), []
    for suspect in found["suspects"]:
        right = set(port) & {suspect["fault"], *suspect["ambiguity_group"]}
        named |= right
        if not right:
            wrong.append(suspect["fault"])
    vectors = found.get("unexplained_vectors", 0), found.get("failing_vectors", 0)
    return Score(len(port), len(named), len(wrong), *vectors), wrong


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("attest")
    parser.add_argument("--ports", type=int, default=PORTS_OF_EACH, metavar="N")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--verbose", action="store_true", help="print each wrong suspect")
    args = parser.parse_args()
    chosen = random.Random(SEED)
    of_profile = {profile: faults_of(args.attest, profile) for profile in PROFILES}
    groups = {profile: {fault.group for fault in faults} for profile, faults in of_profile.items()}
    total = Score()
    print("| mistakes of a port | ports | named | named wrongly | failing vectors explained |")
    print("|---|---|---|---|---|")
    with concurrent.futures.ThreadPoolExecutor(args.jobs) as pool:
        for count in COUNTS:
            ports = [
                (profile, groups[profile], of_different_stages(faults, count, chosen))
                for profile, faults in of_profile.items()
                for _ in range(args.ports)
            ]
            scores = list(pool.map(lambda port: score(args.attest, *port), ports))
            row = Score()
            for (_, _, port), (one, wrong) in zip(ports, scores):
                row = row.plus(one)
                if wrong and args.verbose:
                    print(f"{'+'.join(port)}: wrongly {', '.join(wrong)}", file=sys.stderr)
            explained = row.failing - row.unexplained
            print(
                f"| {count} | {len(ports)} | {row.right} of {row.mistakes} | {row.wrong} |"
                f" {explained} of {row.failing} |",
                flush=True,
            )
            total = total.plus(row)
    right, wrong = total.right / total.mistakes, total.wrong / total.mistakes
    print(f"\n{right:.0%} of {total.mistakes} mistakes are named; {wrong:.1%} are named wrongly.")
    return 0 if right >= LEAST_RIGHT and wrong <= MOST_WRONG else 1


if __name__ == "__main__":
    sys.exit(main())
