#!/usr/bin/env python3
"""Checks the tests of the harness: each mutation here is a mistake that they must notice.

    check.py [--only NAME]... [--room ROOM]... [--applies]

A table here, ROOM.toml, has the name of a room of harness/, or is `elementary`. Each entry is a
mutation: `text`, which must occur once in `file`, becomes `replacement`. `reason` says what is
wrong then. The mutation is made in a copy of the tree; then the room's tests are built and run. It
is noticed if they fail. An entry with `survives`, which says why, need not be noticed. It is an
error if the tests notice it.

Prints a table and the score. Exits 1 if fewer than 95% are noticed, an unmarked mutation survives
or a marked one is noticed; 2 if a table is wrong, a mutation does not apply or the code does not
compile. --applies only checks whether each mutation applies.
"""

import argparse
import os
import pathlib
import shutil
import subprocess
import sys
import tomllib
from typing import NamedTuple

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
sys.path.insert(0, str(HERE.parent))
from commands import Broken, execute  # noqa: E402

COPY = ROOT / "build" / "mutate"
BOUND = 0.95
# The tests of a room take up to 70 s without optimisation, and more on a busy machine: tests that
# run into this limit hang.
TIMEOUT_S = 600


REQUIRED = {"reason", "file", "text", "replacement"}
OPTIONAL = {"survives"}


class Mutation(NamedTuple):
    room: str
    name: str
    reason: str
    file: str  # relative to the root of the tree
    text: str
    replacement: str
    survives: str | None = None  # why it is not noticed

    @property
    def tests(self) -> str:
        return f"attest_{self.room}_tests"

    def applied(self, root: pathlib.Path) -> str:
        """The mutated text of its file below `root`."""
        where = f"tests/mutations/{self.room}.toml: [{self.name}]"
        if not (root / self.file).is_file():
            raise Broken(f"{where}: there is no {self.file}: correct `file`")
        original = (root / self.file).read_text()
        found = original.count(self.text)
        if found == 0:
            raise Broken(f"{where}: `text` is not in {self.file}: copy it from the code of today")
        if found > 1:
            raise Broken(
                f"{where}: `text` occurs {found} times in {self.file}: add lines until it is unique"
            )
        return original.replace(self.text, self.replacement)


def parsed(path: pathlib.Path, name: str, entry: object) -> Mutation:
    where = f"tests/mutations/{path.name}: [{name}]"
    if not isinstance(entry, dict):
        raise Broken(f"{where}: not a table: an entry begins with its name in brackets")
    for key in sorted(REQUIRED - entry.keys()):
        raise Broken(f"{where}: `{key}` is missing: add it")
    for key in sorted(entry.keys() - REQUIRED - OPTIONAL):
        raise Broken(f"{where}: unknown key `{key}`: remove it")
    for key, value in entry.items():
        if not isinstance(value, str) or (not value.strip() and key != "replacement"):
            raise Broken(f"{where}: `{key}` must be a string that is not empty")
    if entry["text"] == entry["replacement"]:
        raise Broken(f"{where}: `text` and `replacement` are the same: nothing is mutated")
    return Mutation(path.stem, name, **entry)


def table(path: pathlib.Path) -> list[Mutation]:
    try:
        entries = tomllib.loads(path.read_text())
    except tomllib.TOMLDecodeError as error:
        raise Broken(f"tests/mutations/{path.name}: {error}") from None
    return [parsed(path, name, entry) for name, entry in entries.items()]


def mutations(args: argparse.Namespace) -> list[Mutation]:
    """The selected mutations. Those of one file follow each other, so that the unmutated file is
    compiled again only once."""
    found = [m for path in HERE.glob("*.toml") for m in table(path)]
    found = [m for m in found if not args.only or m.name in args.only]
    found = [m for m in found if not args.room or m.room in args.room]
    return sorted(found, key=lambda m: (m.room, m.file, m.name))


def copy_tree() -> None:
    """Copies the files of the project as they are now. Unchanged files keep their time, so that
    only changed files are compiled again."""
    listed = ["git", "ls-files", "--cached", "--others", "--exclude-standard", "-z"]
    listing = subprocess.run(listed, cwd=ROOT, capture_output=True, text=True, check=True).stdout
    names = set(filter(None, listing.split("\0")))
    for old in COPY.rglob("*"):
        inside = old.relative_to(COPY)
        if inside.parts[0] != "build" and old.is_file() and str(inside) not in names:
            old.unlink()
    for name in sorted(names):
        source, target = ROOT / name, COPY / name
        if not source.exists():
            target.unlink(missing_ok=True)
        elif not target.exists() or source.read_bytes() != target.read_bytes():
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(source, target)


def build(targets: list[str]) -> None:
    command = ["cmake", "--build", "--preset", "mutate", "--target", *targets]
    execute(command, COPY, f"{' '.join(targets)} cannot be built")


def first_failure(tests: str) -> str | None:
    """The name of the first test that fails, None if all pass."""
    folder = COPY / "build" / "mutate" / "tests"
    binary = next(path for path in folder.rglob(tests) if path.is_file())
    environment = os.environ | {"GTEST_FAIL_FAST": "1", "GTEST_BRIEF": "1"}
    try:
        done = subprocess.run(
            [binary],
            cwd=binary.parent,
            env=environment,
            capture_output=True,
            text=True,
            errors="replace",
            timeout=TIMEOUT_S,
            check=False,
        )
    except subprocess.TimeoutExpired:
        return f"{tests} does not end"
    if done.returncode == 0:
        return None
    failed = [line for line in done.stdout.splitlines() if line.startswith("[  FAILED  ]")]
    return failed[0].split()[3].rstrip(",") if failed else f"{tests} ends with {done.returncode}"


class Judged(NamedTuple):
    mutation: Mutation
    noticed_by: str | None = None  # a test; None if it survives
    broken: str | None = None  # why it could not be judged

    @property
    def good(self) -> bool:
        return (self.noticed_by is None) == (self.mutation.survives is not None)

    @property
    def remark(self) -> str:
        if self.broken:
            return "BROKEN"
        if self.noticed_by:
            return self.noticed_by if self.good else f"{self.noticed_by}: SHOULD SURVIVE"
        return "nothing, as marked" if self.good else "NOTHING"


def judge(mutation: Mutation) -> Judged:
    file = COPY / mutation.file
    original = file.read_bytes() if file.is_file() else None
    try:
        file.write_text(mutation.applied(COPY))
        build([mutation.tests])
        return Judged(mutation, noticed_by=first_failure(mutation.tests))
    except Broken as broken:
        return Judged(mutation, broken=str(broken))
    finally:
        if original is not None:
            file.write_bytes(original)


def check_tests(rooms: list[str]) -> None:
    """Without a mutation all tests have to pass: a failing test would notice every mutation."""
    for room in rooms:
        failed = first_failure(f"attest_{room}_tests")
        if failed:
            raise Broken(f"{failed} fails without a mutation")


def check_all(chosen: list[Mutation]) -> int:
    copy_tree()
    execute(["cmake", "--preset", "mutate"], COPY, "the copy cannot be configured")
    rooms = sorted({mutation.room for mutation in chosen})
    print(f"building the tests of {', '.join(rooms)}", file=sys.stderr, flush=True)
    build([f"attest_{room}_tests" for room in rooms])
    check_tests(rooms)
    print("| room | mutation | noticed by |\n|---|---|---|")
    done = []
    for mutation in chosen:
        judged = judge(mutation)
        done.append(judged)
        print(f"| {mutation.room} | {mutation.name} | {judged.remark} |", flush=True)
        if judged.broken:
            print(judged.broken, file=sys.stderr, flush=True)
    if any(judged.broken for judged in done):
        return 2
    noticed = sum(judged.noticed_by is not None for judged in done)
    share = noticed / len(done)
    print(f"\n{noticed} of {len(done)} mutations are noticed: {100 * share:.1f}% (bound 95%)")
    return 0 if share >= BOUND and all(judged.good for judged in done) else 1


def check_that_all_apply(chosen: list[Mutation]) -> int:
    broken = 0
    for mutation in chosen:
        try:
            mutation.applied(ROOT)
        except Broken as error:
            broken += 1
            print(error, file=sys.stderr)
    print(f"{len(chosen) - broken} of {len(chosen)} mutations apply")
    return 2 if broken else 0


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--only", action="append", default=[], metavar="NAME")
    parser.add_argument("--room", action="append", default=[], metavar="ROOM")
    parser.add_argument("--applies", action="store_true", help="only look whether they apply")
    return parser.parse_args()


def main() -> int:
    args = arguments()
    try:
        chosen = mutations(args)
        if not chosen:
            print("no such mutation", file=sys.stderr)
            return 2
        if not args.applies:
            return check_all(chosen)
        return check_that_all_apply(chosen)
    except Broken as broken:
        print(broken, file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())
