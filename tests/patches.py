"""Mistakes that are kept as patches. The text at the head of a patch describes the mistake. A line
`<marker>: why` there marks a mistake that is known not to be noticed. It is an error if a marked
mistake is noticed."""

import pathlib
import re
import subprocess
from typing import NamedTuple


class Broken(Exception):
    """A patch does not apply, or the patched code does not compile."""


class Patch(NamedTuple):
    path: pathlib.Path
    marked: str | None  # why it is not noticed

    @property
    def name(self) -> str:
        return self.path.stem

    def files(self) -> list[str]:
        """The files that it changes, relative to the root of the patched tree."""
        return re.findall(r"^\+\+\+ b/(.+)$", self.path.read_text(), re.MULTILINE)


def patches(folder: pathlib.Path, marker: str) -> list[Patch]:
    """All patches of a folder, sorted by name."""
    found = []
    for path in sorted(folder.glob("*.patch")):
        head = path.read_text().split("\n--- ", 1)[0]
        marked = re.search(rf"^{marker}: (.+)", head, re.MULTILINE | re.DOTALL)
        found.append(Patch(path, marked and marked[1].strip()))
    return found


def execute(command: list, folder: pathlib.Path, what: str) -> None:
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise Broken(f"{what}\n{done.stdout}{done.stderr}")


def apply(patch: Patch, folder: pathlib.Path, *options: str) -> None:
    command = ["patch", "-p1", "--silent", "--no-backup-if-mismatch", *options, "-i", patch.path]
    execute(command, folder, f"{patch.path} does not apply")
