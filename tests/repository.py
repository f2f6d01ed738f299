"""The files that belong to the repository."""

import os
import pathlib
import subprocess

ROOT = pathlib.Path(__file__).resolve().parent.parent

# What is a source before git tracks it. Not a log that someone directs into the tree.
_SOURCES = (".c", ".cpp", ".h", ".hpp", ".cmake", "CMakeLists.txt", ".py", ".rs", ".toml", ".md")

# What a build or a run leaves in the tree, where git is not there to say so.
_GENERATED = {".git", ".cache", "__pycache__", "reports", "target"}


def files(root: pathlib.Path = ROOT) -> list[str]:
    """Paths relative to `root`, sorted: what git tracks, and new sources. Without a git checkout (a
    release archive), everything that is not generated."""
    listed = _from_git(root)
    paths = listed if listed is not None else _from_walk(root)
    # A set, because a file in conflict is listed more than once. Files that were just deleted are
    # still in the index.
    return sorted(path for path in set(paths) if (root / path).is_file())


def _git(root: pathlib.Path, *arguments: str) -> str | None:
    # safe.directory: CI often checks out as one user and builds as another.
    command = ["git", "-c", "safe.directory=*", "-C", str(root), *arguments]
    try:
        done = subprocess.run(command, capture_output=True, text=True, check=False)
    except FileNotFoundError:
        return None
    return done.stdout if done.returncode == 0 else None


def _from_git(root: pathlib.Path) -> list[str] | None:
    top = _git(root, "rev-parse", "--show-toplevel")
    # A release archive that is unpacked inside another repository is not that repository.
    if top is None or pathlib.Path(top.strip()).resolve() != root.resolve():
        return None
    tracked = _git(root, "ls-files", "-z") or ""
    new = _git(root, "ls-files", "-z", "--others", "--exclude-standard") or ""
    return tracked.split("\0")[:-1] + [n for n in new.split("\0") if n.endswith(_SOURCES)]


def _from_walk(root: pathlib.Path) -> list[str]:
    found = []
    for folder, folders, names in os.walk(root):
        folders[:] = [f for f in folders if f not in _GENERATED and not f.startswith("build")]
        found += [(pathlib.Path(folder) / name).relative_to(root).as_posix() for name in names]
    return found
