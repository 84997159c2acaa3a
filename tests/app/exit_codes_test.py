#!/usr/bin/env python3
"""Scripts build on the exit codes and on what a run leaves behind: 0 as expected, 1 an expectation missed, 2 wrong input, 3 interrupted
or nothing printed, 4 time limit.

usage: exit_codes_test.py PATROL SOURCE_DIR
"""
import json
import pathlib
import re
import shutil
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
                               "  - {sensor: gnss, kind: dropout, start_s: 0}\n")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assert_complete()
        self.assertIn("warning: fault imu freeze at 900 s: not before the time limit of 900 s", done.stderr)
        counts = [self.junit().get(key) for key in ("tests", "failures", "skipped")]
        self.assertEqual(counts, ["4", "0", "1"])  # the run, one expectation, two faults
        self.assertIn("mission.completed", done.stdout)

    def test_a_run_in_a_world_without_surfaces_is_0_without_errors_of_the_map(self):
        (self.path / "worlds/field").mkdir(parents=True)
        (self.path / "worlds/field/field.xml").write_text(
            '<mujoco><worldbody><geom name="ground" type="plane" size="50 50 1"/></worldbody></mujoco>')
        (self.path / "models").symlink_to(SOURCE / "models")
        done = subprocess.run([PATROL, "run", "field", "--robot", "wheeled", "--start", "0,0", "--goal", "3,1", "--out", self.out],
                              capture_output=True, text=True, timeout=120, cwd=self.path)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assert_complete()
        metrics = json.loads((self.out / "metrics.json").read_text())
        self.assertEqual(list(metrics["map"]), ["origin_in_world"])
        self.assertLess(metrics["pose"]["ate_rmse_m"], 0.1)
        self.assertTrue(metrics["stations"][0]["reached"])

    def test_legs_that_are_far_slower_than_their_walk_are_a_warning(self):
        urdf = (SOURCE / "models/quadruped/quadruped.urdf").read_text()
        for name, text in {"fast": urdf, "slow": re.sub(r'velocity="[^"]*"', 'velocity="1.5"', urdf)}.items():
            with self.subTest(name):
                shutil.copytree(SOURCE / "models/quadruped", self.path / "models" / name)
                (self.path / "models" / name / "quadruped.urdf").unlink()
                (self.path / "models" / name / "quadruped.yaml").rename(self.path / "models" / name / f"{name}.yaml")
                (self.path / "models" / name / f"{name}.urdf").write_text(text)
                self.out = self.path / f"run_{name}"
                done = self.run_patrol(f"robot: {name}\ntime_limit_s: 0.5\n")
                self.assertEqual(done.returncode, 4, done.stderr)
                warned = re.search(r"warning: slow: .* needs \d+\.\d times the speed limits of the joints", done.stderr)
                self.assertEqual(warned is not None, name == "slow", done.stderr)

    def test_missed_and_unmeasured_expectations_are_1(self):
        done = self.run_patrol("expect:\n  mission.completed: true\n  mission.distance_m: {min: 1000}\n"
                               "  docking.position_error_m.max: {max: 1}\n")
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

    def start_long_run(self):
        """A run that has begun to write, and goes on for 600 simulated seconds."""
        signal.signal(signal.SIGHUP, signal.SIG_DFL)  # ignored below nohup, and then by patrol too
        run = subprocess.Popen([PATROL, "run", self.scenario(""), "--set", "stack.gas_mission.init_wait_s=600", "--out", self.out],
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=SOURCE)
        deadline = time.monotonic() + 60
        while run.poll() is None and not (self.out / "log.mcap").exists() and time.monotonic() < deadline:
            time.sleep(0.05)
        return run

    def test_interrupted_is_3_and_stays_red(self):
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            with self.subTest(number):
                run = self.start_long_run()
                run.send_signal(number)
                _, said = run.communicate(timeout=60)
                self.assertEqual(run.returncode, 3, said)
                self.assertTrue((self.out / "INCOMPLETE").exists())
                self.assertFalse((self.out / "metrics.json").exists())
                self.assertEqual(self.junit().get("errors"), "1")
                self.assertEqual((self.out / "log.mcap").read_bytes()[-8:], b"\x89MCAP0\r\n", "the log has its footer")
                shutil.rmtree(self.out)

    def test_goals_instead_of_the_mission_of_a_scenario(self):
        for scenario, robot, removed in (("street/short", "quadruped", "mission.distance_m, stations.valve_well_0.site_map_error_m"),
                                         ("street/patrol", "wheeled", "inspection.")):
            with self.subTest(scenario):
                self.out = self.path / robot
                done = subprocess.run([PATROL, "run", scenario, "--robot", robot, "--goal", "3,0", "--set", "time_limit_s=0.5", "--set",
                                       "expect.stations.goal_1.reached=true", "--out", self.out],
                                      capture_output=True, text=True, timeout=120, cwd=SOURCE)
                self.assertEqual(done.returncode, 4, done.stderr)
                self.assertIn("patrol: --goal: removed the expectations of the replaced mission: ", done.stderr)
                self.assertIn(removed, done.stderr)
                kept = (self.out / "scenario.yaml").read_text()
                self.assertIn("stations.goal_1.reached", kept)
                self.assertIn("map.coverage", kept)
                self.assertNotIn("site_map_error_m", kept)

    def test_a_second_run_into_the_same_directory_is_2_and_a_killed_one_does_not_block(self):
        run = self.start_long_run()
        done = self.run_patrol("time_limit_s: 0.1\n")
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertEqual(len(done.stderr.strip().splitlines()), 1, done.stderr)
        self.assertIn("in use by another process that writes a run", done.stderr)
        self.assertTrue((self.out / "log.mcap").exists())
        run.kill()
        run.communicate(timeout=60)
        self.assertTrue((self.out / "INCOMPLETE").exists())
        self.assertEqual(self.run_patrol("time_limit_s: 0.1\n").returncode, 4)
        self.assert_complete()

    @unittest.skipUnless(pathlib.Path("/dev/full").exists(), "no /dev/full here")
    def test_results_that_cannot_be_printed_are_3(self):
        self.assertEqual(self.run_patrol("time_limit_s: 0.5\n").returncode, 4)
        for arguments in (["list"], ["score", self.out], ["--help"], ["--version"], ["run", "--help"]):
            with self.subTest(arguments), open("/dev/full", "w") as full:
                done = subprocess.run([PATROL, *arguments], stdout=full, stderr=subprocess.PIPE, text=True, timeout=60, cwd=SOURCE)
                self.assertEqual(done.returncode, 3, done.stderr)
                self.assertEqual(len(done.stderr.strip().splitlines()), 1, done.stderr)

    def test_interrupted_courses_are_3_with_one_line(self):
        generate = subprocess.Popen([PATROL, "generate", "courses", "--count", "10000", "--out", self.path / "worlds"],
                                    stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=SOURCE)
        deadline = time.monotonic() + 60
        while generate.poll() is None and not list(self.path.glob("worlds/course_*")) and time.monotonic() < deadline:
            time.sleep(0.05)
        generate.send_signal(signal.SIGINT)
        printed, said = generate.communicate(timeout=60)
        self.assertEqual((generate.returncode, printed), (3, ""), said)
        self.assertRegex(said, r"\Apatrol: interrupted; [1-9][0-9]* of 10000 courses written\n\Z")


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v"])
