#!/usr/bin/env python3
"""A stack drives a generated obstacle course to its goal without a collision; two runs have the same bytes.

usage: course_test.py PATROL SOURCE [STACK]
"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

PATROL, SOURCE, *STACK = sys.argv[1:]
COURSE = "course_901"


class Course(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = pathlib.Path(folder.name)
        self.call("generate", "courses", "--number", "901", "--count", "1", "--out", "worlds")

    def call(self, *words):
        environment = dict(os.environ, PATROL_DATA=SOURCE)
        done = subprocess.run([PATROL, *words], cwd=self.path, env=environment, capture_output=True, text=True, timeout=200)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def run_course(self, name):
        """Bytes of the log of a run."""
        options = ["--stack", STACK[0]] if STACK else []
        self.call("run", f"{COURSE}/patrol", "--seed", "1", *options, "--out", name)
        return (self.path / name / "log.mcap").read_bytes()

    def test_it_arrives_without_a_collision(self):
        log = self.run_course("first")
        course = json.loads((self.path / "first/metrics.json").read_text())["course"]
        self.assertTrue(course["successful"])
        self.assertFalse(course["collided"])
        self.assertGreater(course["score"], 0.3)
        self.assertLessEqual(course["score"], 0.5)  # the cap of the metric
        self.assertGreater(course["duration_s"], 15.0)  # 15.4 m straight to the arrival, at most 1 m/s and a start from rest
        self.assertLess(course["duration_s"], 60.0)
        if STACK:
            self.assertEqual(log, self.run_course("second"))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v"])
