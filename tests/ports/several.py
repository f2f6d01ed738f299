#!/usr/bin/env python3
"""Measures how the diagnosis names the mistakes of ports that have several: `several.py ATTEST`.

A file of the folder `several` is a starter with three to nine mistakes, invented from the law
without the catalogue of faults. `names` are the faults of the catalogue that are the same mistake;
none if the catalogue has no such fault. `parts` are true of the port because of the mistake, but
less than all of it. Each port is run once, at 250 Hz in its profile.

A mistake is named if a suspect of the report, or a fault that the report calls equally good, is one
of its names. A suspect that is neither a name nor a part is wrong: the port does not do what the
report says. Prints a table. Exits 1 if a share misses its bound, and 2 if an edit does not apply or
a port does not compile.

With `--alone PORT NUMBER FAULT`, compares a port that has only its mistake NUMBER (from 1) with the
fault, instead: whether the vectors that fail with the fault have the same deviations. So FAULT is a
name of the mistake if both fail in the same vectors, and else a part.

With `--each STEPS`, measures instead what catches each mistake alone, of these ports and of the
folder `alone`: the suite at the level numeric, the suite at exact, or a hunt of so many steps. The
mistakes of `alone` are of the kinds that a suite forgets most easily: thresholds, what is held or
latched for long, missing estimates, rare combinations. Prints a row for each mistake that the
suite at 250 Hz and numeric does not catch, and the shares.
"""

import argparse
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import tomllib
from collections.abc import Iterator
from typing import NamedTuple

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from commands import Broken, execute  # noqa: E402

CONTROLLER = HERE.parents[1] / "controller"
LEAST_RIGHT = 0.70
MOST_WRONG = 0.03


class Score(NamedTuple):
    mistakes: int
    unnamed: list[str]
    wrong: list[str]

    @property
    def named(self) -> int:
        return self.mistakes - len(self.unnamed)


def make(port: dict, folder: pathlib.Path) -> None:
    """Writes the sources of the port into `folder`."""
    for source in sorted((CONTROLLER / "starters" / port["starter"]).glob("*.[ch]")):
        shutil.copy(source, folder)
    for mistake in port["mistakes"]:
        for edit in mistake["edits"]:
            path = folder / edit["file"]
            text = path.read_text()
            if text.count(edit["old"]) != 1:
                raise Broken(f"{mistake['what']}: `old` must be in {edit['file']} once")
            path.write_text(text.replace(edit["old"], edit["new"]))


def build(folder: pathlib.Path) -> pathlib.Path:
    sources = sorted(path.name for path in folder.glob("*.c"))
    flags = ["-std=c11", "-O2", "-ffp-contract=off", "-fPIC", "-shared", "-fvisibility=hidden"]
    command = ["cc", *flags, f"-I{CONTROLLER}", *sources, "-o", "port.so", "-lm"]
    execute(command, folder, "the port does not compile")
    return folder / "port.so"


def run(attest: str, port: str, profile: str, report: pathlib.Path) -> dict:
    """The JSON report of a run of a wrong port."""
    command = [attest, "-q", "run", "--port", port, "--profile", profile]
    command += ["--rate", "250", "--json", report]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 1:
        raise Broken(f"attest run exited with {done.returncode}:\n{done.stdout}{done.stderr}")
    return json.loads(report.read_text())


def score(mistakes: list[dict], diagnosis: dict) -> Score:
    suspects = [{s["fault"], *s["ambiguity_group"]} for s in diagnosis["suspects"]]
    unnamed = [m["what"] for m in mistakes if not any(set(m["names"]) & s for s in suspects)]
    true = {name for m in mistakes for name in [*m["names"], *m.get("parts", [])]}
    found = zip(diagnosis["suspects"], suspects)
    wrong = [suspect["fault"] for suspect, names in found if not names & true]
    return Score(len(mistakes), unnamed, wrong)


def judge(attest: str, path: pathlib.Path) -> Score:
    port = tomllib.loads(path.read_text())
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        make(port, folder)
        report = run(attest, f"lib:{build(folder)}", port["profile"], folder / "report.json")
        return score(port["mistakes"], report["diagnosis"])


def compare_alone(attest: str, name: str, number: int, fault: str) -> None:
    """Prints in how many vectors the mistake alone and the fault have the same deviations."""
    port = tomllib.loads((HERE / "several" / f"{name}.toml").read_text())
    port["mistakes"] = port["mistakes"][number - 1 : number]

    def deviations(subject: str, report: pathlib.Path) -> dict[str, list]:
        results = run(attest, subject, port["profile"], report)["results"]
        failing = (result for result in results if result["verdict"] == "fail")
        keys = ("first", "deviating_ticks", "largest")
        return {result["id"]: [result.get(key) for key in keys] for result in failing}

    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        make(port, folder)
        mistake = deviations(f"lib:{build(folder)}", folder / "mistake.json")
        expected = deviations(f"fault:{fault}", folder / "fault.json")
    same = sum(mistake.get(vector) == each for vector, each in expected.items())
    print(f"{port['mistakes'][0]['what']}: fails {len(mistake)} vectors")
    print(f"{fault}: fails {len(expected)}, {same} of them with the same deviations")


def fails(attest: str, *command: str) -> bool:
    """Whether a run or hunt of a port finds a mistake."""
    done = subprocess.run([attest, "-q", *command], capture_output=True, text=True, check=False)
    if done.returncode not in (0, 1):
        raise Broken(f"attest {' '.join(command)}: exit {done.returncode}:\n{done.stderr}")
    return done.returncode == 1


def caught_by(attest: str, library: str, profile: str, steps: str) -> str:
    """The cheapest way that catches the mistake of a port."""
    suite = ["run", "--port", library, "--profile", profile, "--no-diagnose", "--fail-fast"]
    hunt = ["hunt", "--port", library, "--profile", profile, "--steps", steps]
    ways = {
        "numeric": [*suite, "--rate", "250"],
        "numeric, at all rates": suite,
        "exact": [*suite, "--level", "exact"],
        "hunt, numeric": hunt,
        "hunt, exact": [*hunt, "--level", "exact"],
    }
    return next((way for way, command in ways.items() if fails(attest, *command)), "none")


def alone() -> Iterator[tuple[str, dict]]:
    """Each mistake of the ports, as a port that has only this one, with the name of its file."""
    for path in sorted(HERE.glob("several/*.toml")) + sorted(HERE.glob("alone/*.toml")):
        port = tomllib.loads(path.read_text())
        for mistake in port["mistakes"]:
            yield path.stem, port | {"mistakes": [mistake]}


def measure_each(attest: str, only: list[str] | None, steps: str) -> int:
    """Prints what catches each mistake alone. Returns 1 if one is not caught."""
    print("| port | mistake | caught by |\n|---|---|---|")
    counts: dict[str, int] = {}
    for name, port in alone():
        if only and name not in only:
            continue
        with tempfile.TemporaryDirectory() as temporary:
            folder = pathlib.Path(temporary)
            make(port, folder)
            way = caught_by(attest, f"lib:{build(folder)}", port["profile"], steps)
        counts[way] = counts.get(way, 0) + 1
        if way != "numeric":
            print(f"| {name} | {port['mistakes'][0]['what']} | {way} |", flush=True)
    mistakes = sum(counts.values())
    numeric = sum(count for way, count in counts.items() if "numeric" in way)
    print(
        f"\n{1 - counts.get('none', 0) / mistakes:.1%} of {mistakes} mistakes are caught, "
        f"{numeric / mistakes:.1%} at numeric: {counts}"
    )
    return 1 if "none" in counts else 0


def require_that_all_apply() -> None:
    """Takes a second. Without it a change of a starter breaks edits that no test applies."""
    together = [tomllib.loads(path.read_text()) for path in sorted(HERE.glob("several/*.toml"))]
    for port in [*together, *(port for _, port in alone())]:
        with tempfile.TemporaryDirectory() as folder:
            make(port, pathlib.Path(folder))


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("attest")
    parser.add_argument("--alone", nargs=3, metavar=("PORT", "NUMBER", "FAULT"))
    parser.add_argument("--applies", action="store_true", help="only check that all edits apply")
    parser.add_argument("--each", metavar="STEPS")
    parser.add_argument("--only", nargs="+", metavar="PORT", help="with --each: only these ports")
    args = parser.parse_args()
    if args.alone:
        name, number, fault = args.alone
        compare_alone(args.attest, name, int(number), fault)
        return 0
    if args.applies:
        require_that_all_apply()
        return 0
    if args.each:
        return measure_each(args.attest, args.only, args.each)
    print("| port | named | not named | named wrongly |\n|---|---|---|---|")
    scores = []
    for path in sorted((HERE / "several").glob("*.toml")):
        one = judge(args.attest, path)
        unnamed, wrong = ", ".join(one.unnamed), ", ".join(f"`{name}`" for name in one.wrong)
        print(f"| {path.stem} | {one.named} of {one.mistakes} | {unnamed} | {wrong} |", flush=True)
        scores.append(one)
    mistakes = sum(one.mistakes for one in scores)
    named = sum(one.named for one in scores) / mistakes
    wrong = sum(len(one.wrong) for one in scores) / mistakes
    print(f"\n{named:.0%} of {mistakes} mistakes are named; {wrong:.1%} are named wrongly.")
    return 0 if named >= LEAST_RIGHT and wrong <= MOST_WRONG else 1


if __name__ == "__main__":
    try:
        sys.exit(main())
    except Broken as error:
        print(error, file=sys.stderr)
        sys.exit(2)
