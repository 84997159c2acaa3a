#!/usr/bin/env python3
"""tools/courses: table, interval, wrong input, and continuing after an interruption, with a program in place of patrol.

usage: courses_test.py SOURCE_DIR
"""
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(sys.argv[1]).resolve()
TOOL = SOURCE / "tools/courses"
sys.path.insert(0, str(SOURCE / "tools"))
sys.dont_write_bytecode = True

from results_tables import course_table, wilson_interval  # noqa: E402

# Writes a course as `patrol generate courses` does, and metrics as `patrol run` does: the stack "bad" collides, odd seeds take longer.
# Each run adds a line to the file "calls". A run of a course whose number is in the file "broken" fails.
FAKE = """#!/usr/bin/env python3
import json, pathlib, sys
words = sys.argv[1:]
option = lambda name: words[words.index(name) + 1] if name in words else None
here = pathlib.Path(sys.argv[0]).parent
if words[0] == "generate":
    for number in range(int(option("--number")), int(option("--number")) + int(option("--count"))):
        scenario = pathlib.Path(option("--out")) / f"course_{number:03}/scenarios/patrol.yaml"
        scenario.parent.mkdir(parents=True)
        scenario.write_text("course: {optimal_time_s: 10.000, arrival_m: 1}\\n")
    sys.exit(0)
with open(here / "calls", "a") as calls:
    calls.write(" ".join(words) + "\\n")
if (here / "broken").exists() and words[1] == (here / "broken").read_text():
    print("patrol: it broke", file=sys.stderr)
    sys.exit(3)
is_bad = option("--stack") is not None
duration_s = 40.0 if int(option("--seed")) % 2 else 20.0
out = pathlib.Path(option("--out"))
out.mkdir(parents=True)
course = {"successful": not is_bad, "collided": is_bad, "duration_s": None if is_bad else duration_s, "score": 0.0 if is_bad else 10.0 / duration_s}
(out / "metrics.json").write_text(json.dumps({"course": course}))
"""


class Courses(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = pathlib.Path(folder.name)
        self.patrol = self.path / "patrol"
        self.patrol.write_text(FAKE)
        self.patrol.chmod(0o755)
        self.out = self.path / "out"

    def run_tool(self, *words):
        return subprocess.run([sys.executable, TOOL, *words, "--patrol", self.patrol, "--out", self.out], capture_output=True, text=True)

    def calls(self):
        return (self.path / "calls").read_text().splitlines()

    def test_each_stack_has_one_line_of_its_runs(self):
        done = self.run_tool("3..5", "--seeds", "1..2", "--stack", "built_in", "--stack", "bad=true")
        self.assertEqual(done.returncode, 0, done.stderr)
        rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in done.stdout.splitlines() if line.startswith("|")][2:]
        self.assertEqual(rows, [["built-in", "6", "1.000", "0.610 to 1.000", "0.000", "0.000", "3.00", "0.375"],
                                ["bad", "6", "0.000", "0.000 to 0.390", "1.000", "0.000", "–", "0.000"]])
        runs = json.loads((self.out / "courses.json").read_text())
        self.assertEqual([(run["stack"], run["course"], run["seed"]) for run in runs],
                         [(stack, course, seed) for stack in ("built_in", "bad") for course in (3, 4, 5) for seed in (1, 2)])
        self.assertEqual((self.out / "courses.md").read_text(), done.stdout)

    def test_it_continues_with_the_missing_runs_only(self):
        (self.path / "broken").write_text("course_004/patrol")
        failed = self.run_tool("3..5", "--seeds", "1")
        self.assertEqual(failed.returncode, 3)
        self.assertRegex(failed.stderr.splitlines()[-1], "courses: built_in_004_1: exit status 3: patrol: it broke")
        self.assertFalse((self.out / "courses.json").exists())
        (self.path / "broken").unlink()
        self.assertEqual(self.run_tool("3..5", "--seeds", "1").returncode, 0)
        self.assertEqual(sorted(line.split()[1] for line in self.calls()),
                         ["course_003/patrol", "course_004/patrol", "course_004/patrol", "course_005/patrol"])

    def test_another_call_replaces_the_runs(self):
        self.run_tool("3..4", "--seeds", "1")
        self.assertEqual(self.run_tool("3..4", "--seeds", "1", "--set", "a=b").returncode, 0)
        self.assertEqual(len(self.calls()), 4)

    def test_wrong_input_is_one_line(self):
        for words, text in ((("5..3", "--seeds", "1"), "courses 5..3: must be A..B with A <= B, or one number"),
                            (("1", "--seeds", "x"), "--seeds x: must be A..B"),
                            (("1", "--seeds", "1", "--stack", "a="), "--stack a=: must be NAME or NAME=COMMAND"),
                            (("1", "--seeds", "1", "--stack", "a=/nowhere"), "--stack a=/nowhere: /nowhere: cannot be executed"),
                            (("1", "--seeds", "1", "--stack", "a", "--stack", "a"), "--stack: two stacks have the same name"),
                            (("1", "--seeds", "1", "--jobs", "0"), "--jobs 0: must be at least 1")):
            done = self.run_tool(*words)
            self.assertEqual(done.returncode, 2, words)
            self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
            self.assertIn(text, done.stderr)
            self.assertFalse(self.out.exists())

    def test_a_foreign_folder_stays(self):
        self.out.mkdir()
        (self.out / "mine").write_text("text")
        done = self.run_tool("1", "--seeds", "1")
        self.assertEqual((done.returncode, "is not empty" in done.stderr), (2, True))
        self.assertEqual([file.name for file in self.out.iterdir()], ["mine"])


class Table(unittest.TestCase):
    def test_the_interval_is_that_of_the_textbook(self):
        low, high = wilson_interval(8, 10)
        self.assertAlmostEqual(low, 0.490162, 5)  # (p + z^2 / 2n ± z sqrt(p (1 - p) / n + z^2 / 4n^2)) / (1 + z^2 / n)
        self.assertAlmostEqual(high, 0.943318, 5)
        self.assertAlmostEqual(wilson_interval(0, 10)[0], 0.0)
        self.assertAlmostEqual(wilson_interval(10, 10)[1], 1.0)
        self.assertAlmostEqual(wilson_interval(10, 10)[0], 10 / (10 + 1.959964**2))

    def test_a_run_without_arrival_is_neither_success_nor_collision(self):
        run = {"stack": "one", "course": 1, "seed": 1, "successful": False, "collided": False, "duration_s": None, "score": 0.0, "optimal_time_s": 9.0}
        self.assertIn("| one | 1 | 0.000 | 0.000 to 0.793 | 0.000 | 1.000 | – | 0.000 |", course_table([run]))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v"])
