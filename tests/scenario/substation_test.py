#!/usr/bin/env python3
"""The substation's short drive ends as it expects to; what stands in the yard can be run into.

usage: substation_test.py PATROL SOURCE_DIR [TEST...]
"""
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

from documented_metrics import load_metrics
from seeds import seed_option

PATROL, SOURCE = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
SHORT = SOURCE / "worlds/substation/scenarios/short.yaml"


class Substation(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.out = pathlib.Path(self.folder.name) / "run"

    def tearDown(self):
        self.folder.cleanup()

    def run_patrol(self, *options):
        return subprocess.run([PATROL, "run", SHORT, "--out", self.out, *options], capture_output=True, text=True, cwd=SOURCE)

    def run_as_in_ci(self, scenario):
        """With the seed of the table, as expected."""
        done = subprocess.run([PATROL, "run", SOURCE / f"worlds/substation/scenarios/{scenario}.yaml", "--out", self.out,
                               *seed_option("substation", scenario)], capture_output=True, text=True, cwd=SOURCE)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def metrics(self):
        return load_metrics(PATROL, self.out)

    def test_drives_round_a_corner_and_over_a_trench_without_a_touch(self):
        self.run_as_in_ci("short")
        end = [float(word) for word in (self.out / "truth.tum").read_text().splitlines()[-1].split()]
        self.assertAlmostEqual(end[1], 71.0, delta=0.15)
        self.assertAlmostEqual(end[2], 55.5, delta=0.15)

    def test_hits_a_breaker_that_stands_in_its_way(self):
        drive = pathlib.Path(self.folder.name) / "into_a_breaker.json"
        drive.write_text(json.dumps({"version": 1, "frame": "site", "waypoints": [{"position": [62.0, 51.8]}, {"position": [65.5, 51.8]}]}))
        self.run_patrol("--set", f"teleop.route={drive}", "--set", "time_limit_s=20")
        self.assertGreater(self.metrics()["mission"]["collisions"], 0)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v", *sys.argv[3:]])
