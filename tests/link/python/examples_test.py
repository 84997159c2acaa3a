#!/usr/bin/env python3
"""The examples of patrol_client do what they say.

usage: examples_test.py PATROL SOURCE
"""
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

PATROL, SOURCE = sys.argv[1], pathlib.Path(sys.argv[2])
EXAMPLES = SOURCE / "src/link/python/examples"


def patrol(*arguments):
    return subprocess.run([PATROL, *map(str, arguments)], cwd=SOURCE, capture_output=True, text=True, timeout=280)


def command(example):
    return f"{sys.executable} {EXAMPLES / example}"


class Examples(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.path = pathlib.Path(self.folder.name)

    def metrics(self, done, out):
        self.assertIn(done.returncode, (0, 1, 4), done.stdout + done.stderr)
        return json.loads((out / "metrics.json").read_text())

    def test_the_wall_follower_walks_along_the_street(self):
        self.assertLessEqual(len((EXAMPLES / "wall_follower.py").read_text().splitlines()), 40)
        out = self.path / "wall"
        metrics = self.metrics(patrol("run", "street/short", "--stack", command("wall_follower.py"), "--out", out), out)
        self.assertEqual(metrics["mission"]["collisions"], 0)
        self.assertFalse(metrics["mission"]["fell"])
        self.assertGreater(metrics["mission"]["distance_m"], 10.0)
        self.assertLess(metrics["mission"]["distance_m"], 25.0)
        still = patrol("replay", out, "--still", 5, "--size", "320x180")  # of a run without poses
        self.assertEqual(still.returncode, 0, still.stderr)
        self.assertGreater((out / "still_chase_5s.png").stat().st_size, 2000)

    def test_the_session_of_the_document_is_that_of_the_raw_client(self):
        out = self.path / "raw"
        self.metrics(patrol("run", "street/short", "--set", "time_limit_s=0.2", "--stack", f"{sys.executable} {EXAMPLES / 'raw_session.py'}",
                            "--out", out), out)
        self.assertIn("```\n" + (out / "stack.log").read_text() + "```", (SOURCE / "src/link/README.md").read_text())

    def test_ompl_and_pure_pursuit_reach_the_first_goal(self):
        out = self.path / "ompl"
        metrics = self.metrics(patrol("run", "tunnel/navigate", "--stack", command("ompl_navigator.py"), "--set",
                                      "time_limit_s=100", "--out", out), out)
        goal = next(goal for goal in metrics["goals"] if goal["name"] == "goal_1")
        self.assertEqual(metrics["mission"]["collisions"], 0)
        self.assertEqual(goal["arrivals"], 1)
        self.assertLess(goal["position_error_m"]["mean"], 0.8)  # tolerance 0.3 m, dead reckoning over 35 m

    def test_kiss_icp_is_scored_as_odometry(self):
        run, fed = self.path / "run", self.path / "fed"
        patrol("run", "street/short", "--set", "sensors.lidar3d.enabled=true", "--set", "time_limit_s=12", "--out", run)
        metrics = self.metrics(patrol("feed", run, "--stack", command("kiss_icp_odometry.py"), "--out", fed), fed)
        self.assertGreater(metrics["odometry"]["ate_rmse_m"], 0.002)
        self.assertLess(metrics["odometry"]["ate_rmse_m"], 0.2)
        self.assertEqual(metrics["published_topics"], ["/odom", "/pose"])


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v"])
