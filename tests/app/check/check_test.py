#!/usr/bin/env python3
"""`patrol check` of the robots of models/: all maneuvers pass and their figures agree with closed forms; wrong robots fail with the reason.

usage: check_test.py PATROL SOURCE_DIR
"""
import json
import math
import pathlib
import resource
import subprocess
import sys
import tempfile
import unittest

PATROL, SOURCE = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])
ROBOTS = ("quadruped", "tracked", "wheeled", "cart")
GRAVITY = 9.81
MAX_CPU_S = 60.0  # of one check, on one core


def cpu_seconds():
    """CPU time of the finished child processes."""
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def check(out, robot, *options):
    return subprocess.run([PATROL, "check", robot, "--out", out, *options], capture_output=True, text=True, timeout=280, cwd=SOURCE)


def maneuvers_of(out):
    return {maneuver["name"]: maneuver for maneuver in json.loads((out / "check.json").read_text())["maneuvers"]}


class Check(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.path = pathlib.Path(cls.folder.name)
        cls.done, cls.maneuvers = {}, {}
        begin = cpu_seconds()
        for robot in ROBOTS:
            cls.done[robot] = check(cls.path / robot, robot)
            cls.maneuvers[robot] = maneuvers_of(cls.path / robot)
        cls.cpu_s = cpu_seconds() - begin

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def figures(self, robot, maneuver):
        return self.maneuvers[robot][maneuver]["figures"]

    def assert_between(self, value, low, high, message=""):
        self.assertGreaterEqual(value, low, message)
        self.assertLessEqual(value, high, message)

    def test_the_three_robots_pass_with_0_and_less_than_60_seconds_each(self):
        for robot in ROBOTS:
            self.assertEqual(self.done[robot].returncode, 0, self.done[robot].stdout + self.done[robot].stderr)
            self.assertIn("All 8 maneuvers passed.", self.done[robot].stdout)
        self.assertLess(self.cpu_s, MAX_CPU_S * len(ROBOTS))

    def test_each_stands_at_the_height_of_its_geometry(self):
        self.assert_between(self.figures("wheeled", "stand")["height_m"], 0.129, 0.135)  # 0.1323 by the URDF
        self.assert_between(self.figures("tracked", "stand")["height_m"], 0.148, 0.152)  # 0.15 by the URDF
        self.assert_between(self.figures("quadruped", "stand")["height_m"], 0.29, 0.34)

    def test_on_the_plane_wheels_and_tracks_roll_within_2_percent_of_command_and_travel(self):
        for robot in ("wheeled", "tracked"):
            figures = self.figures(robot, "straight")
            self.assert_between(figures["distance_error_ratio"], -0.02, 0.02, robot)
            self.assert_between(figures["slip_ratio"], -0.02, 0.02, robot)
        self.assertNotIn("slip_ratio", self.figures("quadruped", "straight"))

    def test_skid_steering_turns_by_the_closed_form_gauge_to_2_percent(self):
        figures = self.figures("wheeled", "turn")
        expected = 1 + (0.512 / 0.5708) ** 2  # four wheels, Coulomb friction
        self.assert_between(figures["effective_gauge_ratio"], 0.98 * expected, 1.02 * expected)
        self.assert_between(figures["yaw_rate_ratio"], 0.96, 1.02)

    def test_tracks_turn_by_the_closed_form_of_five_road_wheels_to_2_percent(self):
        figures = self.figures("tracked", "turn")
        self.assert_between(figures["effective_gauge_ratio"], 0.98 / 0.708, 1.02 / 0.708)
        self.assert_between(figures["yaw_rate_ratio"], 0.97, 1.03)

    def test_an_emergency_stop_of_wheels_takes_v_squared_over_2a_of_the_firmware(self):
        for robot, acceleration in (("wheeled", 1.0), ("tracked", 0.8)):
            figures = self.figures(robot, "emergency_stop")
            v = figures["speed_mps"]
            self.assert_between(v, 0.98, 1.02, robot)
            firmware = v * v / (2 * acceleration)
            self.assertAlmostEqual(figures["firmware_limit_m"], firmware, places=6)
            self.assert_between(figures["stop_distance_m"], 0.98 * firmware, 1.06 * firmware, robot)
            self.assert_between(figures["stop_time_s"], 0.95 * v / acceleration, 1.05 * v / acceleration, robot)

    def test_legs_stop_within_a_period_of_their_gait_after_the_distance_of_the_firmware(self):
        figures = self.figures("quadruped", "emergency_stop")
        v = figures["speed_mps"]
        firmware = v * v / (2 * 0.8)
        self.assert_between(figures["stop_distance_m"], 0.9 * firmware, firmware + 0.36 * v)

    def test_the_ramp_tilts_wheels_by_10_degrees_and_costs_the_torque_of_the_slope(self):
        for robot in ("wheeled", "tracked"):
            self.assert_between(self.figures(robot, "ramp")["max_tilt_deg"], 9.7, 12.0, robot)
        # Largest torque: at least the mean of the slope, m g sin 10 degrees r / (n T).
        slope = math.sin(math.radians(10)) * GRAVITY
        self.assertGreater(self.figures("wheeled", "ramp")["max_torque_ratio"], 50 * slope * 0.1651 / 4 / 25)
        self.assert_between(self.figures("tracked", "ramp")["max_torque_ratio"], 85 * slope * 0.075 / 2 / 45, 0.4)

    def test_steps_are_crossed_without_contact_of_the_hull(self):
        for robot in ROBOTS:
            figures = self.figures(robot, "steps")
            self.assertEqual(figures["hull_contacts"], 0, robot)
            self.assert_between(figures["max_tilt_deg"], 1.5, 25.0, robot)

    def test_brakes_and_legs_hold_on_the_slope(self):
        for robot in ROBOTS:
            self.assert_between(self.figures(robot, "slope_stand")["creep_m"], 0.0, 0.01, robot)

    def test_equal_calls_give_equal_bytes_and_another_seed_another_robot(self):
        again, other = self.path / "again", self.path / "other"
        check(again, "wheeled")
        check(other, "wheeled", "--seed", "2")
        for name in ("check.json", "check.html"):
            self.assertEqual((again / name).read_bytes(), (self.path / "wheeled" / name).read_bytes(), name)
        self.assertNotEqual((other / "check.json").read_bytes(), (again / "check.json").read_bytes())

    def test_the_page_contains_its_pictures_and_fetches_nothing(self):
        page = (self.path / "wheeled/check.html").read_text()
        self.assertEqual(page.count("data:image/png;base64,"), 3)
        self.assertNotIn("src=\"http", page)
        self.assertLess(page.index("Passed"), page.index("reason of the limit"))

    def test_on_a_slippery_ground_wheels_fail_on_the_ramp_for_the_friction_and_stop_at_the_friction_limit(self):
        out = self.path / "slippery"
        done = check(out, "wheeled", "--set", "wheel_drive.friction=0.05", "--set", "as_built.enabled=false")
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("friction 0.050 is below tan 10° = 0.176", done.stdout)
        maneuvers = maneuvers_of(out)
        self.assertEqual(maneuvers["ramp"]["verdict"], "failed")
        self.assert_between(maneuvers["ramp"]["figures"]["slip_ratio"], 0.8, 1.0)
        stop = maneuvers["emergency_stop"]["figures"]
        limit = stop["speed_mps"] ** 2 / (2 * 0.05 * GRAVITY)
        self.assertAlmostEqual(stop["friction_limit_m"], limit, places=6)
        self.assert_between(stop["stop_distance_m"], 0.85 * limit, 1.05 * limit)

    def test_without_brakes_the_robot_rolls_off_the_slope(self):
        out = self.path / "without_brakes"
        done = check(out, "wheeled", "--set", "wheel_drive.brake_torque_ratio=0")
        self.assertEqual(done.returncode, 1, done.stderr)
        maneuvers = maneuvers_of(out)
        self.assertEqual([name for name, maneuver in maneuvers.items() if maneuver["verdict"] == "failed"], ["slope_stand"])
        self.assertGreater(maneuvers["slope_stand"]["figures"]["creep_m"], 1.0)

    def test_an_unknown_robot_and_a_wrong_setting_are_2_with_one_line_and_write_nothing(self):
        for arguments in (("rover",), ("wheeled", "--set", "wheel_drive.friction=-1")):
            out = self.path / "nothing"
            done = check(out, *arguments)
            self.assertEqual(done.returncode, 2, done.stdout)
            self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
            self.assertFalse(out.exists())


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
