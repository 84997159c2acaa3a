#!/usr/bin/env python3
"""`patrol test --calibrate`: proposals from several seeds, resumed, written to the scenarios, refused when the call is wrong.

usage: test_calibration_test.py PATROL SOURCE_DIR
"""
import csv
import json
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import time
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent.parent))
from standing_still import PATROL, SOURCE, standing_still  # noqa: E402

EXPECT = """# Stands still.
expect:  # of a robot that stands
  mission.completed: true
  # Odometry of a standing robot.
  odometry.ate_rmse_m: {max: 0.5}  # loose on purpose
"""


class Calibration(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = pathlib.Path(folder.name)
        self.scenario = standing_still(self.path, EXPECT)
        self.out = self.path / "out"

    def calibrate(self, *more, scenarios=None):
        return subprocess.run([PATROL, "test", *(scenarios or [self.scenario]), "--out", self.out, *more],
                              capture_output=True, text=True, timeout=280, cwd=SOURCE)

    def rows(self):
        with open(self.out / "calibration.csv", newline="") as file:
            return {row["metric"]: row for row in csv.DictReader(file)}

    def test_proposals_follow_the_seeds_and_are_reused(self):
        done = self.calibrate("--calibrate", "2..3")
        self.assertEqual(done.returncode, 0, done.stderr)
        row = self.rows()["odometry.ate_rmse_m"]
        lowest, highest = float(row["lowest"]), float(row["highest"])
        self.assertEqual(row["seeds"], "2")
        self.assertLess(lowest, highest)  # two seeds, two values
        self.assertAlmostEqual(float(row["slack"]), 0.5 / highest)
        low, high = (float(word) for word in re.findall(r"[\d.e-]+(?=[,}])", row["proposed"]))
        self.assertTrue(0.9 * lowest / 3 <= low <= lowest / 3 and 1.8 * highest <= high <= 2 * highest, row)
        self.assertIn("pose.ate_rmse_m", self.rows())  # a standard metric
        self.assertIn("  mission.completed: true\n", (self.out / "expect.yaml").read_text())
        before = {file: file.stat().st_mtime_ns for file in (self.out / "runs").glob("*.json")}
        self.assertEqual(len(before), 2)
        self.assertEqual(self.calibrate("--calibrate", "1..3").returncode, 0)
        after = {file: file.stat().st_mtime_ns for file in (self.out / "runs").glob("*.json")}
        self.assertEqual(len(after), 3)
        self.assertEqual({file: after[file] for file in before}, before)

    def test_interrupted_it_continues(self):
        process = subprocess.Popen([PATROL, "test", self.scenario, "--out", self.out, "--calibrate", "4", "--jobs", "1"],
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, cwd=SOURCE)
        deadline = time.monotonic() + 120
        while not list((self.out / "runs").glob("*.json")) and time.monotonic() < deadline:
            time.sleep(0.01)
        process.send_signal(signal.SIGINT)
        process.communicate()
        first = {file.name: file.stat().st_mtime_ns for file in (self.out / "runs").glob("*.json")}
        if process.returncode != 0:
            self.assertEqual(process.returncode, 3)
            self.assertTrue((self.out / "INCOMPLETE").exists())
        self.assertEqual(self.calibrate("--calibrate", "4").returncode, 0)
        self.assertFalse((self.out / "INCOMPLETE").exists())
        then = {file.name: file.stat().st_mtime_ns for file in (self.out / "runs").glob("*.json")}
        self.assertEqual({name: then[name] for name in first}, first)

    def test_written_expectations_are_met_and_the_rest_of_the_file_stays(self):
        done = self.calibrate("--calibrate", "2", "--write")
        self.assertEqual(done.returncode, 0, done.stderr)
        text = self.scenario.read_text()
        for line in ("# Stands still.", "expect:  # of a robot that stands", "  # Odometry of a standing robot."):
            self.assertIn(line + "\n", text)
        row = self.rows()["odometry.ate_rmse_m"]
        self.assertIn(f"  odometry.ate_rmse_m: {row['proposed']}  # loose on purpose\n", text)
        self.assertIn("  mission.collisions: {max: 0}  # measured 0\n", text)
        tested = subprocess.run([PATROL, "test", self.scenario, "--out", self.path / "tested", "--set", "seed=2"],
                                capture_output=True, text=True, cwd=SOURCE)
        self.assertEqual(tested.returncode, 0, tested.stdout + tested.stderr)
        self.assertEqual(len(list(self.path.glob("*.part"))), 0)
        self.assertEqual(self.calibrate("--calibrate", "2", "--write").returncode, 0)
        self.assertEqual(self.scenario.read_text(), text)
        self.assertEqual(len(list((self.out / "runs").glob("*.json"))), 2)  # other expectations, the same runs

    def test_a_limit_is_widened_on_request_only(self):
        tight = EXPECT.replace("max: 0.5", "max: 1e-9")
        self.scenario = standing_still(self.path, tight)
        done = self.calibrate("--calibrate", "1", "--write")
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("MISSED", done.stdout)
        self.assertIn("  odometry.ate_rmse_m: {max: 1e-09}  # loose on purpose\n", self.scenario.read_text())
        self.calibrate("--calibrate", "1", "--write", "--widen")
        self.assertNotIn("1e-09", self.scenario.read_text())
        self.assertEqual(self.calibrate("--calibrate", "1").returncode, 0)

    def test_a_seed_that_does_not_complete_is_named_and_nothing_is_written(self):
        self.scenario = standing_still(self.path, "time_limit_s: 0.5\n" + EXPECT)
        before = self.scenario.read_text()
        done = self.calibrate("--calibrate", "1", "--write")
        self.assertEqual(done.returncode, 4, done.stderr)
        self.assertIn("seed 1: time limit", done.stdout)
        self.assertEqual(self.scenario.read_text(), before)

    def test_wrong_calls_are_one_line_and_2(self):
        for wrong in (["--calibrate", "0"], ["--calibrate", "x"], ["--calibrate", ""], ["--write"], ["--widen"],
                      ["--calibrate", "1", "--write", "--set", "seed=2"], ["--calibrate", "1", "--seed-table", "x.json"],
                      ["--seed-table", "x.json"]):
            done = self.calibrate(*wrong)
            self.assertEqual(done.returncode, 2, wrong)
            self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
            self.assertFalse(self.out.exists(), wrong)

    def test_a_section_that_cannot_be_edited_is_refused_before_the_runs(self):
        self.scenario = standing_still(self.path, "expect: {mission.completed: true}\n")
        done = self.calibrate("--calibrate", "1", "--write")
        self.assertEqual(done.returncode, 2)
        self.assertIn("cannot be edited", done.stderr)
        self.assertFalse(self.out.exists())


class Seeds(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = pathlib.Path(folder.name)

    def test_the_table_gives_seeds_and_names_are_below_the_common_folder(self):
        for name in ("a", "b"):
            (self.path / name / "scenarios").mkdir(parents=True)
            standing_still(self.path / name / "scenarios", "expect:\n  mission.completed: true\n")
        table = self.path / "seeds.json"
        table.write_text(json.dumps({"b/scenarios/home.yaml": 7, "gone.yaml": 8}))
        out = self.path / "out"
        done = subprocess.run([PATROL, "test", self.path / "a", self.path / "b/scenarios/home.yaml", "--seed-table", table,
                               "--out", out], capture_output=True, text=True, cwd=SOURCE)
        self.assertEqual(done.returncode, 0, done.stderr)
        suites = (out / "junit.xml").read_text().split("<testsuite ")
        seeds = {name: text for name in ("a/scenarios/home", "b/scenarios/home") for text in suites if f'"{name}"' in text}
        self.assertIn('name="seed" value="1"', seeds["a/scenarios/home"])
        self.assertIn('name="seed" value="7"', seeds["b/scenarios/home"])

    def test_a_table_without_any_of_the_scenarios_is_refused(self):
        standing_still(self.path, "expect:\n  mission.completed: true\n")
        table = self.path / "seeds.json"
        table.write_text(json.dumps({"gone.yaml": 8}))
        done = subprocess.run([PATROL, "test", self.path, "--seed-table", table, "--out", self.path / "out"], capture_output=True,
                              text=True, cwd=SOURCE)
        self.assertEqual(done.returncode, 2)
        self.assertEqual(done.stderr, f"patrol: {table}: names none of the scenarios: a key must be the end of the path of a scenario\n")
        self.assertFalse((self.path / "out").exists())


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v"])
