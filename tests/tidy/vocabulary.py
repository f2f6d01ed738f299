"""Words that the prose of the repository does not use, and their replacements."""

import re

INSTEAD = {
    "beside": "`next to` for a place; otherwise `in addition to` or `compared with`",
    "whoever": "the person or the program",
    "for ever": "`permanently`",
    "in earnest": "`realistic`, or delete it",
    "at the desk": "the place or the program: `in simulation`, `in a test`",
    "is told": "`receives`, `is given` or `is reported`",
    "are told": "`receive`, `are given` or `are reported`",
    "is blamed": "`is attributed to`",
    "alike": "`the same way`, `equally` or `both`",
    "as of": "`same as`",
    "nothing at all": "the empty value itself",
    "that is none": "`invalid`, `missing` or `not a ...`",
    "by turns": "`alternately`",
    "all the same": "`nevertheless`, or `equal`",
}

# Line breaks, markers of comments and the quotes of adjacent string literals do not hide a phrase.
_BETWEEN = r'[\s/*#>"+-]+'
_PHRASES = "|".join(_BETWEEN.join(phrase.split()) for phrase in INSTEAD)
# "as of" is right with a date or the name of a version, which may be a placeholder.
_VERSION = r"(?<=as of)\s(?:v\d|branch\b|\{)"
PATTERN = re.compile(rf"\b(?:{_PHRASES})\b(?!{_VERSION})", re.IGNORECASE)


def phrase_of(match: re.Match) -> str:
    return " ".join(re.findall(r"\w+", match[0])).lower()
