"""Commands that a check of the tests runs."""

import pathlib
import subprocess


class Broken(Exception):
    """A mistake cannot be made, or its code does not compile."""


def execute(command: list, folder: pathlib.Path, what: str) -> None:
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise Broken(f"{what}\n{done.stdout}{done.stderr}")
