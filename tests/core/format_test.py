#!/usr/bin/env python3
"""tools/format finds and mends files that do not have the format of .clang-format. tools/test checks the project with it. .clang-tidy gives its reasons.

usage: format_test.py SOURCE_DIR

Exits with 77, which ctest counts as skipped, where clang-format 14 is not installed.
"""
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(sys.argv[1]).resolve()
NOT_AVAILABLE = 77
BADLY_FORMATTED = "#include <vector>\n#include <array>\nint  f( int x ){if(x) return 1;\n return 0;}\n"


def run_format(root, *arguments):
    return subprocess.run([root / "tools/format", *arguments], capture_output=True, text=True)


def make_tree(root):
    """A tree with the formatter and its settings, and no sources."""
    for part in ("src/core", "tests/core", "tools"):
        (root / part).mkdir(parents=True)
    shutil.copy(ROOT / ".clang-format", root)
    shutil.copy(ROOT / "tools/format", root / "tools")
    subprocess.run(["git", "init", "-q", root], check=True)


def is_available():
    with tempfile.TemporaryDirectory() as folder:
        make_tree(pathlib.Path(folder))
        return run_format(pathlib.Path(folder), "--check").returncode != NOT_AVAILABLE


class Format(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        make_tree(self.root)

    def test_a_planted_file_is_named_and_left_alone(self):
        planted = self.root / "src/core/planted.cc"
        planted.write_text(BADLY_FORMATTED)
        (self.root / "tests/core/good.h").write_text("int g(int x);\n")
        done = run_format(self.root, "--check")
        self.assertEqual((done.returncode, done.stdout), (1, "src/core/planted.cc\n"))
        self.assertEqual(planted.read_text(), BADLY_FORMATTED)

    def test_formatting_mends_it(self):
        planted = self.root / "tests/core/planted.h"
        planted.write_text(BADLY_FORMATTED)
        self.assertEqual(run_format(self.root).returncode, 0)
        self.assertEqual(planted.read_text(), "#include <array>\n#include <vector>\n"
                                              "int f(int x) {\n  if (x) return 1;\n  return 0;\n}\n")
        self.assertEqual(run_format(self.root, "--check").returncode, 0)

    def test_an_unknown_argument_is_refused(self):
        self.assertEqual(run_format(self.root, "--chek").returncode, 2)


class Tidy(unittest.TestCase):
    def test_every_check_that_is_off_has_a_reason_and_every_reason_a_check(self):
        text = (ROOT / ".clang-tidy").read_text()
        reasons = re.findall(r"^# ([a-z]+-[a-z0-9-]+): \S", text, re.M)
        off = re.findall(r"^  -([a-z]+-[a-z0-9-]+),?$", text, re.M)
        self.assertGreater(len(off), 10)
        self.assertEqual(reasons, off)


if __name__ == "__main__":
    if not is_available():
        print("clang-format 14 is not installed")
        sys.exit(NOT_AVAILABLE)
    unittest.main(argv=[sys.argv[0], "-v"])
