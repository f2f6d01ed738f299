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
"""

import argparse
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import tomllib
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


def diagnose(attest: str, port: dict, library: pathlib.Path) -> dict:
    report = library.with_name("report.json")
    command = [attest, "-q", "run", "--port", f"lib:{library}", "--profile", port["profile"]]
    command += ["--rate", "250", "--json", report]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 1:
        raise Broken(f"attest run exited with {done.returncode}:\n{done.stdout}{done.stderr}")
    return json.loads(report.read_text())["diagnosis"]


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
        return score(port["mistakes"], diagnose(attest, port, build(folder)))


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("attest")
    args = parser.parse_args()
    print("| port | named | not named | named wrongly |\n|---|---|---|---|")
    scores = []
    for path in sorted((HERE / "several").glob("*.toml")):
        try:
            one = judge(args.attest, path)
        except Broken as error:
            print(f"{path.name}: {error}", file=sys.stderr)
            return 2
        unnamed, wrong = ", ".join(one.unnamed), ", ".join(f"`{name}`" for name in one.wrong)
        print(f"| {path.stem} | {one.named} of {one.mistakes} | {unnamed} | {wrong} |", flush=True)
        scores.append(one)
    mistakes = sum(one.mistakes for one in scores)
    named = sum(one.named for one in scores) / mistakes
    wrong = sum(len(one.wrong) for one in scores) / mistakes
    print(f"\n{named:.0%} of {mistakes} mistakes are named; {wrong:.1%} are named wrongly.")
    return 0 if named >= LEAST_RIGHT and wrong <= MOST_WRONG else 1


if __name__ == "__main__":
    sys.exit(main())
