#!/usr/bin/env python3
"""Runs the commands of a document as its reader would.

    docs.py [--bin DIR] [--prefix DIR] [--need TOOL]... [--extract-suite] --scratch DIR DOCUMENT

Takes the ```sh blocks of DOCUMENT in order, in one shell, in a fresh copy of the repository below
the scratch directory: at its root, or for a starter in the starter's folder, where its reader is.
The copy for a starter has only controller/, because it uses the installed attest for all else. The
starter's folder has the headers in include/, as `attest new-port` makes it.
A command has to succeed. A command that ends in the comment `# exit 1` has to exit with that
status. With `# exit 0 or 2` both are accepted, because the result depends on the machine.

The set-up commands (ci/...) would build everything again. They are in a ```sh no-run block, and
only their --help is run.
"""

import argparse
import os
import pathlib
import re
import shutil
import subprocess
import sys
from typing import NamedTuple

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
import repository  # noqa: E402  (the path had to be set first)

# Thousands of files, which no document names: the installed attest uses the installed ones.
GOLDENS_OF_CASES = "golden/px4-"
SETUP_COMMANDS = ("ci/quickstart", "ci/check", "ci/quality", "ci/fuzz")
SKIPPED = 77


class Block(NamedTuple):
    line: int  # of the first command
    info: str  # what follows ``` on the fence
    commands: list[str]


class DocumentError(Exception):
    def __init__(self, line: int, message: str):
        super().__init__(message)
        self.line = line


def blocks(text: str) -> list[Block]:
    found, opened = [], None
    for number, line in enumerate(text.splitlines(), 1):
        fence = re.match(r"\s*```(.*)", line)
        if not fence:
            if opened:
                opened.commands.append(line)
        elif opened:
            found.append(opened)
            opened = None
        else:
            opened = Block(number + 1, fence[1].strip(), [])
    if opened:
        raise DocumentError(opened.line - 1, "this block is never closed")
    return found


# The script keeps every command in its line of the document, so that $LINENO is right. Line 1 is
# free for this prologue, because no block starts there.
_PROLOGUE = (
    "set -Eeuo pipefail; "
    """trap 'echo "$DOCUMENT:$LINENO: exit status $? of: $BASH_COMMAND" >&2' ERR; """
    """expect() { [[ " $1 " == *" $2 "* ]] || """
    '{ echo "$DOCUMENT:$3: exit status $2 instead of $1" >&2; exit 1; }; }'
)
_EXPECTED_STATUS = re.compile(r"(?P<command>.*\S)\s+# exit (?P<status>\d+(?: or \d+)*)$")


def script(document_blocks: list[Block]) -> str:
    lines = [_PROLOGUE]
    for block in document_blocks:
        lines += [""] * (block.line - 1 - len(lines))
        lines += _with_expected_statuses(block)
    return "\n".join(lines) + "\n"


def _with_expected_statuses(block: Block) -> list[str]:
    lines = list(block.commands)
    for index, line in enumerate(lines):
        match = _EXPECTED_STATUS.match(line)
        if not match:
            continue
        first = index
        while first > 0 and lines[first - 1].endswith("\\"):
            first -= 1
        lines[index] = match["command"]
        lines[first] = "status=0; " + lines[first]
        place = block.line + first
        lines[index] += f" || status=$?; expect '{match['status']}' $status {place}"
    return lines


def check_setup_block(block: Block, root: pathlib.Path) -> None:
    for number, line in enumerate(block.commands, block.line):
        command = re.sub(r"(^|\s)#.*", "", line).split()
        if not command:
            continue
        if command[0] not in SETUP_COMMANDS:
            raise DocumentError(
                number, f"`{command[0]}` must run: only {' and '.join(SETUP_COMMANDS)} may not"
            )
        program = root / command[0]
        if not os.access(program, os.X_OK):
            raise DocumentError(number, f"{command[0]} is not there, or not executable")
        done = subprocess.run([program, "--help"], capture_output=True, check=False)
        if done.returncode != 0 or not done.stdout:
            raise DocumentError(number, f"{command[0]} has no --help")


def runnable(document_blocks: list[Block], root: pathlib.Path) -> list[Block]:
    """The blocks to run. Checks the others."""
    found = []
    for block in document_blocks:
        language, _, rest = block.info.partition(" ")
        if language in ("bash", "shell", "console"):
            raise DocumentError(block.line - 1, "write ```sh, so that the block is run")
        if language == "sh" and rest == "no-run":
            check_setup_block(block, root)
        elif language == "sh" and rest:
            raise DocumentError(block.line - 1, f"`sh {rest}`: only `sh` and `sh no-run` are known")
        elif language == "sh":
            found.append(block)
    return found


def copy_repository(root: pathlib.Path, scratch: pathlib.Path, folder: str = "") -> None:
    """Only the files whose path starts with `folder`; no goldens of cases."""
    shutil.rmtree(scratch, ignore_errors=True)
    for path in repository.files(root):
        if not path.startswith(folder) or path.startswith(GOLDENS_OF_CASES):
            continue
        target = scratch / path
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(root / path, target)


def run(document: str, root: pathlib.Path, scratch: pathlib.Path, environment: dict) -> int:
    text = (root / document).read_text(encoding="utf-8")
    try:
        to_run = runnable(blocks(text), root)
    except DocumentError as error:
        print(f"{document}:{error.line}: {error}")
        return 1
    if not to_run:
        print(f"{document}: nothing to run")
        return 0
    of_starter = document.startswith("controller/starters/")
    copy_repository(root, scratch, "controller/" if of_starter else "")
    folder = (scratch / document).parent if of_starter else scratch
    if of_starter:
        (folder / "include").mkdir()
        for header in (scratch / "controller").glob("*.h"):
            shutil.copy2(header, folder / "include")
    # A file, because commands may read their standard input.
    commands = scratch.with_name(scratch.name + ".sh")
    commands.write_text(script(to_run), encoding="utf-8")
    done = subprocess.run(
        ["bash", commands],
        stdin=subprocess.DEVNULL,
        cwd=folder,
        env={**environment, "DOCUMENT": document},
        check=False,
    )
    return 1 if done.returncode else 0


def environment_of(arguments: argparse.Namespace) -> dict[str, str]:
    environment = dict(os.environ)
    if arguments.bin:
        environment["PATH"] = f"{arguments.bin.resolve()}:{environment['PATH']}"
    if arguments.prefix:  # for find_package(attest)
        environment["CMAKE_PREFIX_PATH"] = str(arguments.prefix.resolve())
    return environment


def extracted_suite(scratch: pathlib.Path, environment: dict[str, str]) -> pathlib.Path:
    """A copy of the installed suite as a folder, because `bless` does not change an archive."""
    suite = scratch.with_name(scratch.name + ".suite")
    shutil.rmtree(suite, ignore_errors=True)
    subprocess.run(
        ["attest", "list", "--extract", suite], env=environment, check=True, capture_output=True
    )
    return suite


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("document", help="relative to the root of the repository")
    parser.add_argument("--bin", type=pathlib.Path, help="folder of the attest binary")
    parser.add_argument("--prefix", type=pathlib.Path, help="where attest is installed")
    parser.add_argument("--need", action="append", default=[], help="skip without this program")
    parser.add_argument(
        "--extract-suite", action="store_true", help="for documents that bless goldens"
    )
    parser.add_argument("--scratch", type=pathlib.Path, required=True)
    arguments = parser.parse_args()
    for tool in arguments.need:
        if shutil.which(tool) is None:
            print(f"skipped: {tool} is not installed")
            return SKIPPED
    scratch = arguments.scratch.resolve()
    environment = environment_of(arguments)
    if arguments.extract_suite:
        environment["ATTEST_SUITE"] = str(extracted_suite(scratch, environment))
    return run(arguments.document, repository.ROOT, scratch, environment)


if __name__ == "__main__":
    sys.exit(main())
