#!/usr/bin/env python3
"""The street by other planners than the default, and in an order of the robot's own.

usage: street_test.py PATROL SOURCE_DIR [TEST...]
"""
import pathlib
import subprocess
import sys
import tempfile
import unittest

from documented_metrics import load_metrics
from seeds import seed_option

PATROL, SOURCE = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])


class Street(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.out = pathlib.Path(folder.name) / "run"

    def run_patrol(self, scenario, *settings):
        command = [PATROL, "run", SOURCE / f"worlds/street/scenarios/{scenario}.yaml", "--out", self.out]
        for setting in settings:
            command += ["--set", setting]
        return subprocess.run(command, capture_output=True, text=True, cwd=SOURCE)

    def run_as_in_ci(self, scenario):
        """With the seed of the table, as expected."""
        done = subprocess.run([PATROL, "run", SOURCE / f"worlds/street/scenarios/{scenario}.yaml", "--out", self.out,
                               *seed_option("street", scenario)], capture_output=True, text=True, cwd=SOURCE)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def metrics(self):
        return load_metrics(PATROL, self.out)

    def assert_arrives(self, *settings):
        done = self.run_patrol("short", *settings)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertGreater(self.metrics()["navigation"]["paths"], 2)

    def test_arrives_by_a_star(self):
        self.assert_arrives("stack.navigation.global_planner.method=astar")

    def test_arrives_by_the_ants_and_later_than_by_a_star(self):
        """On a computer a thousand times slower the colony's search takes seconds, in which the robot stands; A* takes it few."""
        colony = "stack.navigation.global_planner.ant_colony"
        slow = "stack.navigation.planner_cells_per_s=1e4"
        self.assert_arrives("stack.navigation.global_planner.method=ant_colony_li22", f"{colony}.ants=20", f"{colony}.iterations=20", slow)
        by_ants = self.metrics()["mission"]["duration_s"]
        self.assert_arrives("stack.navigation.global_planner.method=astar", slow)
        self.assertGreater(by_ants, self.metrics()["mission"]["duration_s"] + 1.0)

    def test_drives_to_marked_goals_on_a_known_map(self):
        """The map stays the one that was given; the errors are of Monte Carlo localization."""
        self.run_as_in_ci("known_map")
        metrics = self.metrics()
        self.assertEqual([goal["arrivals"] for goal in metrics["goals"]], [1, 0, 1])  # the second is passed by
        self.assertEqual(metrics["localization"]["lost_s"], 0.0)
        self.assertEqual((self.out / "map.pgm").read_bytes(), (SOURCE / "worlds/street/map/map.pgm").read_bytes())

    def test_stays_where_it_is_when_its_planner_finds_nothing(self):
        done = self.run_patrol("short", "stack.navigation.global_planner.method=q_learning", "stack.navigation.global_planner.q_learning.episodes=1", "stack.navigation.no_path_timeout_s=3")
        self.assertEqual(done.returncode, 1, done.stdout + done.stderr)
        metrics = self.metrics()
        self.assertFalse(metrics["mission"]["completed"])
        self.assertEqual(metrics["mission"]["collisions"], 0)
        self.assertEqual(metrics["navigation"]["paths"], 0)
        self.assertLess(metrics["mission"]["distance_m"], 1.0)

    def test_does_the_whole_street_in_half_the_way_of_the_given_order(self):
        """385 m as the survey numbers its stations; the well opens at 200 s, and its leak is found then."""
        self.run_as_in_ci("whole_street")
        metrics = self.metrics()
        self.assertLess(metrics["mission"]["distance_m"], 215.0)
        self.assertTrue(all(station["reached"] for station in metrics["stations"]))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v", *sys.argv[3:]])
