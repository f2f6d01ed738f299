"""The style of the repository as rules. Each takes a Tree and yields Findings."""

import pathlib
import posixpath
import re

import cxx
import vocabulary
from tree import CXX_HEADERS, Finding, Tree

MAX_COLUMNS = 100
MAX_FUNCTION_LINES = 70
MAX_FILE_LINES = 350

# A folder of harness/ includes itself and those before it in this list.
HARNESS_ORDER = re.findall(
    r"add_subdirectory\((\w+)\)",
    (pathlib.Path(__file__).resolve().parents[2] / "harness/CMakeLists.txt").read_text(),
)


def line_length(tree: Tree):
    for path in tree.code():
        for number, line in enumerate(tree.text(path).splitlines(), 1):
            if len(line) > MAX_COLUMNS:
                yield Finding(path, number, f"{len(line)} columns: wrap at {MAX_COLUMNS}")


def function_length(tree: Tree):
    for path in tree.cxx():
        for function in cxx.functions(tree.text(path)):
            if function.lines > MAX_FUNCTION_LINES:
                yield Finding(
                    path,
                    function.first_line,
                    f"`{function.name}` has {function.lines} lines, more than"
                    f" {MAX_FUNCTION_LINES}: give its steps names of their own",
                )


def file_length(tree: Tree):
    for path in tree.cxx():
        lines = tree.text(path).count("\n")
        if lines > MAX_FILE_LINES:
            yield Finding(path, lines, f"more than {MAX_FILE_LINES} lines: one subject a file")


def harness_order(tree: Tree):
    for path in tree.cxx("harness/"):
        folder = path.split("/")[1]
        if folder not in HARNESS_ORDER:
            yield Finding(path, 1, f"harness/{folder} is not in harness/CMakeLists.txt: add it")
            continue
        for include in cxx.includes(tree.text(path)):
            parts = include.path.split("/")
            if include.quoted and parts[0] not in ("harness", "controller"):
                yield Finding(path, include.line, "write the path from the root of the repository")
            elif parts[0] == "harness" and parts[1] not in _reachable(folder):
                yield Finding(
                    path,
                    include.line,
                    f"{folder} includes {parts[1]}, which comes after it in"
                    f" `{' '.join(HARNESS_ORDER)}`: move what both need up",
                )


def _reachable(folder: str) -> list[str]:
    return HARNESS_ORDER[: HARNESS_ORDER.index(folder) + 1]


# <cmath> and <stdint.h> match, <unistd.h> does not: the law uses no clock, file or thread of the
# system.
_STANDARD = re.compile(r"[a-z_0-9]+|(?:float|math|stdbool|stddef|stdint|stdio|stdlib|string)\.h")


# They talk to attest with the functions of POSIX, and have no part of the law.
_HOST_PROGRAMS = (
    "controller/starters/c_program/host.c",
    "controller/starters/serial_board/uart_host.c",
)


def controller_stands_alone(tree: Tree):
    for path in tree.cxx("controller/"):
        if path in _HOST_PROGRAMS:
            continue
        for include in cxx.includes(tree.text(path)):
            own = include.quoted and not include.path.startswith(("harness/", "tests/"))
            # A starter is compiled against the installed headers.
            library = include.path.startswith(
                (
                    "Eigen/",
                    "tl/",
                    "attest_unit.h",
                    "attest_cascade.h",
                    "attest_law.h",
                    "attest_math.h",
                )
            )
            if not own and not library and not _STANDARD.fullmatch(include.path):
                yield Finding(
                    path,
                    include.line,
                    f"the controller includes {include.path}: it may include only Eigen,"
                    " tl::expected and the standard library",
                )


_OWNED_BY_ONE = {
    "MuJoCo": re.compile(r'\s*#\s*include\s*[<"]mujoco/'),
    "SUNDIALS": re.compile(r'\s*#\s*include\s*[<"](?:arkode|nvector|sun\w+)/'),
    "dlopen": re.compile(r".*\bdlopen\s*\("),
    "the parser of nlohmann_json": re.compile(r".*\bjson::parse\s*\("),
    "libmatio": re.compile(r'\s*#\s*include\s*[<"]matio\.h'),
    "zlib": re.compile(r'\s*#\s*include\s*[<"]zlib\.h'),
    "toml++": re.compile(r'\s*#\s*include\s*[<"]toml(?:\+\+|plusplus)?[./]'),
}


def one_owner(tree: Tree):
    for what, pattern in _OWNED_BY_ONE.items():
        users = []
        for path in tree.cxx("controller/", "harness/"):
            lines = cxx.without_comments(tree.text(path)).splitlines()
            users += [(path, number) for number, line in enumerate(lines, 1) if pattern.match(line)]
        owners = sorted({path for path, _ in users if path.endswith(".cpp")})
        folders = {path.rsplit("/", 1)[0] for path in owners}
        for path, number in users:
            if path not in owners or len(folders) > 1:
                yield Finding(
                    path,
                    number,
                    f"{what} belongs into the .cpp files of one folder (found in"
                    f" {', '.join(owners) or 'none'}): go through the interface of its owner",
                )


def sources_are_built(tree: Tree):
    # A starter that is cross-compiled is built by its script `check` only.
    lists = tree.cmake() + [path for path in tree.paths() if path.endswith("/check")]
    listed = {path: set(re.findall(r"[\w./${}+-]+", tree.text(path))) for path in lists}
    included = {i.path for path in tree.cxx() for i in cxx.includes(tree.text(path))}
    for path in tree.cxx():
        if path.endswith(CXX_HEADERS):
            if not any(path == i or path.endswith("/" + i) for i in included):
                yield Finding(path, 1, "no file includes this header: delete it, or use it")
        elif not any(_lists(cmake, words, path) for cmake, words in listed.items()):
            yield Finding(path, 1, "no CMakeLists.txt or check lists it: add it, or delete it")


def _lists(cmake: str, words: set[str], path: str) -> bool:
    folder = posixpath.dirname(cmake)
    relative = posixpath.relpath(path, folder or ".")
    if relative in words or f"${{PROJECT_SOURCE_DIR}}/{path}" in words:
        return True
    # foreach(name a b) ... ${name}.cpp
    stem, suffix = posixpath.splitext(relative)
    return stem in words and any(re.search(r"\$\{\w+\}" + re.escape(suffix), w) for w in words)


# Data and headers that a command depends on may be globbed; compiled sources may not.
_SOURCE_GLOB = re.compile(r"\bfile\s*\(\s*GLOB[^)]*\.(?:c|cpp)\b")


def cmake_lists_by_hand(tree: Tree):
    for path in tree.cmake():
        text = tree.text(path)
        for match in _SOURCE_GLOB.finditer(text):
            line = text.count("\n", 0, match.start()) + 1
            yield Finding(path, line, "no globbing: list the sources")


# In two halves, so that this file passes its own rule.
_UNFINISHED = re.compile(r"\b(?:TO" r"DO|FIX" r"ME|XX" r"X)\b")


def finished(tree: Tree):
    for path in tree.paths():
        for number, line in enumerate(tree.text(path).splitlines(), 1):
            if match := _UNFINISHED.search(line):
                yield Finding(path, number, f"{match[0]}: do it, or say why not as a plain comment")


# The list of the words, its test, and texts that are quoted as they were.
_FREE_WORDING = re.compile(
    r"tests/tidy/(?:vocabulary|selftest)\.py|golden/.+/provenance\.toml|(?:.+/)?LICENSE"
)


def plain_words(tree: Tree):
    for path in tree.paths():
        if _FREE_WORDING.fullmatch(path):
            continue
        text = tree.text(path)
        for match in vocabulary.PATTERN.finditer(text):
            line = text.count("\n", 0, match.start()) + 1
            phrase = vocabulary.phrase_of(match)
            yield Finding(path, line, f"`{phrase}`: write {vocabulary.INSTEAD[phrase]}")


_MACHINE_PATH = re.compile(r"(?<![\w.$})/-])/(?:home|root|work|tmp)/\w[\w./-]*")


def no_machine_paths(tree: Tree):
    for path in tree.paths():
        for number, line in enumerate(tree.text(path).splitlines(), 1):
            if match := _MACHINE_PATH.search(line):
                yield Finding(
                    path,
                    number,
                    f"{match[0]} exists on one machine: use a relative path, or ask for a"
                    " temporary folder",
                )


_PURPOSE = re.compile(r"//[^\n]*\w|/\*[\s*]*\w")
_SPDX = re.compile(r"\s*(?:/\*|//)\s*SPDX-License-Identifier:[^\n]*\n")
_GUARD = re.compile(r"^#pragma once$|^#ifndef (\w+)\n#define \1$", re.MULTILINE)


def header_shape(tree: Tree):
    for path in tree.cxx(suffixes=CXX_HEADERS):
        text = _SPDX.sub("", tree.text(path), count=1)
        if not _PURPOSE.match(text):
            yield Finding(path, 1, "a header starts with a comment that says what it is for")
        guard = _GUARD.search(text)
        first_include = text.find("#include")
        if not guard or -1 < first_include < guard.start():
            yield Finding(path, 1, "no `#pragma once` (or guard) ahead of the first include")


def header_namespace(tree: Tree):
    for path in tree.cxx(suffixes=CXX_HEADERS):
        for number, line in enumerate(cxx.code_only(tree.text(path)).splitlines(), 1):
            if re.search(r"\busing\s+namespace\b", line):
                yield Finding(path, number, "`using namespace` in a header: write the names out")


def properties_can_fail(tree: Tree):
    """rc::check() returns whether a property holds; it does not fail the test around it."""
    for path in tree.cxx("tests/"):
        for number, line in enumerate(cxx.code_only(tree.text(path)).splitlines(), 1):
            if re.search(r"\brc::check\s*\(", line):
                yield Finding(path, number, "`rc::check()` fails no test: use RC_GTEST_PROP")


_CONSOLE = re.compile(r"\s*#\s*include\s*<iostream>|.*\bstd::(?:cout|cerr|clog|cin)\b")


def libraries_do_not_print(tree: Tree):
    for path in tree.cxx("controller/", "harness/"):
        if path.startswith("harness/cli/"):
            continue
        for number, line in enumerate(cxx.without_comments(tree.text(path)).splitlines(), 1):
            if _CONSOLE.match(line):
                yield Finding(
                    path, number, "only harness/cli has the terminal: return it, or take a sink"
                )


_LINK = re.compile(r"\]\((?!\w+:)([^)#\s]*)(?:#([^)\s]*))?\)")


def links_resolve(tree: Tree):
    for path in (path for path in tree.paths() if path.endswith(".md")):
        for number, line in enumerate(tree.text(path).splitlines(), 1):
            for file, heading in _LINK.findall(line):
                target = posixpath.normpath(posixpath.join(posixpath.dirname(path), file))
                target = target if file else path
                if not tree.has(target):
                    yield Finding(path, number, f"link to {file}: the file does not exist")
                elif heading and heading not in _anchors(tree, target):
                    yield Finding(path, number, f"link to #{heading}: {target} has no such heading")


def _anchors(tree: Tree, document: str) -> set[str]:
    """Of the headings, as GitHub and GitLab write them. Other files and folders have none."""
    text = tree.text(document) if document.endswith(".md") else ""
    headings = re.findall(r"^#+ (.*)$", text, re.MULTILINE)
    return {re.sub(r"[^\w -]", "", heading).lower().replace(" ", "-") for heading in headings}


RULES = (
    line_length,
    function_length,
    file_length,
    harness_order,
    controller_stands_alone,
    one_owner,
    sources_are_built,
    cmake_lists_by_hand,
    finished,
    plain_words,
    no_machine_paths,
    header_shape,
    header_namespace,
    properties_can_fail,
    libraries_do_not_print,
    links_resolve,
)
