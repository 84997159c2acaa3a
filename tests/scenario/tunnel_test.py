#!/usr/bin/env python3
"""The tunnel's scenarios end as they expect to: docking, a kidnap, things that the lidar looks over, the bridge, an inspection round.

usage: tunnel_test.py PATROL SOURCE_DIR [TEST...]
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
SCENARIOS = SOURCE / "worlds/tunnel/scenarios"

# The first of the three rings of inspection_round.yaml, without the drive to the face.
ONE_RING = """
world: tunnel
robot: tracked
seed: 5
time_limit_s: 300
mission: site.json
map: round/map.yaml
goals: {goals}
references: round/scans
lining_deformation:
  - {{kind: convergence, first_ring: 20, last_ring: 20, inward_mm: 3.0}}
stack: {{tunnel_mission: {{num_runs: 1}}}}
expect:
  mission.completed: true
  mission.collisions: {{max: 0}}
  inspection.lining.registered: {{min: 1}}
  inspection.lining.missed: {{max: 0}}
  inspection.lining.false_findings: {{max: 0}}
  inspection.lining.max_error_mm: {{max: 1.4}}
  docking.position_error_m.max: {{max: 0.02}}
"""


class Tunnel(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.out = pathlib.Path(self.folder.name) / "run"

    def tearDown(self):
        self.folder.cleanup()

    def run_patrol(self, scenario, *options):
        return subprocess.run([PATROL, "run", SCENARIOS / f"{scenario}.yaml", "--out", self.out, *options],
                              capture_output=True, text=True, cwd=SOURCE)

    def metrics(self):
        return load_metrics(PATROL, self.out)

    def crossings_of_the_deck(self):
        """How far along x each stay on the bridge's deck has taken the body, m: its deck lies 0.50 m up, the body's origin 0.15 m above."""
        truth = [[float(word) for word in line.split()] for line in (self.out / "truth.tum").read_text().splitlines()
                 if not line.startswith("#")]
        ways, start_x = [], None
        for _, x, _, z, *_ in truth:
            if start_x is None and z > 0.63:
                start_x = x
            elif start_x is not None and z < 0.60:
                ways.append(x - start_x)
                start_x = None
        return ways

    def assert_as_expected(self, scenario):
        done = self.run_patrol(scenario, *seed_option("tunnel", scenario))
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_docks_within_2_cm_and_1_degree(self):
        self.assert_as_expected("docking")
        self.assertEqual(self.metrics()["docking"]["arrivals"], 1)

    def test_relocalises_within_30_s_of_a_kidnap(self):
        self.assert_as_expected("kidnap")
        kidnap = self.metrics()["localization"]["kidnaps"][0]
        self.assertGreater(kidnap["moved_m"], 20.0)
        self.assertLess(kidnap["relocalized_s"], 30.0)

    def test_crosses_the_bridge_there_and_back_teleoperated_and_by_itself(self):
        self.assert_as_expected("bridge")
        ways = self.crossings_of_the_deck()
        self.assertEqual([way > 0.0 for way in ways], [True, False, True, False])
        self.assertGreater(min(map(abs, ways)), 7.5)

    def test_touches_none_of_twenty_low_obstacles(self):
        self.assert_as_expected("low_obstacles")

    def test_inspects_one_ring_and_comes_home(self):
        first_goal = json.loads((SOURCE / "worlds/tunnel/round/nav.json").read_text())[:1]
        goals, scenario = self.out.parent / "nav.json", self.out.parent / "one_ring.yaml"
        goals.write_text(json.dumps(first_goal))
        scenario.write_text(ONE_RING.format(goals=goals))
        done = subprocess.run([PATROL, "run", scenario, "--out", self.out], capture_output=True, text=True, cwd=SOURCE)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertEqual([ring["ring"] for ring in self.metrics()["inspection"]["lining"]["rings"]], [20])

    def test_inspects_lining_and_face_and_comes_home(self):
        self.assert_as_expected("inspection_round")
        lining = self.metrics()["inspection"]["lining"]
        self.assertEqual([ring["ring"] for ring in lining["rings"]], [20, 29, 44])
        self.assertTrue(self.metrics()["inspection"]["water"]["findings"][0]["distance_holds"])
        self.assertEqual(sorted(path.name for path in (self.out / "scans").iterdir()), ["goal_1.ply", "goal_2.ply", "goal_3.ply", "scans.json"])

    def test_patrols_for_gas_while_it_maps(self):
        """Of two places only the leaking one raises the alarm, and the map grows meanwhile."""
        self.assert_as_expected("gas_patrol")
        findings = self.metrics()["inspection"]["findings"]
        self.assertEqual([finding["station"] for finding in findings], ["uwb_anchor_3"])
        self.assertEqual([station["reached"] for station in self.metrics()["stations"]], [True, True, True])
        self.assertNotIn("localization", self.metrics())

    def test_touches_some_without_ultrasonic_and_camera(self):
        self.run_patrol("low_obstacles", "--set", "sensors.ultrasonic.enabled=false", "--set", "sensors.depth_camera.enabled=false",
                        "--set", "time_limit_s=120")
        self.assertGreater(self.metrics()["mission"]["collisions"], 0)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v", *sys.argv[3:]])
