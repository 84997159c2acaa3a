#!/usr/bin/env python3
"""Sweeps as people run them: killed, resumed, shared out, merged. Whatever happened on the way, the tables are the same bytes.

usage: sweep_test.py PATROL SOURCE_DIR
"""
import csv
import json
import pathlib
import random
import resource
import shutil
import signal
import subprocess
import sys
import time
import unittest

from sweeping import PATROL, SOURCE, SweepCase


def children_of(process):
    return [int(pid) for pid in pathlib.Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text().split()]


class Sweep(SweepCase):
    def wait_for_a_child(self, process):
        deadline = time.monotonic() + 60
        while time.monotonic() < deadline and process.poll() is None:
            if found := children_of(process):
                return found[0]
            time.sleep(0.01)
        self.fail("no run was started")

    def rows(self, out):
        with open(out / "runs.csv", newline="") as file:
            return list(csv.DictReader(file))

    def test_one_row_for_each_variant_and_seed_and_nothing_else_stays(self):
        rows = self.rows(self.unbroken)
        self.assertEqual(len(rows), 4)
        self.assertEqual({row["end"] for row in rows}, {"done"})
        self.assertEqual([row["seed"] for row in rows], ["1", "1", "2", "2"])
        self.assertFalse((self.unbroken / "work").exists())
        self.assertEqual(len(list((self.unbroken / "runs").iterdir())), 4)

    def test_a_row_is_what_patrol_run_measures(self):
        row = self.rows(self.unbroken)[3]
        out = self.path / "one"
        subprocess.run([PATROL, "run", self.scenario, "--seed", "2", "--set", "sensors.lidar.range_noise_std_m=0.05", "--out", out],
                       check=True, capture_output=True, cwd=SOURCE)
        metrics = json.loads((out / "metrics.json").read_text())
        self.assertEqual(float(row["pose.ate_rmse_m"]), metrics["pose"]["ate_rmse_m"])
        self.assertEqual(float(row["map.nearest_mean_m"]), metrics["map"]["nearest_mean_m"])

    def test_variants_of_equal_settings_are_one_run(self):
        out = self.path / "equal"
        done = self.sweep(out, "--vary", "sensors.lidar.range_noise_std_m=0.05,0.050", "--seeds", "1")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(len(list((out / "runs").glob("*.json"))), 1)
        self.assertEqual([row["end"] for row in self.rows(out)], ["done", "done"])

    def test_a_full_disk_is_no_result_and_a_repeat_makes_the_runs(self):
        out = self.path / "full"

        def limit_files():  # as a full disk, with another error number
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (50_000, resource.RLIM_INFINITY))

        done = subprocess.run(self.command(out, *self.vary), capture_output=True, text=True, timeout=280, cwd=SOURCE,
                              preexec_fn=limit_files, restore_signals=False)
        self.assertEqual(done.returncode, 3, done.stderr)
        self.assertIn("repeat the command to continue", done.stderr.strip().splitlines()[-1])
        self.assertNotIn("wrong input", done.stderr)
        self.assertNotIn("RUN/", done.stderr)
        self.assertEqual(list((out / "runs").glob("*.json")), [])
        self.assertEqual(self.sweep(out, *self.vary).returncode, 0)
        self.assert_same_tables(out)

    def test_killed_three_times_and_resumed_it_leaves_the_same_bytes(self):
        out, chance = self.path / "killed", random.Random(4)
        for num_results in range(3):
            process = self.start(out, *self.vary)
            while process.poll() is None and not ((out / "work").exists() and len(list((out / "runs").glob("*.json"))) >= num_results):
                time.sleep(0.005)
            time.sleep(chance.uniform(0.0, 0.2))
            process.kill()
            process.communicate()
            self.assertTrue((out / "INCOMPLETE").exists() or (out / "runs.csv").exists() or not out.exists())
        self.assertEqual(self.sweep(out, *self.vary).returncode, 0)
        self.assert_same_tables(out)
        self.assertFalse((out / "work").exists())

    def test_three_shards_collected_in_any_order_leave_the_same_bytes(self):
        parts = []
        for shard in ("3/3", "1/3", "2/3"):
            parts.append(self.path / f"shard_{shard[0]}")
            done = self.sweep(parts[-1], *self.vary, "--shard", shard)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn("of 4 runs are missing", done.stdout)
        out = self.path / "collected"
        early = subprocess.run([PATROL, "merge", out, *parts[:2]], capture_output=True, text=True)
        self.assertEqual(early.returncode, 2)
        self.assertIn("1 of 4 runs are missing", early.stderr)
        done = subprocess.run([PATROL, "merge", out, parts[2]], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assert_same_tables(out)

    def test_a_run_that_crashes_is_a_row_and_one_ended_from_outside_is_tried_again(self):
        out = self.path / "crashed"
        process = self.start(out, *self.vary, "--jobs", "1")
        subprocess.run(["kill", "-SEGV", str(self.wait_for_a_child(process))], check=True)
        _, said = process.communicate(timeout=280)
        self.assertEqual(process.returncode, 3, said)
        ends = [row["end"] for row in self.rows(out)]
        self.assertEqual((ends.count("crashed"), ends.count("done")), (1, 3))
        self.assertIn("signal 11", said)

        for name in ("KILL", "TERM"):
            out = self.path / f"ended_by_{name}"
            process = self.start(out, *self.vary, "--jobs", "1")
            subprocess.run(["kill", f"-{name}", str(self.wait_for_a_child(process))], check=True)
            _, said = process.communicate(timeout=280)
            self.assertEqual(process.returncode, 0, said)
            self.assert_same_tables(out)

    def test_ended_by_sigterm_together_with_its_run_it_records_nothing_and_goes_on(self):
        out = self.path / "terminated"
        process = self.start(out, *self.vary, "--jobs", "1")
        child = self.wait_for_a_child(process)
        process.send_signal(signal.SIGSTOP)  # so that the run ends first
        subprocess.run(["kill", "-TERM", str(child)], check=True)
        process.send_signal(signal.SIGTERM)
        process.send_signal(signal.SIGCONT)
        _, said = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 3, said)
        self.assertEqual(list((out / "runs").glob("*.json")), [])
        self.assertEqual(self.sweep(out, *self.vary).returncode, 0)
        self.assert_same_tables(out)

    def test_a_run_over_its_wall_time_is_a_row_and_4(self):
        out = self.path / "late"
        done = self.sweep(out, "--seeds", "1", "--run-timeout-s", "0.2")
        self.assertEqual(done.returncode, 4, done.stderr)
        self.assertEqual(self.rows(out)[0]["end"], "wall time limit")

    def test_a_variant_whose_files_are_wrong_is_a_row_and_2(self):
        out, broken = self.path / "wrong_file", self.path / "broken.json"
        broken.write_text("{}")
        done = self.sweep(out, "--seeds", "1", "--vary", f"mission={self.path / 'home.json'},{broken}")
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertEqual([row["end"] for row in self.rows(out)], ["done", "wrong input"])

    def test_interrupted_is_3_incomplete_and_goes_on(self):
        out = self.path / "interrupted"
        process = self.start(out, *self.vary)
        self.wait_for_a_child(process)
        process.send_signal(signal.SIGINT)
        _, said = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 3, said)
        self.assertTrue((out / "INCOMPLETE").exists())
        self.assertFalse((out / "runs.csv").exists())
        self.assertEqual(self.sweep(out, *self.vary).returncode, 0)
        self.assert_same_tables(out)

    def test_more_seeds_in_the_same_directory_run_only_what_is_new(self):
        out = self.path / "longer"
        shutil.copytree(self.unbroken, out)
        begin = time.time()
        self.assertEqual(self.sweep(out, *self.vary[:-1], "3").returncode, 0)
        self.assertEqual(len(self.rows(out)), 6)
        made = [file for file in (out / "runs").iterdir() if file.stat().st_mtime >= begin]
        self.assertEqual(len(made), 2)

    def stack_script(self, name, text):
        script = self.path / name
        script.write_text(text)
        return script, ["--seeds", "1", "--set", f"stack.command=sh {script}"]

    def test_a_change_of_the_file_of_an_external_stack_makes_new_runs(self):
        out = self.path / "stack_changed"
        script, arguments = self.stack_script("stack.sh", f"exec {PATROL} stack\n")
        self.assertEqual(self.sweep(out, *arguments).returncode, 0)
        self.assertEqual(self.sweep(out, *arguments).returncode, 0)
        self.assertEqual(len(list((out / "runs").glob("*.json"))), 1)
        script.write_text("exit 5\n")
        done = self.sweep(out, *arguments)
        self.assertEqual(done.returncode, 3, done.stdout)
        self.assertEqual([row["end"] for row in self.rows(out)], ["stack failed"])

    def test_a_run_whose_stack_failed_is_repeated(self):
        out, license_file = self.path / "stack_failed", self.path / "license"
        _, arguments = self.stack_script("licensed.sh", f"test -e {license_file} || exit 5\nexec {PATROL} stack\n")
        self.assertEqual(self.sweep(out, *arguments).returncode, 3)
        self.assertEqual([row["end"] for row in self.rows(out)], ["stack failed"])
        license_file.write_text("")
        done = self.sweep(out, *arguments)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual([row["end"] for row in self.rows(out)], ["done"])

    def test_kept_runs_can_be_scored_again(self):
        out = self.path / "kept"
        self.assertEqual(self.sweep(out, "--seeds", "1", "--keep-runs", "all").returncode, 0)
        kept = [path for path in (out / "runs").iterdir() if path.is_dir()]
        self.assertEqual([path.name for path in kept], [self.rows(out)[0]["hash"]])
        self.assertEqual(subprocess.run([PATROL, "score", kept[0]], capture_output=True).returncode, 0)

    def test_a_wrong_call_is_2_in_one_line_and_writes_nothing(self):
        out = self.path / "wrong"
        for wrong in (["--seeds", "0"], ["--shard", "4/3"], ["--vary", "nothing"], ["--vary", "sensors.lidar.rang=1,2"],
                      ["--keep-runs", "some"], ["--engine", "cloud"], ["--jobs", "-1"], ["--run-timeout-s", "0"],
                      ["--early-stop", "--shard", "1/2"], ["--equivalence-margin", "-1"],
                      ["--equivalence-margin", "0.01"], ["--detach"], ["--slurm-tasks", "3"], ["--slurm-option=--partition=long"]):
            done = self.sweep(out, *wrong)
            self.assertEqual((done.returncode, done.stderr.count("\n")), (2, 1), (wrong, done.stderr))
            self.assertFalse(out.exists())

    def test_a_directory_with_other_things_in_it_is_refused(self):
        out = self.path / "mine"
        out.mkdir()
        (out / "thesis.tex").write_text("years of work")
        done = self.sweep(out, "--seeds", "1")
        self.assertEqual(done.returncode, 2)
        self.assertIn("thesis.tex", done.stderr)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v"])
