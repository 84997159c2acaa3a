#!/usr/bin/env python3
"""`patrol score --estimate --relations`: a straight trajectory against relations with known errors, and calls that are refused.

usage: score_relations_test.py PATROL
"""
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

PATROL = pathlib.Path(sys.argv[1])


class ScoreRelations(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.path = pathlib.Path(self.folder.name)
        # Ten poses along x at 1 m/s, since 2000; one stamp twice, of which the first pose counts.
        stamps = [976052857 + i for i in range(10)]
        poses = [f"{t}.222433 {i} 0 0 0 0 0 1" for i, t in enumerate(stamps)]
        poses.insert(3, f"{stamps[2]}.222433 99 0 0 0 0 0 1")
        (self.path / "e.tum").write_text("\n".join(poses) + "\n")

    def tearDown(self):
        self.folder.cleanup()

    def score(self, relations, *more):
        (self.path / "f.relations").write_text(relations)
        command = [PATROL, "score", "--estimate", self.path / "e.tum", "--relations", self.path / "f.relations", *more]
        return subprocess.run(command, capture_output=True, text=True, timeout=60)

    def test_prints_the_errors(self):
        # 0.1 m and 0.3 m off: mean 0.2, deviation 0.1, squares 0.01 and 0.09.
        done = self.score("976052857.222433 976052859.222433 2.1 0 0 0 0 0\n976052859.222433 976052860.222433 1 0.3 0 0 0 0\n")
        self.assertEqual(done.returncode, 0, done.stderr)
        words = [line.split() for line in done.stdout.splitlines()]
        self.assertIn(["translation,", "m", "0.2000", "0.1000", "0.3000", "0.300"], words)
        self.assertIn(["translation", "squared,", "m2", "0.0500", "0.0400"], words)
        self.assertIn("3 nearest poses, 0 interpolated", done.stdout)
        self.assertIn("1 poses of the estimate left out: each has the stamp of the previous pose", done.stdout)

    def test_max_dt_says_which_poses_are_taken_as_they_are(self):
        relation = "976052857.322433 976052859.222433 2 0 0 0 0 0\n"
        self.assertIn("1 interpolated", self.score(relation).stdout)
        self.assertIn("0 interpolated", self.score(relation, "--max-dt-s", "0.1").stdout)

    def test_two_poses_of_one_stamp_are_scored_against_a_trajectory_by_the_first(self):
        curve = [f"{976052857 + i}.222433 {i} {0.1 * i * i} 0 0 0 0 1" for i in range(10)]
        (self.path / "t.tum").write_text("\n".join(curve) + "\n")
        curve.insert(3, "976052859.222433 99 0 0 0 0 0 1")
        (self.path / "twice.tum").write_text("\n".join(curve) + "\n")
        done = subprocess.run([PATROL, "score", "--estimate", self.path / "twice.tum", "--reference", self.path / "t.tum"],
                              capture_output=True, text=True, timeout=60)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn(["pose.ate_max_m", "0"], [line.split() for line in done.stdout.splitlines()])

    def test_relations_and_reference_are_scored_together(self):
        (self.path / "t.tum").write_text((self.path / "e.tum").read_text().replace("976052859.222433 99 0 0 0 0 0 1\n", ""))
        done = self.score("976052857.222433 976052859.222433 2 0 0 0 0 0\n", "--reference", self.path / "t.tum")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("1 of 1 relations scored", done.stdout)
        self.assertIn(["pose.ate_max_m", "0"], [line.split() for line in done.stdout.splitlines()])

    def test_max_dt_is_that_of_the_pairs_with_a_reference(self):
        late = [f"{976052857 + i}.262433 {i} 0 0 0 0 0 1" for i in range(9)]
        (self.path / "t.tum").write_text("\n".join(late) + "\n")
        command = [PATROL, "score", "--estimate", self.path / "e.tum", "--reference", self.path / "t.tum", "--json"]
        pairs = []
        for more in ([], ["--max-dt-s", "0.05"]):
            done = subprocess.run(command + more, capture_output=True, text=True, timeout=60)
            self.assertEqual(done.returncode, 0, done.stderr)
            pairs.append((json.loads(done.stdout)["pose"]["aligned"] or {}).get("pairs"))
        self.assertEqual(pairs, [None, 9])

    def test_relations_outside_the_estimate_are_left_out(self):
        inside, outside = "976052857.222433 976052859.222433 2 0 0 0 0 0\n", "976000000 976000001 1 0 0 0 0 0\n"
        self.assertIn("1 of 2 relations scored", self.score(inside + outside).stdout)
        self.assertEqual(self.score(outside).returncode, 2)

    def test_bad_calls_and_files_are_2_with_one_line(self):
        good = "976052857 976052858 1 0 0 0 0 0\n"
        for done, says in ((self.score(good + "1 2 x\n"), "f.relations:2: x 'x' is not a finite number"),
                           (self.score(good, "--max-dt-s", "-1"), "--max-dt-s: Value -1 not in range"),
                           (self.score("# nothing\n"), "contains no relations"),
                           (subprocess.run([PATROL, "score", "--relations", "f"], capture_output=True, text=True, timeout=60), "--estimate and --relations")):
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn(says, done.stderr)
            self.assertEqual(len(done.stderr.strip().splitlines()), 1, done.stderr)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v"])
