#!/usr/bin/env python3
"""patrol train-neighbors on a short drive through the substation.

usage: train_test.py PATROL SOURCE_DIR
"""
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

PATROL, SOURCE = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
SHORT_SUBMAPS = ["--set", "submap_rbpf.submaps.max_distance_m=3", "--set", "examples.predictions=8"]


class Train(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder_object = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.folder_object.name)
        cls.drive = cls.folder / "run"
        subprocess.run([PATROL, "run", "worlds/substation/scenarios/short.yaml", "--out", cls.drive], capture_output=True, timeout=200, cwd=SOURCE, check=True)

    @classmethod
    def tearDownClass(cls):
        cls.folder_object.cleanup()

    def train(self, *arguments, code=0):
        done = subprocess.run([PATROL, "train-neighbors", *map(str, arguments)], capture_output=True, text=True, timeout=200, cwd=SOURCE)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done

    def test_a_model_is_left_that_mapping_takes_and_the_second_is_the_same(self):
        first, second = self.folder / "first.json", self.folder / "second.json"
        done = self.train(self.drive, "--validation", self.drive, *SHORT_SUBMAPS, "--out", first)
        self.assertIn("validation", done.stdout)
        self.train(self.drive, *SHORT_SUBMAPS, "--out", second)
        self.assertEqual(first.read_bytes(), second.read_bytes())
        self.assertEqual(json.loads(first.read_text())["features"], json.loads((SOURCE / "models/submap_neighbors.json").read_text())["features"])

    def test_what_is_no_run_is_refused_in_a_line_and_leaves_nothing(self):
        for runs in [[self.folder / "nowhere"], [self.drive, self.folder]]:
            model = self.folder / "none.json"
            done = self.train(*runs, "--out", model, code=2)
            self.assertEqual(len(done.stderr.strip().splitlines()[-1:]), 1)
            self.assertFalse(model.exists())

    def test_examples_of_one_kind_teach_nothing(self):
        done = self.train(self.drive, *SHORT_SUBMAPS, "--set", "examples.max_match_m=1e-3", "--set", "examples.max_match_rad=1e-4", "--out", self.folder / "none.json", code=2)
        self.assertIn("no example", done.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
