#!/usr/bin/env python3
"""Checks the suite from outside: wrong ports must fail, right ones of other styles must pass.

    check.py --attest PATH [--only NAME]... [--every N] [--jobs N] [--core | --hunt STEPS]

A style is a folder here with a right port (c_starter, c_cascade, c_law: starters of the repository)
and patches, each a porting mistake. Every patch is applied to a copy of its port, compiled, and run
through the suite, flights last. The text at the head of a patch says what the mistake is. A line
`Passes: why` there marks a mistake that no case detects yet. It is an error if a case detects a
marked mistake.

Prints a table. Exits 1 if an unmarked mistake passes, a marked one fails, or a right port fails; 2
if a patch does not apply, also one that is not judged, or a port does not compile.

--core judges by the core of the suite only (`attest run --core`), --hunt by a search of so many
steps (`attest hunt`). They need not catch all mistakes; the last line says how many they catch.
"""

import argparse
import concurrent.futures
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import threading
from typing import NamedTuple

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1]))
from commands import Broken, execute  # noqa: E402

CONTROLLER = HERE.parents[2] / "controller"
STYLES = {
    "c_starter": CONTROLLER / "starters" / "c",
    "c_cascade": CONTROLLER / "starters" / "c_cascade",
    "c_law": CONTROLLER / "starters" / "c_law",
    "cpp_style": HERE / "cpp_style",
    "simulink_style": HERE / "simulink_style",
}
SOURCES = (".c", ".cpp", ".h", ".hpp")
# Flights take most of the time and show few mistakes that the other groups do not.
FLIGHTS = ("flight", "flight_timing")
FLIGHT_RATES = {
    "c_starter": "333",
    "c_cascade": "250:1000",
    "cpp_style": "333",
    "simulink_style": "333",
}
# Mistakes give wrong numbers, never slow steps: the limit allows for a busy machine.
TIMEOUT_S = 300
COMPILES_AT_ONCE = threading.Semaphore(2)


class Patch(NamedTuple):
    path: pathlib.Path
    passes: str | None  # why no case detects it yet


def patches(folder: pathlib.Path) -> list[Patch]:
    """All patches of a folder, sorted by name."""
    found = []
    for path in sorted(folder.glob("*.patch")):
        head = path.read_text().split("\n--- ", 1)[0]
        passes = re.search(r"^Passes: (.+)", head, re.MULTILINE | re.DOTALL)
        found.append(Patch(path, passes and passes[1].strip()))
    return found


class Candidate(NamedTuple):
    """A port to judge: right if it has no patch."""

    style: str
    patch: Patch | None

    @property
    def name(self) -> str:
        return self.patch.path.stem if self.patch else "(the right port)"

    @property
    def passes(self) -> str | None:
        """Why no case detects it yet."""
        return self.patch and self.patch.passes


class Judged(NamedTuple):
    candidate: Candidate
    caught_by: str | None  # the first case that failed
    broken: str | None  # why the candidate could not be judged

    @property
    def good(self) -> bool:
        right = self.candidate.patch is None or self.candidate.passes is not None
        return right == (self.caught_by is None)

    @property
    def remark(self) -> str:
        if self.broken:
            return "BROKEN"
        if self.caught_by:
            return self.caught_by if self.good else f"{self.caught_by}: SHOULD PASS"
        if self.candidate.patch is None:
            return "passes"
        return "passes, as marked" if self.good else "PASSES"


def candidates() -> list[Candidate]:
    found = []
    for style in STYLES:
        found.append(Candidate(style, None))
        found += [Candidate(style, patch) for patch in patches(HERE / style)]
    return found


def copy_sources(candidate: Candidate, folder: pathlib.Path) -> None:
    """The sources of the candidate, in `folder`."""
    for source in sorted(STYLES[candidate.style].iterdir()):
        if source.suffix in SOURCES:
            shutil.copy(source, folder)
    if candidate.patch:
        path = candidate.patch.path
        command = ["patch", "-p1", "--silent", "--no-backup-if-mismatch", "-i", path]
        execute(command, folder, f"{path} does not apply")


def require_that_all_apply() -> None:
    """Takes a second. Without it a change of a starter breaks patches that no test judges."""
    for candidate in candidates():
        with tempfile.TemporaryDirectory() as name:
            copy_sources(candidate, pathlib.Path(name))


def build(candidate: Candidate, folder: pathlib.Path) -> pathlib.Path:
    """The shared library of the candidate, made in `folder`."""
    copy_sources(candidate, folder)
    sources = sorted(path.name for path in folder.iterdir() if path.suffix in (".c", ".cpp"))
    compiler = "c++" if sources[0].endswith(".cpp") else "cc"
    flags = ["-O1", "-ffp-contract=off", "-fPIC", "-shared", "-fvisibility=hidden"]
    command = [compiler, *flags, f"-I{CONTROLLER}", *sources, "-o", "port.so", "-lm"]
    with COMPILES_AT_ONCE:
        execute(command, folder, f"{candidate.style}/{candidate.name} does not compile")
    return folder / "port.so"


def groups(attest: pathlib.Path) -> list[str]:
    """All groups of the suite that a port without mixer and battery estimate can be judged by."""
    listed = subprocess.run(
        [attest, "list", "--groups"], capture_output=True, text=True, check=True
    ).stdout
    names = {line.split()[0].rsplit("/", 1)[-1] for line in listed.splitlines() if line.strip()}
    return sorted(names - {"mixer", "battery_status"})


def report_of_failure(
    attest: pathlib.Path, verb: str, library: pathlib.Path, options: list
) -> dict | None:
    """The report of `attest run` or `attest hunt` up to the first failure, None if it passes."""
    report = library.with_name("report.json")
    command = [attest, "-q", verb, "--port", f"lib:{library}", "--fail-fast"]
    command += ["--timeout", str(TIMEOUT_S), "--json", report, *options]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode == 0:
        return None
    if done.returncode != 1:
        raise Broken(f"attest {verb} exited with {done.returncode}:\n{done.stdout}{done.stderr}")
    return json.loads(report.read_text())


def first_failure(attest: pathlib.Path, library: pathlib.Path, selection: list[str]) -> str | None:
    """The id of the first case that `attest run` finds wrong, None if it passes."""
    report = report_of_failure(attest, "run", library, ["--no-diagnose", *selection])
    if not report:
        return None
    failed = [r["id"] for r in report["results"] if r["verdict"] in ("fail", "non-finite")]
    if not failed:
        verdicts = sorted({r["verdict"] for r in report["results"]})
        raise Broken(f"attest run failed for another reason than its outputs: {verdicts}")
    return failed[0]


def first_finding(attest: pathlib.Path, library: pathlib.Path, steps: int) -> str | None:
    """The id of a case that `attest hunt` makes of its first finding, None without a finding."""
    # check.py judges several ports at once.
    report = report_of_failure(attest, "hunt", library, ["--steps", str(steps), "--jobs", "1"])
    if not report:
        return None
    if not report["findings"]:
        raise Broken("attest hunt failed without a finding")
    return report["findings"][0]["result"]["id"]


def judge(args: argparse.Namespace, all_groups: list[str], candidate: Candidate) -> Judged:
    def selection(flights: bool) -> list[str]:
        chosen = [group for group in all_groups if (group in FLIGHTS) == flights]
        return [word for group in chosen for word in ("--group", group)]

    try:
        with tempfile.TemporaryDirectory() as name:
            library = build(candidate, pathlib.Path(name))
            if args.hunt:
                return Judged(candidate, first_finding(args.attest, library, args.hunt), None)
            open_loop = ["--core"] if args.core else selection(flights=False)
            caught_by = first_failure(args.attest, library, open_loop)
            rates = FLIGHT_RATES.get(candidate.style)
            if rates and not caught_by and not candidate.passes and not args.core:
                flights = [*selection(flights=True), "--rate", rates]
                caught_by = first_failure(args.attest, library, flights)
    except Broken as error:
        return Judged(candidate, None, str(error))
    return Judged(candidate, caught_by, None)


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--attest", type=pathlib.Path, default=shutil.which("attest"))
    parser.add_argument("--only", action="append", default=[], metavar="NAME")
    parser.add_argument("--every", type=int, default=1, metavar="N", help="one mistake in N")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    by = parser.add_mutually_exclusive_group()
    by.add_argument("--core", action="store_true", help="judge by the core only")
    by.add_argument("--hunt", type=int, metavar="STEPS", help="judge by `attest hunt` instead")
    args = parser.parse_args()
    if not args.attest:
        parser.error("no attest in PATH: say --attest PATH")
    return args


def main() -> int:
    args = arguments()
    chosen = [c for c in candidates() if not args.only or c.name in args.only]
    mistakes = [c for c in chosen if c.patch]
    left_out = {c for i, c in enumerate(mistakes) if i % args.every}
    chosen = [c for c in chosen if c not in left_out]
    if args.hunt:  # it may find a marked mistake, too
        chosen = [c._replace(patch=c.patch and c.patch._replace(passes=None)) for c in chosen]
    if not chosen:
        print(f"no mistake is called {' or '.join(args.only)}", file=sys.stderr)
        return 2
    try:
        require_that_all_apply()
    except Broken as error:
        print(error, file=sys.stderr)
        return 2
    all_groups = groups(args.attest)
    print("| mistake | style | caught by |\n|---|---|---|")
    done = []
    with concurrent.futures.ThreadPoolExecutor(args.jobs) as pool:
        for judged in pool.map(lambda c: judge(args, all_groups, c), chosen):
            done.append(judged)
            name, style = judged.candidate.name, judged.candidate.style
            print(f"| {name} | {style} | {judged.remark} |", flush=True)
            if judged.broken:
                print(judged.broken, file=sys.stderr)
    if any(judged.broken for judged in done):
        return 2
    if args.core or args.hunt:
        wrong = [judged for judged in done if judged.candidate.patch]
        caught = sum(judged.caught_by is not None for judged in wrong)
        print(f"\nThe {'hunt' if args.hunt else 'core'} catches {caught} of {len(wrong)} mistakes.")
        return 1 if any(j.caught_by and not j.candidate.patch for j in done) else 0
    return 0 if all(judged.good for judged in done) else 1


if __name__ == "__main__":
    sys.exit(main())
