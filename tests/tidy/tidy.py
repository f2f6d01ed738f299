#!/usr/bin/env python3
"""Checks the style of the repository: `tidy.py [RULE...]`, all rules without arguments."""

import sys

import cxx
from rules import RULES
from tree import Tree


def function_statistics(tree: Tree) -> str:
    """The aim is a 90th percentile of 25 lines; the rule limits only the longest functions."""
    lengths = sorted(
        function.lines for path in tree.cxx() for function in cxx.functions(tree.text(path))
    )
    if not lengths:
        return "no functions"
    return (
        f"{len(lengths)} functions: 90th percentile {lengths[len(lengths) * 9 // 10]} lines,"
        f" longest {lengths[-1]}"
    )


def arrow_statistics(tree: Tree) -> str:
    """An arrow: files of a folder of harness/ include files of another. At most 110 is the aim."""
    arrows = {
        (path.split("/")[1], include.path.split("/")[1])
        for path in tree.cxx("harness/")
        for include in cxx.includes(tree.text(path))
        if include.path.startswith("harness/")
    }
    return f"{sum(a != b for a, b in arrows)} arrows between folders of harness/"


def main(names: list[str]) -> int:
    unknown = set(names) - {rule.__name__ for rule in RULES}
    if unknown:
        print(f"no such rule: {' '.join(sorted(unknown))}", file=sys.stderr)
        return 2
    tree = Tree()
    failed = False
    for rule in RULES:
        if names and rule.__name__ not in names:
            continue
        findings = list(rule(tree))
        print(f"{'FAILED' if findings else 'ok':7}{rule.__name__}")
        for finding in findings:
            print(f"  {finding}")
        failed = failed or bool(findings)
    print(function_statistics(tree))
    print(arrow_statistics(tree))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
