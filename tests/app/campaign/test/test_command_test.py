#!/usr/bin/env python3
"""`patrol test` as a CI job runs it: what passed and what did not, by exit code, JUnit XML and summary.

usage: test_command_test.py PATROL SOURCE_DIR [NUM_SCENARIOS]; with a number, that many scenarios run in one test, and its memory and its
open files are watched (the issue's study: 1000)
"""
import csv
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time
import unittest
import xml.etree.ElementTree

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent.parent))
from standing_still import PATROL, SOURCE, standing_still  # noqa: E402

NUM_SCENARIOS = int(sys.argv[3]) if len(sys.argv) > 3 else 30


class TestCommand(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.path = pathlib.Path(self.temporary.name)
        self.scenarios = self.path / "scenarios"
        (self.scenarios / "deep").mkdir(parents=True)
        self.good = standing_still(self.path, "expect:\n  mission.completed: true\n")
        self.out = self.path / "out"

    def tearDown(self):
        self.temporary.cleanup()

    def add(self, name, more=""):
        """`more` is of `expect` if it is indented, else of the scenario itself."""
        (self.scenarios / f"{name}.yaml").write_text(self.good.read_text() + more)

    def run_test(self, *more):
        return subprocess.run([PATROL, "test", self.scenarios, "--out", self.out, *more], capture_output=True, text=True, timeout=280, cwd=SOURCE)

    def suites(self):
        return {suite.get("name"): suite for suite in xml.etree.ElementTree.parse(self.out / "junit.xml").getroot().iter("testsuite")}

    def test_links_that_lead_back_are_not_followed(self):
        self.add("first")
        (self.scenarios / "self").symlink_to("self")
        (self.scenarios / "self.yaml").symlink_to("self.yaml")
        (self.scenarios / "up").symlink_to(".")
        (self.scenarios / "away.yaml").symlink_to("nowhere.yaml")
        done = self.run_test()
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(sorted(self.suites()), ["first"])

    def test_all_passed_is_0_with_a_suite_for_each(self):
        self.add("first")
        self.add("deep/second", "  mission.distance_m: {min: -1, max: 1}\n")
        done = self.run_test()
        self.assertEqual(done.returncode, 0, done.stderr)
        suites = self.suites()
        self.assertEqual(sorted(suites), ["deep/second", "first"])
        properties = {entry.get("name"): entry.get("value") for entry in suites["first"].iter("property")}
        self.assertEqual(properties["seed"], "1")
        self.assertEqual(len(properties["build"]), 64)
        self.assertEqual(suites["deep/second"].get("tests"), "3")  # the run and two expectations
        self.assertTrue((self.out / "summary.md").read_text().startswith("# All 2 scenarios passed"))
        self.assertFalse((self.out / "INCOMPLETE").exists())

    def test_failing_ones_are_named_and_the_worst_decides(self):
        self.add("a_good")
        self.add("b_missed", "  mission.distance_m: {min: 1000}\n")
        done = self.run_test()
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("b_missed", done.stderr)
        self.assertNotIn("a_good", done.stderr)
        self.add("c_late", "time_limit_s: 0.5\n")
        self.assertEqual(self.run_test().returncode, 4)
        self.add("d_wrong", "wrold: street\n")
        done = self.run_test()
        self.assertEqual(done.returncode, 2)
        self.assertIn("did you mean world?", done.stdout)
        suites = self.suites()
        self.assertEqual([suites[name].get("failures") for name in ("a_good", "b_missed", "c_late", "d_wrong")], ["0", "1", "2", "0"])
        self.assertEqual(suites["d_wrong"].get("errors"), "1")
        self.assertTrue((self.out / "summary.md").read_text().startswith("# 3 of 4 scenarios did not pass"))
        with open(self.out / "tests.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual({row["scenario"]: row["end"] for row in rows},
                         {"a_good": "done", "b_missed": "expectation missed", "c_late": "time limit", "d_wrong": "wrong input"})

    def test_better_than_the_band_fails_too(self):
        self.add("too_good", "  mission.distance_m: {min: 5, max: 1000}\n")
        self.assertEqual(self.run_test().returncode, 1)

    def test_an_empty_folder_is_5_and_no_folder_is_2(self):
        shutil.rmtree(self.scenarios / "deep")
        self.assertEqual(self.run_test().returncode, 5)
        self.assertFalse(self.out.exists())
        shutil.rmtree(self.scenarios)
        self.assertEqual(self.run_test().returncode, 2)

    def test_names_are_those_of_patrol_run_and_a_world_has_all_its_scenarios(self):
        world = self.path / "worlds/yard"
        (world / "scenarios").mkdir()
        for name in ("first", "second"):
            shutil.copy(self.good, world / f"scenarios/{name}.yaml")

        def names_of(*given):
            done = subprocess.run([PATROL, "test", *given, "--out", self.out, "--json"], capture_output=True, text=True, cwd=self.path)
            self.assertEqual(done.returncode, 0, done.stderr)
            return sorted(self.suites())
        self.assertEqual(names_of("yard"), ["first", "second"])
        self.assertEqual(names_of("yard/second"), ["second"])
        refused = subprocess.run([PATROL, "test", "yards"], capture_output=True, text=True, cwd=self.path)
        self.assertEqual((refused.returncode, refused.stderr), (2, "patrol: yards: not found\n"))

    def test_in_a_folder_settings_of_worlds_and_robots_and_maps_are_no_scenarios_and_all_others_are(self):
        self.add("first")
        for kind, extension in (("yard", ".xml"), ("rover", ".urdf")):
            (self.scenarios / kind).mkdir()
            (self.scenarios / kind / f"{kind}{extension}").write_text("")
            (self.scenarios / kind / f"{kind}.yaml").write_text("ground: {}\n")
        (self.scenarios / "map.yaml").write_text("image: map.pgm\nresolution: 0.05\norigin: [0, 0, 0]\n")
        done = self.run_test()
        self.assertEqual((done.returncode, list(self.suites())), (0, ["first"]), done.stderr)
        (self.scenarios / "rover/typing_error.yaml").write_text("wrold: street\n")
        done = self.run_test()
        self.assertEqual((done.returncode, sorted(self.suites())), (2, ["first", "rover/typing_error"]), done.stderr)

    def test_killed_midway_it_stays_red(self):
        self.add("one")
        process = subprocess.Popen([PATROL, "test", self.scenarios, "--out", self.out], stdout=subprocess.PIPE, stderr=subprocess.PIPE, cwd=SOURCE)
        deadline = time.monotonic() + 60
        while not (self.out / "work").exists() and time.monotonic() < deadline:
            time.sleep(0.02)
        process.kill()
        process.communicate()
        self.assertEqual(self.suites()["one"].get("errors"), "1")
        self.assertTrue((self.out / "INCOMPLETE").exists())

    def test_many_short_scenarios_neither_grow_nor_leak(self):
        for i in range(NUM_SCENARIOS):
            self.add(f"{i:04}", "time_limit_s: 0.1\n" if i % 10 else "time_limit_s: 0.1\nwrold: x\n")
        with open(self.path / "said", "w") as said, open(self.path / "errors", "w") as errors:  # a pipe that nobody reads fills up
            process = subprocess.Popen([PATROL, "test", self.scenarios, "--out", self.out, "--keep-runs", "none"], stdout=said, stderr=errors, cwd=SOURCE)
        memory_kb, files = [], []
        folder = pathlib.Path(f"/proc/{process.pid}")
        while process.poll() is None:
            try:
                if (self.out / "junit.xml").exists():  # the runs have begun
                    memory_kb.append(int((folder / "statm").read_text().split()[1]) * 4)
                    files.append(len(list((folder / "fd").iterdir())))
            except (FileNotFoundError, ProcessLookupError, PermissionError, IndexError):
                break
            time.sleep(0.1)
        said = (self.path / "said").read_text()
        self.assertEqual(process.returncode, 2, (self.path / "errors").read_text()[-1000:])
        self.assertEqual(said.count("wrong input"), (NUM_SCENARIOS + 9) // 10)
        self.assertEqual(said.count("time limit "), NUM_SCENARIOS - (NUM_SCENARIOS + 9) // 10)
        half = len(memory_kb) // 2
        first, second = max(memory_kb[:half]), max(memory_kb[half:])
        print(f"\n{NUM_SCENARIOS} scenarios: memory at most {first} kB in the first half, {second} kB in the second; at most {max(files)} files open")
        self.assertLess(second, first + 8192)
        self.assertLess(max(files), 40)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v"])
