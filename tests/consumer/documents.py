#!/usr/bin/env python3
"""The installed documents: `documents.py INSTALLED SOURCE`. Each document in docs/ is there, and
each link leads to a file or folder that is there, or to one of attest's own sources. Exits 1 if
not."""

import pathlib
import re
import sys

# Folders of the source tree whose files only people who change attest open.
SOURCES = ("controller/faults", "harness", "tests")


def problems(installed: pathlib.Path, source: pathlib.Path):
    for document in (source / "docs").glob("*.md"):
        if not (installed / "docs" / document.name).exists():
            yield f"docs/{document.name} is not installed"
    for document in installed.rglob("*.md"):
        for link in re.findall(r"\]\((?!\w+:)([^)#\s]+)", document.read_text(encoding="utf-8")):
            target = (document.parent / link).resolve()
            path = target.relative_to(installed.resolve()).as_posix()
            is_document = target.suffix in (".md", ".json", ".h")
            if not target.exists() and (is_document or not path.startswith(SOURCES)):
                yield f"{document.relative_to(installed)}: {link} is not installed"


def main() -> int:
    found = list(problems(pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])))
    print("\n".join(found))
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
