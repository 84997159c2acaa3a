#!/usr/bin/env python3
"""A run that is killed in the middle leaves a red junit.xml, its mark, and a log that opens.

usage: killed_run_test.py PATROL SCENARIO
"""
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time
import unittest
import xml.etree.ElementTree

from mcap.exceptions import EndOfFile
from mcap.records import Message
from mcap.stream_reader import StreamReader

PATROL, SCENARIO = sys.argv[1], sys.argv[2]
ENOUGH_BYTES = 1_000_000  # of log: some seconds into the run


class KilledRun(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.run_directory = pathlib.Path(cls.folder.name) / "run"
        cls.log = cls.run_directory / "log.mcap"
        with subprocess.Popen([PATROL, "run", SCENARIO, "--out", str(cls.run_directory)],
                              stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as run:
            deadline = time.monotonic() + 120
            while not cls.log.exists() or cls.log.stat().st_size < ENOUGH_BYTES:
                if run.poll() is not None or time.monotonic() > deadline:
                    run.kill()
                    raise AssertionError("the run did not write its log")
                time.sleep(0.02)
            run.kill()  # SIGKILL: no chance to tidy up

    def test_junit_is_red(self):
        suites = xml.etree.ElementTree.parse(self.run_directory / "junit.xml").getroot()
        self.assertEqual(suites.get("errors"), "1")
        self.assertIsNotNone(suites.find(".//error"))

    def test_the_directory_is_marked_incomplete(self):
        self.assertTrue((self.run_directory / "INCOMPLETE").exists())
        self.assertFalse((self.run_directory / "metrics.json").exists())

    def test_the_log_opens_up_to_the_cut(self):
        count, last = 0, 0
        with open(self.log, "rb") as file:
            try:
                for record in StreamReader(file).records:
                    if isinstance(record, Message):
                        count, last = count + 1, record.log_time
            except EndOfFile:
                pass  # the cut
        self.assertGreater(count, 1000)
        self.assertGreater(last, 1_000_000_000, "more than a second of messages")

    def test_another_run_may_take_the_place_of_what_is_left(self):
        with tempfile.TemporaryDirectory() as folder:
            again = pathlib.Path(folder) / "run"
            shutil.copytree(self.run_directory, again)
            command = [PATROL, "run", SCENARIO, "--out", str(again)]
            done = subprocess.run(command, capture_output=True, text=True, timeout=280)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertFalse((again / "INCOMPLETE").exists())

    def test_patrol_itself_says_that_the_run_is_incomplete(self):
        done = subprocess.run([PATROL, "score", str(self.run_directory)], capture_output=True, text=True, timeout=120)
        self.assertNotEqual(done.returncode, 0)
        self.assertEqual(len(done.stderr.strip().splitlines()), 1, done.stderr)

    def test_its_report_says_incomplete_first(self):
        page = pathlib.Path(self.folder.name) / "report.html"
        done = subprocess.run([PATROL, "report", str(self.run_directory), "--out", str(page)], capture_output=True, text=True, timeout=120)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn('<p class="word">INCOMPLETE</p>', page.read_text())


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v"])
