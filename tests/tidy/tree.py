"""The files that the rules look at."""

import pathlib
import posixpath
import sys
from typing import NamedTuple

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
import repository  # noqa: E402  (the path had to be set first)

CXX_HEADERS = (".h", ".hpp")
CXX = (".c", ".cpp", *CXX_HEADERS)
# Recorded numbers and reviewed output: made by programs, and large.
_DATA = (".csv", ".ulg", ".json", ".xml", ".html", ".svg", ".png")


class Finding(NamedTuple):
    path: str
    line: int
    message: str  # what is wrong, and what to do

    def __str__(self) -> str:
        return f"{self.path}:{self.line}: {self.message}"


class Tree:
    """Paths with their text. `texts` replaces the repository in the self-test."""

    def __init__(self, texts: dict[str, str] | None = None):
        files = repository.files() if texts is None else list(texts)
        self._texts = dict(_texts(files)) if texts is None else texts
        self._files = set(files)
        self._folders = {str(f) for file in files for f in pathlib.PurePosixPath(file).parents}

    def text(self, path: str) -> str:
        return self._texts[path]

    def paths(self) -> list[str]:
        return list(self._texts)

    def has(self, path: str) -> bool:
        """Also for data and for folders."""
        return path in self._files or path in self._folders

    def cxx(self, *under: str, suffixes: tuple[str, ...] = CXX) -> list[str]:
        """C and C++ files, all or those under one of the folders `under`."""
        return [
            path
            for path in self._texts
            if path.endswith(suffixes) and (not under or path.startswith(under))
        ]

    def cmake(self) -> list[str]:
        return [
            path
            for path in self._texts
            if posixpath.basename(path) == "CMakeLists.txt" or path.endswith(".cmake")
        ]

    def code(self) -> list[str]:
        """Sources that people write: C, C++, CMake, Python, Rust, shell, JavaScript, CSS."""
        cmake = set(self.cmake())
        return [
            path
            for path, text in self._texts.items()
            if path.endswith((*CXX, ".py", ".rs", ".sh", ".bats", ".js", ".css"))
            or path in cmake
            or text.startswith("#!")
        ]


def _texts(files: list[str]):
    for path in files:
        if path.endswith(_DATA) or path.startswith("tests/baselines/"):
            continue
        content = (repository.ROOT / path).read_bytes()
        if b"\0" not in content:
            yield path, content.decode("utf-8")
