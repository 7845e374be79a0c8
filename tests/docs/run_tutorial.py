#!/usr/bin/env python3
"""Runs a tutorial: run_tutorial.py PAGE.md SEARCHLIGHT

In the page, an HTML comment before a fenced block says what the block is:

    <!-- file: NAME -->     the block is written to NAME
    <!-- same as: PATH -->  as well as the above: the block is the file PATH, beside the page
    <!-- run -->            its commands succeed; <!-- run: N --> they end with exit code N
    <!-- output -->         the commands before it printed these lines, in this order; "..." stands for anything

A block without such a comment is an error, so that nothing is left out. Everything happens in an empty folder, with
SEARCHLIGHT first in PATH. Exits 77 where OpenGL is missing.
"""
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

BLOCK = re.compile(r"(?P<marks>(?:^<!--.*?-->\n)*)^```(?P<language>\w*)\n(?P<text>.*?)^```$", re.M | re.S)
DEVICE_MISSING = 4
SKIPPED = 77


class Wrong(Exception):
    pass


def matches(expected, line):
    pattern = ".*".join(re.escape(" ".join(part.split())) for part in expected.split("..."))
    return re.search("^ ?" + pattern + "$", " ".join(line.split())) is not None


def check_output(expected, printed, where):
    lines = iter(printed.splitlines())
    for wanted in expected.splitlines():
        if wanted.strip() not in ("", "...") and not any(matches(wanted, line) for line in lines):
            raise Wrong(f"{where}: no line like\n    {wanted}\nfollows in\n{printed}")


def run_commands(commands, expected_code, folder, environment, where):
    # -e: the first command that fails ends the block. pipefail is left out: `| head` is no failure.
    done = subprocess.run(["bash", "-ec", commands], cwd=folder, env=environment, text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    if done.returncode == DEVICE_MISSING and expected_code != DEVICE_MISSING:
        print(f"skipped: {done.stdout.strip()}")
        sys.exit(SKIPPED)
    if done.returncode != expected_code:
        raise Wrong(f"{where}: exit code {done.returncode} instead of {expected_code} from\n{commands}{done.stdout}")
    return done.stdout


def run_page(page, searchlight):
    text = page.read_text()
    environment = dict(os.environ, PATH=f"{searchlight.parent}:{os.environ['PATH']}")
    printed, runs = "", 0
    with tempfile.TemporaryDirectory() as folder:
        for block in BLOCK.finditer(text):
            where = f"{page.name}:{text.count(chr(10), 0, block.start('language')) + 1}"
            marks = re.findall(r"<!-- *(\w[\w ]*?)(?:: *(.*?))? *-->", block["marks"])
            if not marks:
                raise Wrong(f"{where}: a block without a mark")
            for kind, value in marks:
                if kind == "file":
                    (Path(folder) / value).write_text(block["text"])
                elif kind == "same as":
                    if (page.parent / value).read_text() != block["text"]:
                        raise Wrong(f"{where}: differs from {value}")
                elif kind == "run":
                    printed = run_commands(block["text"], int(value or 0), folder, environment, where)
                    runs += 1
                elif kind == "output":
                    check_output(block["text"], printed, where)
                else:
                    raise Wrong(f"{where}: unknown mark '{kind}'")
    if runs == 0:
        raise Wrong(f"{page.name}: nothing to run")
    return runs


def main():
    page, searchlight = Path(sys.argv[1]), Path(sys.argv[2]).resolve()
    try:
        print(f"{run_page(page, searchlight)} blocks of commands ran as {page.name} says")
    except Wrong as wrong:
        sys.exit(str(wrong))


if __name__ == "__main__":
    main()
