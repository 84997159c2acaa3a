#!/usr/bin/env python3
"""MRPT's navigator and particle filter drive the tracked robot to its first goal, with the same bytes each time.

usage: mrpt_test.py PATROL SOURCE MRPT_STACK
"""
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

PATROL, SOURCE, STACK = sys.argv[1:4]


def run(out, time_limit_s):
    return subprocess.run([PATROL, "run", "tunnel/navigate", "--stack", STACK, "--set", f"time_limit_s={time_limit_s}",
                           "--out", str(out)], cwd=SOURCE, capture_output=True, text=True, timeout=280)


class Mrpt(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.path = pathlib.Path(self.folder.name)

    def test_it_reaches_the_first_goal_without_collision(self):
        done = run(self.path / "run", 80.0)
        self.assertEqual(done.returncode, 4, done.stdout + done.stderr)  # the time limit comes before the second goal
        metrics = json.loads((self.path / "run/metrics.json").read_text())
        goal = next(goal for goal in metrics["goals"] if goal["name"] == "goal_1")
        self.assertEqual(metrics["mission"]["collisions"], 0)
        self.assertEqual(goal["arrivals"], 1)
        self.assertLess(goal["position_error_m"]["mean"], 0.6)  # tolerance of the stack 0.3 m, localization
        self.assertGreater(metrics["pose"]["site"]["ate_rmse_m"], 0.005)
        self.assertLess(metrics["pose"]["site"]["ate_rmse_m"], 0.3)

    def test_two_runs_have_the_same_bytes(self):
        for name in ("first", "second"):
            run(self.path / name, 6.0)
        logs = [(self.path / name / "log.mcap").read_bytes() for name in ("first", "second")]
        self.assertGreater(len(logs[0]), 5 * 10**5)
        self.assertEqual(logs[0], logs[1])


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v"])
