#!/usr/bin/env python3
"""Every edit of mutations.py can be made, changes something, and names tests that exist; tests/mutation/run finds a planted
regression in a small project, and a failing test that fails anyway finds nothing.

usage: mutation_test.py SOURCE_DIR
"""
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(sys.argv[1]).resolve()
sys.dont_write_bytecode = True
sys.path.insert(0, str(SOURCE / "tests/mutation"))
from mutations import MUTATIONS  # noqa: E402

PROJECT = """cmake_minimum_required(VERSION 3.25)
project(small NONE)
enable_testing()
add_custom_target(checked)
add_test(NAME First.Reads COMMAND grep -q first ${CMAKE_SOURCE_DIR}/text)
add_test(NAME Second.Reads COMMAND grep -q second ${CMAKE_SOURCE_DIR}/text)
add_test(NAME First.FailsAnyway COMMAND false)
"""
PRESETS = {"version": 6, "configurePresets": [{"name": "release", "generator": "Ninja", "binaryDir": "${sourceDir}/build"}]}
PLANTED = """
import sys
sys.path.insert(0, {folder!r})
from real_mutations import Mutation
MUTATIONS = [Mutation("first", "seen by the first tests", "text", "first", "1st", ("checked",), "^First"),
             Mutation("second", "seen by all tests", "text", "second", "2nd", ("checked",), "^First"),
             Mutation("third", "seen by none", "text", "third", "3rd", ("checked",), "^First")]
"""


class Edits(unittest.TestCase):
    def test_there_are_at_least_ten_and_each_can_be_made(self):
        self.assertGreaterEqual(len(MUTATIONS), 10)
        self.assertEqual(len({mutation.name for mutation in MUTATIONS}), len(MUTATIONS))
        for mutation in MUTATIONS:
            self.assertIsNone(mutation.fault(SOURCE))
            self.assertNotEqual(mutation.old, mutation.new)

    def test_a_moved_text_and_a_missing_file_are_found(self):
        with tempfile.TemporaryDirectory() as name:
            root = pathlib.Path(name)
            mutation = MUTATIONS[0]
            self.assertIn("not found", mutation.fault(root))
            (root / mutation.file).parent.mkdir(parents=True)
            (root / mutation.file).write_text(mutation.old + mutation.old)
            self.assertIn("occurs 2 times", mutation.fault(root))

    def test_the_first_tests_exist(self):
        texts = [file.read_text() for file in (SOURCE / "tests").rglob("*_test.cc")]
        names = {f"{suite}.{test}" for text in texts for suite, test in re.findall(r"^TEST(?:_F|_P)?\((\w+), *(\w+)\)", text, re.M)}
        for file in (SOURCE / "tests").rglob("CMakeLists.txt"):
            names.update(re.findall(r"add_test\(NAME ([\w.]+)", file.read_text()))
        for mutation in MUTATIONS:
            self.assertTrue(any(re.search(mutation.first, name) for name in names), mutation.name)


class Command(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = pathlib.Path(folder.name).resolve()
        self.root = self.path / "project"
        (self.root / "tests/mutation").mkdir(parents=True)
        shutil.copy(SOURCE / "tests/mutation/run", self.root / "tests/mutation")
        shutil.copy(SOURCE / "tests/mutation/mutations.py", self.root / "tests/mutation/real_mutations.py")
        (self.root / "tests/mutation/mutations.py").write_text(PLANTED.format(folder=str(self.root / "tests/mutation")))
        (self.root / "CMakeLists.txt").write_text(PROJECT)
        (self.root / "CMakePresets.json").write_text(json.dumps(PRESETS))
        (self.root / "text").write_text("first\nsecond\nthird\n")
        for words in (["init", "--quiet"], ["add", "-A"], ["commit", "--quiet", "-m", "Project"]):
            subprocess.run(["git", "-c", "user.name=test", "-c", "user.email=test@example.org", *words], cwd=self.root, check=True)

    def run_check(self, *more):
        command = [sys.executable, "tests/mutation/run", "--clone", self.path / "clone", "--out", self.path / "out", *more]
        return subprocess.run(command, cwd=self.root, capture_output=True, text=True)

    def rows(self):
        return {row["name"]: row for row in json.loads((self.path / "out/mutations.json").read_text())["rows"]}

    def test_regressions_are_found_by_the_first_tests_by_all_or_not(self):
        done = self.run_check()
        self.assertEqual(done.returncode, 1, done.stderr)
        rows = self.rows()
        self.assertEqual([(row["caught"], row["tests"], row["all_min"] is None) for row in rows.values()],
                         [(True, ["First.Reads"], True), (True, ["Second.Reads"], False), (False, [], False)])
        self.assertEqual((self.path / "clone/text").read_text(), "first\nsecond\nthird\n")
        again = self.run_check()
        self.assertEqual((again.returncode, again.stderr), (1, ""))  # nothing is run twice
        self.assertEqual(self.run_check("--only", "first").returncode, 0)

    def test_a_folder_that_it_did_not_make_is_refused(self):
        (self.path / "clone").mkdir()
        (self.path / "clone/mine").write_text("mine")
        self.assertEqual(self.run_check().returncode, 2)
        self.assertEqual((self.path / "clone/mine").read_text(), "mine")

    def test_wrong_calls_are_2(self):
        for wrong in (["--only", "nothing"], ["--list", "--check"], ["--nothing"]):
            self.assertEqual(self.run_check(*wrong).returncode, 2, wrong)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v"])
