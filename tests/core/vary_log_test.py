#!/usr/bin/env python3
"""tools/vary_log: each variant of a small log changes what its name says, and nothing else.

usage: vary_log_test.py SOURCE_DIR
"""
import math
import pathlib
import subprocess
import sys
import tempfile
import unittest

TOOL = pathlib.Path(sys.argv[1]).resolve() / "tools/vary_log"
BEAMS, SCANS = 32, 600


def range_m(beam):
    return 81.91 if beam == 0 else 0.5 * beam


def pose(scan):
    return 0.1 * scan, 0.0, 0.0


def flaser(scan):
    words = [str(range_m(beam)) for beam in range(BEAMS)]
    where = " ".join(str(value) for value in pose(scan))
    return f"FLASER {BEAMS} {' '.join(words)} {where} {where} {100 + 0.2 * scan:.3f} host {scan}\n"


class Variants(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = pathlib.Path(folder.name)
        (self.path / "log").write_text("# comment\n" + "".join(map(flaser, range(SCANS))))

    def run_tool(self, *words):
        return subprocess.run([sys.executable, TOOL, *map(str, words)], capture_output=True, text=True)

    def scans(self, variant, *more):
        """[(ranges, first angle, step, pose, stamp)] of a variant."""
        done = self.run_tool(self.path / "log", variant, self.path / "out", *more)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        scans = []
        for line in (self.path / "out").read_text().splitlines():
            words = line.split()
            self.assertEqual(words[0], "ROBOTLASER1")
            count = int(words[8])
            ranges, tail = [float(word) for word in words[9:9 + count]], words[9 + count:]
            self.assertEqual((tail[0], len(tail)), ("0", 15))
            scans.append((ranges, float(words[2]), float(words[4]), tuple(map(float, tail[4:7])), float(tail[12])))
        return scans

    def test_as_recorded_has_the_same_ranges_angles_poses_and_stamps(self):
        scans = self.scans("as_recorded")
        self.assertEqual(len(scans), SCANS)
        ranges, first, step, where, stamp = scans[7]
        self.assertEqual(ranges, [range_m(beam) for beam in range(BEAMS)])
        self.assertAlmostEqual(first, -math.pi / 2, 5)
        self.assertAlmostEqual(step, math.pi / BEAMS, 5)
        self.assertAlmostEqual(where[0], 0.7)
        self.assertAlmostEqual(stamp, 101.4)

    def test_every_fourth_beam_keeps_its_direction(self):
        ranges, first, step, _, _ = self.scans("beams_4")[0]
        self.assertEqual(ranges, [range_m(beam) for beam in range(2, BEAMS, 4)])
        self.assertAlmostEqual(first, -math.pi / 2 + 2 * math.pi / BEAMS, 5)
        self.assertAlmostEqual(step, 4 * math.pi / BEAMS, 5)

    def test_a_range_of_4_m_leaves_no_longer_one(self):
        ranges = self.scans("range_4m")[0][0]
        self.assertEqual([value for value in ranges if value < 80.0], [range_m(beam) for beam in range(1, 8)])
        self.assertEqual(max(self.scans("clipped_8m")[0][0]), 8.0)

    def test_scans_are_dropped_and_their_relations_with_them(self):
        (self.path / "in").write_text("".join(f"{100 + 0.2 * i:.3f} {100 + 0.2 * (i + 2):.3f} 0.2 0 0 0 0 0\n" for i in range(10)))
        done = self.run_tool(self.path / "log", "scans_2", self.path / "out", "--relations", self.path / "in", self.path / "kept")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(len((self.path / "out").read_text().splitlines()), SCANS // 2)
        self.assertEqual(len((self.path / "kept").read_text().splitlines()), 5)

    def test_a_gap_of_20_s_in_the_middle_leaves_the_scans_before_and_after_it(self):
        stamps = [scan[4] for scan in self.scans("gap_20s")]
        self.assertEqual((stamps[0], len(stamps)), (100.0, SCANS - 100))
        longest = max(after - before for before, after in zip(stamps, stamps[1:]))
        self.assertTrue(20.0 < longest < 20.4, longest)

    def test_odometry_is_scaled_zero_delayed_early_and_jumps(self):
        self.assertAlmostEqual(self.scans("distance_0.9")[-1][3][0], 0.9 * pose(SCANS - 1)[0], 3)
        self.assertEqual(self.scans("odometry_zero")[-1][3], (0.0, 0.0, 0.0))
        self.assertAlmostEqual(self.scans("odometry_delayed")[10][3][0], pose(9)[0])
        self.assertAlmostEqual(self.scans("odometry_early")[10][3][0], pose(11)[0])
        steps = [math.dist(a[3][:2], b[3][:2]) for a, b in zip(self.scans("odometry_jumps"), self.scans("odometry_jumps")[1:])]
        self.assertEqual(sum(abs(step - 0.1) > 0.01 for step in steps), 1)

    def test_a_third_of_the_beams_is_dead_in_all_scans(self):
        scans = self.scans("dead_beams")
        dead = [beam for beam, value in enumerate(scans[0][0]) if value == 0.0]
        self.assertEqual(len(dead), BEAMS // 3)
        self.assertEqual(dead, [beam for beam, value in enumerate(scans[-1][0]) if value == 0.0])

    def test_noise_is_a_tenth_of_a_meter(self):
        errors = [value - range_m(beam) for scan in self.scans("noise_0.1m") for beam, value in enumerate(scan[0]) if beam > 0]
        mean = sum(errors) / len(errors)
        deviation = math.sqrt(sum((error - mean) ** 2 for error in errors) / len(errors))
        self.assertAlmostEqual(mean, 0.0, delta=0.005)
        self.assertAlmostEqual(deviation, 0.1, delta=0.005)

    def test_the_seed_selects_the_draw(self):
        first = self.scans("noise_0.1m")
        self.assertEqual(first, self.scans("noise_0.1m", "--seed", "1"))
        self.assertNotEqual(first, self.scans("noise_0.1m", "--seed", "2"))

    def test_parts_together_are_the_whole(self):
        parts = [self.scans("scans_2", "--part", f"{k}/7") for k in range(1, 8)]
        self.assertEqual([scan for part in parts for scan in part], self.scans("scans_2"))
        self.assertLessEqual(max(map(len, parts)) - min(map(len, parts)), 1)

    def test_a_part_that_is_none_is_2_with_one_line(self):
        for part in ("0/3", "4/3", "1/601", "1", "a/b"):
            done = self.run_tool(self.path / "log", "as_recorded", self.path / "out", "--part", part)
            self.assertEqual((done.returncode, len(done.stderr.splitlines())), (2, 1), part)
            self.assertIn(f"--part {part}: must", done.stderr)
            self.assertFalse((self.path / "out").exists())

    def test_variants_can_be_combined(self):
        ranges, _, _, where, _ = self.scans("beams_2,distance_1.1")[10]
        self.assertEqual(len(ranges), BEAMS // 2)
        self.assertAlmostEqual(where[0], 1.1, 3)

    def test_invalid_input_is_2_with_one_line(self):
        (self.path / "short").write_text("FLASER 3 1 2 3 0 0 0 100 host 1\n")
        (self.path / "none").write_text("ODOM 0 0 0 0 0 0 100 host 1\n")
        for words in (["log", "beams_3", "out"], ["missing", "beams_2", "out"], ["short", "beams_2", "out"], ["none", "beams_2", "out"],
                      ["log", "beams_2", "no/folder"]):
            done = self.run_tool(self.path / words[0], words[1], self.path / words[2])
            self.assertEqual((done.returncode, len(done.stderr.splitlines())), (2, 1), words)
        self.assertIn("short:1: FLASER", self.run_tool(self.path / "short", "beams_2", self.path / "out").stderr)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v"])
