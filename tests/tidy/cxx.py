"""Finds comments, includes and functions of C and C++. It is a heuristic, not a parser: it relies
on the style of this repository and does not expand macros."""

import re
from typing import NamedTuple

_TOKEN = re.compile(
    r"""(?P<comment>//(?:[^\n\\]|\\.|\\\n)*|/\*.*?(?:\*/|\Z))
      |(?P<raw>R"(?P<mark>[^\s()\\]*)\(.*?\)(?P=mark)")
      |(?P<string>"(?:[^"\\\n]|\\.)*")
      |(?P<number>\d(?:'?[\w.])*)          # 1'000: not the start of a character
      |(?P<character>'(?:[^'\\\n]|\\.)*')
      |(?P<directive>(?m:^)[ \t]*\#(?:[^\n\\]|\\.|\\\n)*)""",
    re.VERBOSE | re.DOTALL,
)


class Include(NamedTuple):
    line: int
    quoted: bool
    path: str


class Function(NamedTuple):
    name: str
    first_line: int
    last_line: int

    @property
    def lines(self) -> int:
        return self.last_line - self.first_line + 1


def _spaces(text: str) -> str:
    return re.sub(r"[^\n]", " ", text)


def without_comments(text: str) -> str:
    """Comments become spaces; lines and columns stay."""

    def keep(match):
        if match["comment"]:
            return _spaces(match[0])
        if match["directive"]:
            return re.sub(r"//.*|/\*.*?\*/", lambda comment: _spaces(comment[0]), match[0])
        return match[0]

    return _TOKEN.sub(keep, text)


def code_only(text: str) -> str:
    """Comments, directives and quoted text become spaces; lines and columns stay."""

    def keep(match):
        if match["number"]:
            return match[0]
        if match["string"] or match["character"]:
            return match[0][0] + _spaces(match[0][1:-1]) + match[0][-1]
        return _spaces(match[0])

    return _TOKEN.sub(keep, text)


def includes(text: str) -> list[Include]:
    found = []
    for number, line in enumerate(without_comments(text).splitlines(), 1):
        match = re.match(r'\s*#\s*include\s*(["<])([^">]+)[">]', line)
        if match:
            found.append(Include(number, match[1] == '"', match[2]))
    return found


_CONTAINER = re.compile(r'\b(?:namespace|class|struct|union|enum)\b[^()]*$|\bextern\s*"\s*"\s*$')
_DECORATION = re.compile(r"\[\[.*?\]\]|\balignas\s*\([^()]*\)|\b__attribute__\s*\(\(.*?\)\)")
# `Foo(int a) : a_{1}` is at the brace of a member, not yet at that of the body.
_MEMBER_INIT = re.compile(r"\)\s*(?:noexcept\s*)?:(?!:)(?:.*[^:])?[\w>]\s*$", re.DOTALL)
_ACCESS = re.compile(r"\s*(?:public|private|protected)\s*$")


def _opens(head: str) -> str:
    """The kind of block that the brace after `head` opens, outside functions."""
    plain = _DECORATION.sub("", head)
    if plain.count("(") > plain.count(")"):
        return "initialiser"  # a default argument
    if _CONTAINER.search(plain):
        return "container"
    if "(" not in plain or plain.rstrip().endswith(("=", ",")) or _MEMBER_INIT.search(plain):
        return "initialiser"
    return "function"


def _closing(code: str, opening: int) -> int:
    depth = 0
    for place in range(opening, len(code)):
        depth += {"{": 1, "}": -1}.get(code[place], 0)
        if depth == 0:
            return place
    return len(code) - 1


def functions(text: str) -> list[Function]:
    """Function definitions, from the line where the declaration starts to its closing brace.
    Lambdas and local classes belong to the function around them."""
    code = code_only(text)
    found = []
    head, head_start, place = "", 0, 0
    while place < len(code):
        char = code[place]
        if char == "{" and (opened := _opens(head)) != "container":
            end = _closing(code, place)
            if opened == "function":
                first = code.count("\n", 0, head_start) + 1
                found.append(Function(_name(head), first, code.count("\n", 0, end) + 1))
                head = ""
            else:
                head += "{}"
            place = end
        elif char in "{};" and head.count("(") <= head.count(")"):
            head = ""
        elif char == ":" and _ACCESS.match(head):
            head = ""
        elif head or not char.isspace():
            if not head:
                head_start = place
            head += char
        place += 1
    return found


def _name(head: str) -> str:
    match = re.search(r"(operator\s*\S+?|[\w:~]+)\s*\(", head)
    return match[1] if match else "?"
