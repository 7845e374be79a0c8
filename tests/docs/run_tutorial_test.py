#!/usr/bin/env python3
"""The runner of tutorials must be able to fail."""
import os
import tempfile
import unittest
from pathlib import Path

from run_tutorial import Wrong, run_page


class RunnerOfTutorials(unittest.TestCase):
    def run_text(self, text):
        with tempfile.TemporaryDirectory() as folder:
            program = Path(folder) / "searchlight"
            program.write_text("#!/bin/sh\necho 'value   1.25 mm'\nexit ${1:-0}\n")
            os.chmod(program, 0o755)
            page = Path(folder) / "page.md"
            page.write_text(text)
            return run_page(page, program)

    def test_runs_the_program_of_the_build(self):
        run = "<!-- run -->\n```sh\nsearchlight\n```\n<!-- output -->\n"
        self.assertEqual(self.run_text(run + "```text\nvalue 1.25 mm\n```\n"), 1)

    def test_a_failing_command_is_wrong(self):
        with self.assertRaises(Wrong):
            self.run_text("<!-- run -->\n```sh\nsearchlight 3\n```\n")

    def test_a_promised_failure_has_to_happen(self):
        self.assertEqual(self.run_text("<!-- run: 3 -->\n```sh\nsearchlight 3\n```\n"), 1)
        with self.assertRaises(Wrong):
            self.run_text("<!-- run: 3 -->\n```sh\nsearchlight\n```\n")

    def test_missing_output_is_wrong(self):
        run = "<!-- run -->\n```sh\nsearchlight\n```\n<!-- output -->\n"
        self.assertEqual(self.run_text(run + "```text\nvalue ... mm\n```\n"), 1)
        with self.assertRaises(Wrong):
            self.run_text(run + "```text\nvalue 1.26 mm\n```\n")

    def test_a_block_without_a_mark_is_wrong(self):
        with self.assertRaises(Wrong):
            self.run_text("<!-- run -->\n```sh\nsearchlight\n```\n\n```sh\nrm everything\n```\n")

    def test_a_block_that_is_not_the_file_is_wrong(self):
        with self.assertRaises(Wrong):
            self.run_text("<!-- run -->\n```sh\ntrue\n```\n<!-- same as: page.md -->\n```text\nother\n```\n")


if __name__ == "__main__":
    unittest.main()
