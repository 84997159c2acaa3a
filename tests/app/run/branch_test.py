#!/usr/bin/env python3
"""`patrol run --snapshot-every` and `--from`: a branch leaves the files of the whole run, and what cannot be a branch is refused in one line.
`patrol bisect` finds a planted change at its tick.

usage: branch_test.py PATROL SOURCE_DIR
"""
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent))
from standing_still import HOME, PATROL, SOURCE, standing_still  # noqa: E402

TICK_S = 0.002
IMU_PERIOD_S = 0.005


def run_patrol(*words):
    return subprocess.run([PATROL, *map(str, words)], capture_output=True, text=True, timeout=300, cwd=SOURCE)


class Branch(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.path = pathlib.Path(folder.name)
        cls.parent = cls.path / "parent"
        cls.scenario = standing_still(cls.path, station={**HOME, "position": [1.0, 3.0, 0.0]})
        done = run_patrol("run", cls.scenario, "--set", "time_limit_s=6", "--snapshot-every", 2, "--out", cls.parent)
        assert done.returncode == 4, done.stderr

    def refused(self, what, *words):
        done = run_patrol("run", *words, "--out", self.path / "refused")
        self.assertEqual((done.returncode, done.stderr.count("\n")), (2, 1), done.stderr)
        self.assertIn(what, done.stderr)
        self.assertFalse((self.path / "refused").exists())

    def test_an_unchanged_branch_leaves_the_files_of_the_run(self):
        self.assertEqual(sorted(file.name for file in (self.parent / "snapshots").iterdir()), ["2.snap", "4.snap", "6.snap"])
        for at_s in (1.2, 4, 5.3):
            branch = self.path / f"at_{at_s}"
            self.assertEqual(run_patrol("run", "--from", f"{self.parent}@{at_s}", "--out", branch).returncode, 4)
            for name in ("log.mcap", "estimate.tum", "truth.tum", "map.pgm", "scenario.yaml"):
                self.assertEqual((branch / name).read_bytes(), (self.parent / name).read_bytes(), f"{name} at {at_s}")
            origin = json.loads((branch / "branch.json").read_text())
            self.assertAlmostEqual(origin["at_s"], at_s, delta=1e-9)
            self.assertFalse(origin["has_other_settings"])

    def test_what_cannot_be_a_branch_is_refused(self):
        self.refused("must be RUN@SECONDS", "--from", self.parent)
        self.refused("the run ends before 7.000 s", "--from", f"{self.parent}@7")
        self.refused("--set seed: cannot change in a branch", "--from", f"{self.parent}@4", "--set", "seed=2")
        self.refused("time_limit_s = 3 is before the branch: must be at least 4.000 s", "--from", f"{self.parent}@4", "--set", "time_limit_s=3")
        self.refused("excludes --seed", "--from", f"{self.parent}@4", "--seed", 2)
        self.refused("needs a scenario", "--set", "seed=2")
        cut_off = self.path / "cut_off"
        shutil.copytree(self.parent, cut_off)
        (cut_off / "INCOMPLETE").write_text("")
        self.refused("cut_off: the run is incomplete", "--from", f"{cut_off}@4")
        self.refused("cannot be saved", self.scenario, "--snapshot-every", 2, "--stack", "some program")

    def test_a_run_that_is_not_whole_is_no_result(self):
        broken = self.path / "broken"
        shutil.copytree(self.parent, broken)
        log = (broken / "log.mcap").read_bytes()
        (broken / "log.mcap").write_bytes(log[: len(log) // 2])
        done, metrics = run_patrol("score", broken), (broken / "metrics.json").read_bytes()
        self.assertEqual((done.returncode, done.stderr.count("\n")), (2, 1), done.stderr)
        self.assertIn("log.mcap: is incomplete; cannot be scored", done.stderr)
        self.assertEqual(metrics, (self.parent / "metrics.json").read_bytes())
        done = run_patrol("verify", broken)
        self.assertEqual((done.returncode, done.stderr.count("\n")), (2, 1), done.stderr)
        self.assertIn("log.mcap: is incomplete; cannot be verified", done.stderr)
        done = run_patrol("bisect", self.parent, broken)
        self.assertEqual((done.returncode, done.stderr.count("\n")), (2, 1), done.stderr)
        self.assertIn("log.mcap: is incomplete; cannot be compared", done.stderr)
        self.assertTrue((broken / "map_errors.pgm").exists())
        done = run_patrol("report", broken)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertIn("Incomplete run: the log ends after", (broken / "report.html").read_text())
        (broken / "log.mcap").write_bytes(log)
        (broken / "INCOMPLETE").write_text("")
        done = run_patrol("verify", broken)
        self.assertEqual(done.returncode, 2)
        self.assertIn("incomplete run; cannot be verified", done.stderr)
        done = run_patrol("bisect", broken, self.parent)
        self.assertEqual((done.returncode, done.stderr.count("\n")), (2, 1), done.stderr)
        self.assertIn("broken: incomplete run; cannot be compared", done.stderr)
        (broken / "log.mcap").write_bytes(log[: len(log) // 2])
        fed = run_patrol("feed", broken, "--out", self.path / "fed")
        self.assertIn("broken: incomplete run: fed up to its last message", fed.stderr)
        self.assertIn(fed.returncode, (0, 1), fed.stderr)
        self.assertFalse((self.path / "fed/INCOMPLETE").exists())
        (broken / "log.mcap").write_bytes(log[:100])
        done = run_patrol("feed", broken, "--out", self.path / "fed")
        self.assertEqual(done.returncode, 2)
        self.assertIn("log.mcap: has no messages", done.stderr)
        self.assertTrue((self.path / "fed/metrics.json").exists())

    def test_a_snapshot_of_another_scenario_is_refused(self):
        other = self.path / "other"
        shutil.copytree(self.parent, other)
        text = (other / "scenario.yaml").read_text().replace("seed: 1\n", "seed: 2\n")
        (other / "scenario.yaml").write_text(text)
        self.refused("4.snap: belongs to another build of patrol, or the scenario", "--from", f"{other}@4")

    def test_bisect_finds_a_fault_of_the_imu_at_its_first_message(self):
        other = self.path / "with_fault"
        start_s = 4.356
        fault = f"faults=[{{sensor: imu, kind: clock_offset, start_s: {start_s}, duration_s: 1, magnitude: 1.0e-6}}]"
        run_patrol("run", self.scenario, "--set", "time_limit_s=6", fault, "--snapshot-every", 2, "--out", other)
        done = run_patrol("bisect", self.parent, other, "--json")
        self.assertEqual(done.returncode, 1, done.stderr)
        found = json.loads(done.stdout)
        self.assertGreaterEqual(found["first_difference_s"], start_s)
        self.assertLessEqual(found["first_difference_s"], start_s + IMU_PERIOD_S)
        self.assertEqual(found["parts"], ["messages"])  # the states differ from the start: they contain the list of faults

    def test_bisect_finds_the_first_difference_of_a_branch_after_its_instant(self):
        """The branch has no snapshots: its part before the instant is that of the run. So is that of a branch of a branch."""
        at_s, slow = 4.9, ("--set", "stack.navigation.local_planner.dwa.max_speed_mps=0.2")
        same, other, second = self.path / "same", self.path / "slow", self.path / "slow_branch_of_branch"
        run_patrol("run", "--from", f"{self.parent}@{at_s}", *slow, "--out", other)
        run_patrol("run", "--from", f"{self.parent}@2", "--snapshot-every", 2, "--out", same)
        run_patrol("run", "--from", f"{same}@{at_s}", *slow, "--out", second)
        for branch in (other, second):
            done = run_patrol("bisect", self.parent, branch, "--json")
            self.assertEqual(done.returncode, 1, done.stderr)
            self.assertGreaterEqual(json.loads(done.stdout)["first_difference_s"], at_s)
            self.assertLessEqual(json.loads(done.stdout)["first_difference_s"], at_s + 0.2)
            self.assertNotIn("state", done.stdout)
        shutil.move(same, self.path / "moved")
        done = run_patrol("bisect", self.parent, second)
        self.assertEqual((done.returncode, done.stderr.count("\n")), (2, 1), done.stderr)
        self.assertIn("branch.json: branch_of = ", done.stderr)
        span = ("--from-s", at_s - 0.1, "--to-s", at_s)
        self.assertEqual(run_patrol("trace", other, *span).stdout, run_patrol("trace", self.parent, *span).stdout)

    def test_bisect_hints_at_snapshots(self):
        other = self.path / "late_fault"
        fault = "faults=[{sensor: imu, kind: clock_offset, start_s: 2.1, duration_s: 1, magnitude: 1.0e-6}]"
        run_patrol("run", self.scenario, "--set", "time_limit_s=3", fault, "--out", other)
        done = run_patrol("bisect", self.parent, other)
        self.assertEqual((done.returncode, done.stderr.count("\n")), (1, 1), done.stderr)
        self.assertIn("bisect: the runs have no common snapshot before 2.10", done.stderr)
        self.assertIn("--snapshot-every", done.stderr)

    def test_bisect_names_a_program_that_cannot_trace(self):
        other = self.path / "with_other_seed"
        run_patrol("run", self.scenario, "--set", "time_limit_s=0.5", "--seed", 2, "--out", other)
        programs = {"/bin/true": "printed nothing", "/bin/echo": "not a line of a trace", "/no/such/program": "program not found"}
        for option in ("--program-a", "--program-b"):
            for program, reason in programs.items():
                done = run_patrol("bisect", self.parent, other, option, program)
                self.assertEqual((done.returncode, done.stderr.count("\n")), (2, 1), done.stderr)
                self.assertIn(f"patrol: {option} {program}: ", done.stderr)
                self.assertIn(reason, done.stderr)

    def test_traces_are_the_same_whatever_the_memory_held_before(self):
        """glibc fills memory that the program allocates with the byte."""
        def trace(run, byte):
            done = subprocess.run([PATROL, "trace", run, "--to-s", "0.02"], capture_output=True, text=True, timeout=300, cwd=SOURCE,
                                  env={**os.environ, "MALLOC_PERTURB_": str(byte)})
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            return done.stdout

        for robot in ("quadruped", "wheeled", "cart"):
            run = self.path / robot
            done = run_patrol("run", self.scenario, "--robot", robot, "--set", "time_limit_s=0.1", "--out", run)
            self.assertEqual(done.returncode, 4, done.stderr)
            self.assertEqual(trace(run, 85), trace(run, 170), robot)

    def test_a_stack_that_fails_at_once_while_it_is_fed_is_3_with_its_message(self):
        done = run_patrol("feed", self.parent, "--stack", "false", "--out", self.path / "fed_false")
        self.assertEqual(done.returncode, 3, done.stdout + done.stderr)
        self.assertIn("stack", done.stdout + done.stderr)
        self.assertNotIn("ground truth", done.stderr)

    def test_a_trace_outside_of_the_run_is_refused(self):
        for span, says in ((("--from-s", 50, "--to-s", 60), "--from-s 50: must be in [0, 6.000], the duration of the run"),
                           (("--from-s", 3, "--to-s", 2), "--to-s 2: must be at least --from-s, 3")):
            done = run_patrol("trace", self.parent, *span)
            self.assertEqual((done.returncode, done.stdout, done.stderr), (2, "", f"patrol: {says}\n"))
        lines = run_patrol("trace", self.parent, "--from-s", 5.998, "--to-s", 60).stdout.splitlines()
        self.assertEqual(sorted({line.split()[0] for line in lines}), ["5998000000", "6000000000"])

    def test_bisect_finds_no_difference_of_a_repeated_run(self):
        again = self.path / "again"
        run_patrol("run", self.scenario, "--set", "time_limit_s=6", "--out", again)
        done = run_patrol("bisect", self.parent, again)
        self.assertEqual((done.returncode, done.stdout), (0, "equal: no message differs\n"), done.stderr)

    def test_bisect_finds_the_tick_at_which_another_program_differs(self):
        """The other program is this one, but it kidnaps the robot by a millimeter at 3.1 s."""
        other = self.path / "other_program"
        kidnap_s = 3.1
        program = self.path / "patrol"
        truth = [line.split() for line in (self.parent / "truth.tum").read_text().splitlines() if not line.startswith("#")]
        x, y = next((float(row[1]), float(row[2])) for row in truth if float(row[0]) >= kidnap_s)
        kidnap = f"kidnaps=[{{at_s: {kidnap_s}, x_m: {x + 0.001}, y_m: {y}, heading_deg: 90}}]"
        run_patrol("run", self.scenario, "--set", "time_limit_s=6", kidnap, "--snapshot-every", 2, "--out", other)
        program.write_text(f'#!/bin/sh\necho "$1" >> {self.path}/called\nexec {PATROL} "$@"\n')
        program.chmod(0o755)
        done = run_patrol("bisect", self.parent, other, "--program-b", program, "--json")
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn(f'"first_difference_s": {kidnap_s + TICK_S:.3f},', done.stdout)
        self.assertEqual(set((self.path / "called").read_text().split()), {"trace"})


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v"])
