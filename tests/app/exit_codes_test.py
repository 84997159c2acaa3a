#!/usr/bin/env python3
"""Scripts build on the exit codes and on what a run leaves behind: 0 as expected, 1 an expectation missed, 3 interrupted, 4 time limit.

usage: exit_codes_test.py PATROL SOURCE_DIR
"""
import json
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest
import xml.etree.ElementTree

from standing_still import PATROL, SOURCE, standing_still


class ExitCodes(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.path = pathlib.Path(self.folder.name)
        self.out = self.path / "run"

    def tearDown(self):
        self.folder.cleanup()

    def scenario(self, more):
        return standing_still(self.path, more)

    def run_patrol(self, more):
        command = [PATROL, "run", self.scenario(more), "--out", self.out]
        return subprocess.run(command, capture_output=True, text=True, timeout=120, cwd=SOURCE)

    def junit(self):
        return xml.etree.ElementTree.parse(self.out / "junit.xml").getroot()

    def assert_complete(self):
        self.assertFalse((self.out / "INCOMPLETE").exists())
        self.assertTrue((self.out / "metrics.json").exists())

    def test_everything_as_expected_is_0_and_a_fault_after_the_end_is_skipped_not_passed(self):
        done = self.run_patrol("expect:\n  mission.completed: true\n"
                               "faults:\n  - {sensor: imu, kind: freeze, start_s: 900}\n"
                               "  - {sensor: gnss, kind: silence, start_s: 0}\n")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assert_complete()
        counts = [self.junit().get(key) for key in ("tests", "failures", "skipped")]
        self.assertEqual(counts, ["4", "0", "1"])  # the run, one expectation, two faults
        self.assertIn("mission.completed", done.stdout)

    def test_missed_and_unmeasured_expectations_are_1(self):
        done = self.run_patrol("expect:\n  mission.completed: true\n  mission.distance_m: {min: 1000}\n"
                               "  pose.elegance: {max: 1}\n")
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assert_complete()
        self.assertEqual((self.junit().get("tests"), self.junit().get("failures")), ("4", "2"))
        self.assertIn("MISSED", done.stdout)
        self.assertIn("not measured", done.stdout)

    def test_the_time_limit_is_4(self):
        done = self.run_patrol("time_limit_s: 2.5\n")
        self.assertEqual(done.returncode, 4, done.stderr)
        self.assert_complete()
        self.assertEqual(self.junit().get("failures"), "1")

    def test_a_run_that_ends_before_there_is_an_estimate_is_4_with_the_mission_alone_scored(self):
        done = self.run_patrol("time_limit_s: 0.1\n")
        self.assertEqual(done.returncode, 4, done.stderr)
        self.assert_complete()
        self.assertEqual(self.junit().get("failures"), "1")
        self.assertNotIn("pose", json.loads((self.out / "metrics.json").read_text()))

    def test_interrupted_is_3_and_stays_red(self):
        file = self.scenario("")
        run = subprocess.Popen([PATROL, "run", file, "--set", "stack.mission.start_wait_s=300", "--out", self.out],
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=SOURCE)
        deadline = time.monotonic() + 60
        while not (self.out / "log.mcap").exists() and time.monotonic() < deadline:
            time.sleep(0.05)
        run.send_signal(signal.SIGINT)
        _, said = run.communicate(timeout=60)
        self.assertEqual(run.returncode, 3, said)
        self.assertTrue((self.out / "INCOMPLETE").exists())
        self.assertFalse((self.out / "metrics.json").exists())
        self.assertEqual(self.junit().get("errors"), "1")


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v"])
