#!/usr/bin/env python3
"""`patrol study`: the same bytes however many work at it and however often it is broken off; what it cannot do is refused in a line.

usage: study_test.py PATROL SOURCE_DIR
"""
import csv
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest

PATROL, SOURCE = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
TABLES = ("results.csv", "runs.csv")


class Study(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.path = pathlib.Path(self.folder.name)

    def tearDown(self):
        self.folder.cleanup()

    def study(self, out, *more, name="ungm", seeds="6"):
        return subprocess.run([PATROL, "study", name, "--seeds", seeds, "--out", self.path / out, *more], capture_output=True, text=True, timeout=280, cwd=SOURCE)

    def tables(self, out):
        return [(self.path / out / name).read_bytes() for name in TABLES]

    def test_one_worker_and_two_give_the_same_tables_byte_for_byte(self):
        self.assertEqual(self.study("one", "--jobs", "1").returncode, 0)
        self.assertEqual(self.study("two", "--jobs", "2").returncode, 0)
        self.assertEqual(self.tables("one"), self.tables("two"))
        self.assertFalse((self.path / "one/INCOMPLETE").exists())

    def test_killed_and_gone_on_with_it_gives_the_same_tables(self):
        self.assertEqual(self.study("whole").returncode, 0)
        process = subprocess.Popen([PATROL, "study", "ungm", "--seeds", "6", "--jobs", "1", "--out", self.path / "broken"], stdout=subprocess.DEVNULL,
                                   stderr=subprocess.DEVNULL, cwd=SOURCE)
        deadline = time.monotonic() + 100
        while not list(self.path.glob("broken/seeds/*.json")) and time.monotonic() < deadline:
            time.sleep(0.01)
        process.send_signal(signal.SIGKILL)
        process.wait()
        self.assertTrue((self.path / "broken/INCOMPLETE").exists())
        self.assertFalse((self.path / "broken/results.csv").exists())
        self.assertEqual(self.study("broken").returncode, 0)
        self.assertEqual(self.tables("whole"), self.tables("broken"))

    def test_seeds_begin_beyond_those_that_methods_were_tuned_on(self):
        self.assertEqual(self.study("few", seeds="2").returncode, 0)
        with open(self.path / "few/runs.csv", newline="") as file:
            self.assertEqual({row["seed"] for row in csv.DictReader(file)}, {"1001", "1002"})

    def test_published_figures_stand_beside_ours_on_the_page_and_in_the_table(self):
        done = self.study("page", seeds="3")
        self.assertIn("4.222", done.stdout)
        page = (self.path / "page/report.html").read_text()
        self.assertIn("exact Bayes filter (the bound)", page)
        self.assertNotIn("http://", page.replace("http://www.w3.org", ""))
        with open(self.path / "page/results.csv", newline="") as file:
            self.assertEqual([row["published"] for row in csv.DictReader(file) if row["method"] == "PF" and row["particles"] == "50"][0], "4.2216")

    def test_report_hands_out_the_page_and_has_none_before_the_end(self):
        self.assertEqual(self.study("page", seeds="1").returncode, 0)
        subprocess.run([PATROL, "report", self.path / "page", "--out", self.path / "copy.html"], check=True, capture_output=True, cwd=SOURCE)
        self.assertEqual((self.path / "copy.html").read_bytes(), (self.path / "page/report.html").read_bytes())
        (self.path / "page/report.html").unlink()
        done = subprocess.run([PATROL, "report", self.path / "page"], capture_output=True, text=True, cwd=SOURCE)
        self.assertEqual(done.returncode, 2)
        self.assertIn("incomplete", done.stderr)

    def test_an_unknown_study_and_no_seeds_are_refused_and_nothing_is_written(self):
        for arguments, says in ((("golf",), "landmarks-circle"), (("ungm", "--seeds", "0"), "--seeds 0"), (("ungm", "--jobs", "-1"), "--jobs")):
            done = subprocess.run([PATROL, "study", *arguments, "--out", self.path / "none"], capture_output=True, text=True, timeout=60, cwd=SOURCE)
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertEqual(len(done.stderr.strip().splitlines()), 1, done.stderr)
            self.assertIn(says, done.stderr)
            self.assertFalse((self.path / "none").exists())


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v"])
