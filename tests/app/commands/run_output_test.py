#!/usr/bin/env python3
"""`patrol run` and `patrol score` print a summary of at most 25 lines; --all prints every metric; --json is JSON alone; a pipe gets no colors.

usage: run_output_test.py PATROL SOURCE_DIR
"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent))
from standing_still import PATROL, SOURCE, standing_still  # noqa: E402


class RunOutput(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.path = pathlib.Path(folder.name)
        cls.scenario = standing_still(cls.path, "expect:\n  mission.completed: true\n")

    def call(self, *arguments):
        done = subprocess.run([PATROL, *arguments], capture_output=True, text=True, timeout=120, cwd=SOURCE)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def test_the_forms_of_a_run(self):
        out = self.path / "run"
        summary = self.call("run", self.scenario, "--out", out)
        self.assertLessEqual(len(summary.splitlines()), 25)
        self.assertIn("done, 1 of 1 expectations met", summary)
        self.assertNotIn("\x1b", summary)
        every = self.call("score", out, "--all")
        self.assertGreater(len(every.splitlines()), 60)
        self.assertIn("pose.heading_rmse_deg", every)
        run = json.loads(self.call("run", self.scenario, "--out", out, "--json"))
        score = json.loads(self.call("score", out, "--json"))
        self.assertEqual(run["end"], "done")
        self.assertEqual(run["directory"], str(out))
        self.assertEqual(score["metrics"]["map"], run["metrics"]["map"])
        self.assertEqual(score["metrics"], json.loads((out / "metrics.json").read_text()))

    def on_terminal(self, *arguments):
        """What a terminal gets on standard error."""
        here, there = os.openpty()
        done = subprocess.run([PATROL, *arguments], stdout=subprocess.DEVNULL, stderr=there, timeout=120, cwd=SOURCE)
        os.close(there)
        self.assertEqual(done.returncode, 0)
        return os.read(here, 65536).decode()

    def test_score_and_report_show_progress_on_a_terminal(self):
        out = self.path / "progress"
        self.call("run", self.scenario, "--out", out)
        self.assertIn("score  reading the log", self.on_terminal("score", out))
        self.assertIn("report  reading the run", self.on_terminal("report", out))

    def test_other_tables_as_json(self):
        sweep = json.loads(self.call("sweep", self.scenario, "--vary", "sensors.lidar.range_noise_std_m=0.01,0.02", "--seeds", "2", "--out",
                                     self.path / "sweep", "--json"))
        self.assertEqual((sweep["runs"], sweep["missing_runs"]), (4, 0))
        self.assertEqual(len(sweep["tables"]["runs"]), 4)
        test = json.loads(self.call("test", self.scenario, "--out", self.path / "test", "--json"))
        self.assertEqual([one["end"] for one in test["scenarios"]], ["done"])
        trajectory = self.path / "test.tum"
        trajectory.write_text("".join(f"{i / 10} {i / 10} {i * i / 100} 0 0 0 0 1\n" for i in range(30)))
        trajectories = json.loads(self.call("score", "--estimate", trajectory, "--reference", trajectory, "--json"))
        self.assertEqual(trajectories["pose"]["ate_rmse_m"], 0.0)
        plan = json.loads(self.call("plan", "worlds/tunnel/map/map.yaml", "--from", "0,0", "--to", "-5,0", "--json"))
        self.assertTrue(plan)

    def test_maps_of_one_run_are_compared_by_its_registration(self):
        run = self.path / "maps"
        run.mkdir()
        pixels = bytes(0 if x in (5, 30) or y in (8, 25) else 254 for y in range(40) for x in range(40))
        for name, origin in (("map", "[0, 0, 0]"), ("truth_map", "[3, -2, 0]")):
            (run / f"{name}.pgm").write_bytes(b"P5\n40 40\n255\n" + pixels)
            (run / f"{name}.yaml").write_text(f"image: {name}.pgm\nresolution: 0.05\norigin: {origin}\nnegate: 0\n"
                                              "occupied_thresh: 0.65\nfree_thresh: 0.196\n")
        (run / "registration.json").write_text(json.dumps({"position": [3, -2, 0], "orientation": [0, 0, 0, 1], "covariance": [1e-4, 0, 0, 0, 1e-4, 0, 0, 0, 1e-4]}))
        score = json.loads(self.call("score", "--map", run / "map.yaml", "--reference-map", run / "truth_map.yaml", "--json"))
        self.assertEqual(score["map"]["iou"], 1.0)
        same = json.loads(self.call("score", "--map", run / "map.yaml", "--reference-map", run / "map.yaml", "--json"))
        self.assertEqual(same["map"]["iou"], 1.0)
        trajectory = run / "estimate.tum"
        trajectory.write_text("".join(f"{t} {t} 0 0 0 0 0 1\n" for t in range(10)))
        both = json.loads(self.call("score", "--estimate", trajectory, "--reference", trajectory, "--map", run / "map.yaml", "--reference-map", run / "map.yaml", "--json"))
        self.assertEqual((both["pose"]["ate_rmse_m"], both["map"]["iou"]), (0.0, 1.0))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v"])
