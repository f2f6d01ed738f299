#!/usr/bin/env python3
"""Checks that each rule fails on a bad snippet and passes on a good one."""

import sys
import unittest

import cxx
import rules
import vocabulary
from tree import Tree

LONG_LINE = "x" * 101
PURPOSE = "// What this is for.\n#pragma once\n"


def function_of(lines: int) -> str:
    return "int f() {\n" + "  g();\n" * (lines - 2) + "}\n"


# rule: (files that break it, files that keep it). The finding names the first file of the former.
EXAMPLES = {
    "line_length": [
        ({"harness/core/a.cpp": f"// {LONG_LINE}\n"}, {"golden/README.md": f"{LONG_LINE}\n"}),
        ({"CMakeLists.txt": f"# {LONG_LINE}\n"}, {"a.cpp": "x" * 100 + "\n"}),
        ({"ci/check": f"#!/bin/sh\n# {LONG_LINE}\n"}, {"a.py": "x = 1\n"}),
    ],
    "function_length": [
        ({"a.cpp": function_of(71)}, {"a.cpp": function_of(70) * 3}),
        ({"a.c": "struct s {\n};\nstatic " + function_of(80)}, {"a.c": "int table[] = {1,\n 2};"}),
    ],
    "file_length": [({"a.hpp": "\n" * 351}, {"a.hpp": "\n" * 350})],
    "harness_order": [
        (
            {"harness/core/a.cpp": '#include "harness/trace/trace.hpp"\n'},
            {"harness/trace/a.cpp": '#include "harness/core/a.hpp"\n// #include "harness/cli/a"\n'},
        ),
        ({"harness/newcomer/a.cpp": "\n"}, {"harness/cli/a.cpp": '#include "harness/host/a"\n'}),
        ({"harness/core/a.cpp": '#include "a.hpp"\n'}, {"harness/core/a.cpp": "#include <a>\n"}),
    ],
    "controller_stands_alone": [
        (
            {"controller/a.cpp": '#include "harness/core/result.hpp"\n'},
            {"controller/a.cpp": '#include "controller/b.hpp"\n#include <Eigen/Core>\n'},
        ),
        ({"controller/a.cpp": "#include <fmt/core.h>"}, {"controller/a.c": "#include <math.h>"}),
        ({"controller/a.c": "#include <unistd.h>\n"}, {"controller/a.cpp": "#include <array>"}),
        (
            {"controller/starters/c_program/law.c": "#include <unistd.h>\n"},
            {"controller/starters/c_program/host.c": "#include <unistd.h>\n"},
        ),
    ],
    "one_owner": [
        (
            {
                "harness/loop/b.cpp": "#include <mujoco/mujoco.h>\n",
                "harness/plant/a.cpp": "#include <mujoco/mujoco.h>\n",
            },
            {"harness/plant/a.cpp": "#include <mujoco/mujoco.h>\n", "harness/loop/b.cpp": ""},
        ),
        (
            {"harness/core/toml.hpp": "#include <toml++/toml.h>\n"},
            {"harness/core/toml.cpp": "#include <toml++/toml.h>\n"},
        ),
        (
            {"harness/loop/b.cpp": "dlopen(p, 0);", "harness/port/a.cpp": "::dlopen(p, 0);"},
            {"harness/port/a.cpp": "dlopen(p, 0);", "harness/loop/b.cpp": "// dlopen(p) does\n"},
        ),
        (
            {"harness/core/a.cpp": "json::parse(t);", "harness/host/b.cpp": "json::parse(t);"},
            {"harness/core/a.cpp": "nlohmann::json::parse(t);", "harness/host/b.cpp": ""},
        ),
        (
            {"harness/plant/a.hpp": "#include <arkode/arkode_erkstep.h>\n"},
            {"harness/plant/a.cpp": "#include <arkode/arkode_erkstep.h>\n"},
        ),
    ],
    "sources_are_built": [
        (
            {"core/dead.cpp": "", "core/CMakeLists.txt": "add_library(core a.cpp)"},
            {"core/a.cpp": "", "core/CMakeLists.txt": "add_library(core a.cpp)"},
        ),
        (
            {"core/a.cpp": "", "run/CMakeLists.txt": "add_library(run a.cpp)"},
            {"core/a.cpp": "", "run/CMakeLists.txt": "x(${PROJECT_SOURCE_DIR}/core/a.cpp)"},
        ),
        (
            {"board/start.c": "", "board/check": "cc main.c"},
            {"board/start.c": "", "board/check": "cc start.c"},
        ),
        (
            {"core/dead.hpp": PURPOSE},
            {
                "core/a.hpp": PURPOSE,
                "core/a.cpp": '#include "core/a.hpp"',
                "core/CMakeLists.txt": "foreach(name a b)\n x(${name}.cpp)",
            },
        ),
    ],
    "cmake_lists_by_hand": [
        ({"CMakeLists.txt": "file(GLOB sources *.cpp)"}, {"CMakeLists.txt": "file(GLOB a *.csv)"})
    ],
    "finished": [
        ({"README.md": "TO" "DO: write"}, {"ci/check": "mktemp -d XXXXXX\n"}),
        ({"cases/a.toml": "# FIX" "ME later"}, {"a.cpp": "// fixed\n"}),
    ],
    "plain_words": [
        ({"README.md": "A port beside it."}, {"cases/a.toml": "[yaw_beside_roll]\n"}),
        ({"a.cpp": "// a port is\n  // told the rate\n"}, {"a.cpp": "// is it told? besides\n"}),
        ({"a.cpp": 'f("both turn "\n  "by "\n "turns");'}, {"a.cpp": "by_turns(turns);\n"}),
        ({"ci/check": "# lasts for\n# ever\n"}, {"ci/check": "for each of ever more\n"}),
        ({"a.bats": '@test "All the same" {'}, {"LICENSE": "alike", "b/LICENSE": "alike"}),
        ({"golden/a.toml": "as of"}, {"golden/a/b/provenance.toml": "as of"}),
        ({"a.md": "as of the law"}, {"a.md": "the law as of v1.17"}),
    ],
    "no_machine_paths": [
        ({"README.md": "run `/ho" "me/me/attest`"}, {"README.md": "see build/work/a, ../tmp/b"}),
        ({"a.cpp": 'open("/t' 'mp/x.csv")'}, {"a.sh": "open $directory/tmp/x.csv"}),
    ],
    "header_shape": [
        ({"a.hpp": "#pragma once\nint f();\n"}, {"a.hpp": PURPOSE + "int f();\n"}),
        ({"a.hpp": "// Purpose.\nint f();\n"}, {"a.h": "/* It. */\n#ifndef A_H\n#define A_H\n"}),
        (
            {"a.hpp": "// Purpose.\n#include <b>\n#pragma once\n"},
            {"a.h": "/* SPDX-License-Identifier: BSD-3-Clause */\n" + PURPOSE},
        ),
        ({"a.h": "/* SPDX-License-Identifier: BSD-3-Clause */\n#pragma once\n"}, {}),
    ],
    "header_namespace": [
        (
            {"a.hpp": PURPOSE + "using namespace std;\n"},
            {"a.hpp": PURPOSE + "// no using namespace here\n", "a.cpp": "using namespace std;\n"},
        )
    ],
    "properties_can_fail": [
        (
            {"tests/a_test.cpp": "TEST(A, Holds) { rc::check([] {}); }\n"},
            {"tests/a_test.cpp": "RC_GTEST_PROP(A, Holds, ()) {}  // not rc::check()\n"},
        )
    ],
    "libraries_do_not_print": [
        (
            {"harness/core/a.cpp": "#include <iostream>\n"},
            {"harness/cli/a.cpp": "#include <iostream>\n"},
        ),
        (
            {"controller/a.cpp": "void f() { std::cout << 1; }\n"},
            {"harness/loop/a.cpp": "// not std::cout\n"},
        ),
    ],
    "links_resolve": [
        ({"docs/a.md": "[b](b.md)\n", "b.md": ""}, {"docs/a.md": "[b](../b.md)\n", "b.md": ""}),
        ({"a.md": "[b](docs#c)\n", "docs/b.md": ""}, {"a.md": "[b](docs)\n", "docs/b.md": ""}),
        ({"a.md": "[b](docs/c)\n"}, {"a.md": "[b](docs)\n", "docs/b.md": "[c](https://c.d)\n"}),
        (
            {"a.md": "[b](b.md#one)\n", "b.md": "## One, two\n"},
            {"a.md": "[b](b.md#one-two)\n", "b.md": "## One, two\n[b](#one-two)\n"},
        ),
    ],
}


class Rules(unittest.TestCase):
    def test_every_rule_has_examples(self):
        self.assertEqual({rule.__name__ for rule in rules.RULES}, set(EXAMPLES))

    def test_examples(self):
        for rule in rules.RULES:
            for bad, good in EXAMPLES[rule.__name__]:
                with self.subTest(rule=rule.__name__, bad=bad):
                    findings = list(rule(Tree(bad)))
                    self.assertTrue(findings, "passed what it must not")
                    self.assertEqual(findings[0].path, next(iter(bad)))
                with self.subTest(rule=rule.__name__, good=good):
                    self.assertEqual(list(rule(Tree(good))), [])

    def test_a_finding_says_where(self):
        (finding,) = rules.line_length(Tree({"a.cpp": f"\n\n// {LONG_LINE}\n"}))
        self.assertTrue(str(finding).startswith("a.cpp:3: 104 columns"), str(finding))

    def test_each_banned_phrase_is_found_with_its_replacement(self):
        for phrase, instead in vocabulary.INSTEAD.items():
            (finding,) = rules.plain_words(Tree({"a.md": f"\n{phrase.title()}."}))
            self.assertEqual(str(finding), f"a.md:2: `{phrase}`: write {instead}")


class Functions(unittest.TestCase):
    def names(self, text: str) -> list[tuple[str, int, int]]:
        return [tuple(function) for function in cxx.functions(text)]

    def test_free_function_counts_its_whole_declaration(self):
        self.assertEqual(self.names("\nint f(int a,\n      int b) {\n}\n"), [("f", 2, 4)])

    def test_members_are_found_and_types_are_not(self):
        text = "namespace a {\nstruct S : B {\n public:\n  int f() const { return {}; }\n};\n}\n"
        self.assertEqual(self.names(text), [("f", 4, 4)])

    def test_initialisers_are_not_functions(self):
        text = "int a[] = {f(1),\n 2};\nX x = g({1}, 2);\nenum class E { a };\nvoid h(X x = {});\n"
        self.assertEqual(self.names(text), [])

    def test_constructor_with_member_initialisers(self):
        text = "S::S(int a)\n    : a_{a}, b_(1) {\n  f();\n}\n"
        self.assertEqual(self.names(text), [("S::S", 1, 4)])

    def test_braces_in_comments_strings_and_directives(self):
        text = (
            'void f() {\n  g("}", \'}\', 1\'000); // }\n  /* } */ h(R"(})");\n}\n'
            "#define M(x) do { \\\n } while (0)\nvoid k() {}\n"
        )
        self.assertEqual(self.names(text), [("f", 1, 4), ("k", 7, 7)])

    def test_c_functions_inside_extern_c(self):
        text = 'extern "C" {\nstruct s *f(void) {\n  return 0;\n}\n}\n'
        self.assertEqual(self.names(text), [("f", 2, 4)])

    def test_requires_and_trailing_return(self):
        text = "template <class T>\nauto f(T t) noexcept -> int {\n}\nTEST(A, B) {\n}\n"
        self.assertEqual(self.names(text), [("f", 1, 3), ("TEST", 4, 5)])


if __name__ == "__main__":
    sys.exit(unittest.main())
