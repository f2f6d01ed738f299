#!/usr/bin/env python3
"""Checks that a wrong command fails at its line of the document, and that right documents pass."""

import contextlib
import io
import os
import pathlib
import sys
import tempfile
import textwrap
import unittest

import docs


class Documents(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name) / "repository"
        self.write("cases/a.toml", "why = 'to be seen'\n")

    def write(self, path: str, text: str, mode: int = 0o644) -> None:
        target = self.root / path
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(textwrap.dedent(text))
        target.chmod(mode)

    def run_document(self, text: str, path: str = "README.md") -> tuple[int, str]:
        """The exit status and all output."""
        self.write(path, text)
        said = io.StringIO()
        with tempfile.TemporaryFile("w+") as errors:
            saved = os.dup(2)
            os.dup2(errors.fileno(), 2)
            try:
                with contextlib.redirect_stdout(said):
                    status = docs.run(
                        path, self.root, self.root.parent / "scratch", dict(os.environ)
                    )
            finally:
                os.dup2(saved, 2)
                os.close(saved)
            errors.seek(0)
            return status, said.getvalue() + errors.read()

    def assert_passes(self, text: str, path: str = "README.md"):
        status, said = self.run_document(text, path)
        self.assertEqual((status, said), (0, ""))

    def assert_fails(self, text: str, message: str, path: str = "README.md"):
        status, said = self.run_document(text, path)
        self.assertEqual(status, 1)
        self.assertIn(message, said)

    def test_blocks_share_a_shell_at_the_root_of_a_copy(self):
        self.assert_passes(
            """\
            ```sh
            test -f cases/a.toml
            echo changed > cases/a.toml
            cd cases
            ```
            ```toml
            false
            ```
            ```sh
            grep -q changed a.toml
            ```
            """
        )
        self.assertIn("seen", (self.root / "cases/a.toml").read_text())

    def test_a_starter_runs_in_its_folder(self):
        self.write("controller/a.h", "")
        text = (
            "```sh\ntest -f README.md\ntest -f ../../a.h\ntest -f include/a.h\n"
            "test -e ../../../cases # exit 1\n```\n"
        )
        self.assert_passes(text, "controller/starters/c/README.md")

    def test_a_failing_command_is_named_with_its_line(self):
        self.assert_fails("# Title\n\n```sh\ntrue\nfalse\n```\n", "README.md:5: exit status 1")
        self.assert_fails("\n```sh\ntrue\n```\n\n```sh\nfalse | cat\n```\n", "README.md:7:")
        self.assert_fails("```sh\nno_such_command_here\n```\n", "README.md:2: exit status 127")
        self.assert_fails("```sh\necho $no_such_variable\n```\n", "no_such_variable")

    def test_expected_exit_status(self):
        self.assert_passes("```sh\nfalse  # exit 1\nbash -c 'exit 3' # exit 3\n```\n")
        self.assert_passes("```sh\nbash -c \\\n  'exit 2'  # exit 2\n```\n")
        self.assert_passes("```sh\nfalse  # exit 0 or 1\ntrue  # exit 0 or 1\n```\n")
        self.assert_fails(
            "```sh\nfalse  # exit 0 or 2\n```\n", "README.md:2: exit status 1 instead of 0 or 2"
        )
        self.assert_fails("```sh\ntrue  # exit 1\n```\n", "README.md:2: exit status 0 instead of 1")
        self.assert_fails("```sh\ntrue\nbash -c \\\n  'exit 3'  # exit 2\n```\n", "README.md:3:")

    def test_commands_do_not_eat_the_script(self):
        self.assert_fails("```sh\ncat\nfalse\n```\n", "README.md:3:")

    def test_setup_commands_are_asked_for_help(self):
        self.write("ci/check", "#!/bin/sh\n[ $1 = --help ] && echo usage\n", 0o755)
        self.assert_passes("```sh no-run\nci/check --clang  # both\n```\n\n```sh\ntrue\n```\n")
        self.assert_fails("```sh no-run\nci/quickstart\n```\n", "README.md:2: ci/quickstart is not")
        self.write("ci/quickstart", "#!/bin/sh\nexit 2\n", 0o755)
        self.assert_fails("```sh no-run\nci/quickstart\n```\n", "has no --help")

    def test_nothing_else_escapes(self):
        self.assert_fails("```sh no-run\nmake\n```\n", "README.md:2: `make` must run")
        self.assert_fails("```bash\nmake\n```\n", "README.md:1: write ```sh")
        self.assert_fails("```sh skip\nmake\n```\n", "README.md:1: `sh skip`")
        self.assert_fails("text\n```sh\nmake\n", "README.md:2: this block is never closed")


if __name__ == "__main__":
    sys.exit(unittest.main())
