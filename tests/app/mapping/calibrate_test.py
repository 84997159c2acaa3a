#!/usr/bin/env python3
"""patrol calibrate on a CARMEN log made here, and patrol slam with what it found.

usage: calibrate_test.py PATROL SOURCE_DIR
"""
import json
import math
import pathlib
import subprocess
import sys
import tempfile
import unittest

from block_log import carmen_lines, drive

PATROL, SOURCE = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
LIDAR = (0.25, -0.05, math.radians(2.0))
WAY, TURN, STEERING = 1.03, 1.1, 0.01
TRUTH = {"lidar_x_m": LIDAR[0], "lidar_y_m": LIDAR[1], "lidar_yaw_rad": LIDAR[2],
         "distance_scale": 1 / WAY, "turn_scale": 1 / TURN, "steering_rad_per_m": -STEERING / TURN}


class Calibrate(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder_object = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.folder_object.name)
        cls.poses = drive()
        cls.lines = carmen_lines(cls.poses, lidar=LIDAR, way=WAY, turn=TURN, steering=STEERING)
        cls.log = cls.folder / "worn.log"
        cls.log.write_text("\n".join(cls.lines) + "\n")

    @classmethod
    def tearDownClass(cls):
        cls.folder_object.cleanup()

    def patrol(self, *arguments, code=0):
        done = subprocess.run([PATROL, *map(str, arguments)], capture_output=True, text=True, timeout=200, cwd=SOURCE)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done

    def calibrate(self, name, *more, log=None):
        out = self.folder / name
        return out, self.patrol("calibrate", log or self.log, "--out", out, *more).stdout

    def far_off_m(self, out):
        """The farthest that odometry's path is from the truth, both from the first pose."""
        x0, y0, yaw0 = self.poses[0]
        rows = [line.split() for line in (out / "odometry.tum").read_text().splitlines() if not line.startswith("#")]
        worst = 0.0
        for row, (x, y, _) in zip(rows, self.poses):
            tx = math.cos(yaw0) * (x - x0) + math.sin(yaw0) * (y - y0)
            ty = -math.sin(yaw0) * (x - x0) + math.cos(yaw0) * (y - y0)
            worst = max(worst, math.hypot(float(row[1]) - tx, float(row[2]) - ty))
        return worst

    def test_the_six_numbers_come_out_and_every_file_is_there(self):
        out, text = self.calibrate("whole")
        self.assertEqual(sorted(file.name for file in out.iterdir()), ["calibration.yaml", "metrics.json", "segments.csv", "settings.yaml"])
        metrics = json.loads((out / "metrics.json").read_text())
        for name, truth in TRUTH.items():
            found = metrics["calibration"][name]
            self.assertTrue(found["observable"], name)
            self.assertLess(abs(found["value"] - truth), max(4 * found["std"], 0.01 if name.endswith("_m") and "lidar" in name else 0.003), (name, found))
        self.assertIn("rotation scale", text)
        self.assertEqual(len((out / "segments.csv").read_text().splitlines()), 1 + metrics["stretches"]["count"])

    def test_mapping_with_the_calibration_puts_odometry_right(self):
        out, _ = self.calibrate("used")
        mapped, plain = self.folder / "mapped", self.folder / "plain"
        self.patrol("slam", self.log, "--calibration", out / "calibration.yaml", "--out", mapped)
        self.patrol("slam", self.log, "--out", plain)
        self.assertGreater(self.far_off_m(plain), 5.0)
        self.assertLess(self.far_off_m(mapped), 1.0)
        self.assertIn("override_lidar_pose: true", (mapped / "settings.yaml").read_text())
        self.patrol("slam", self.log, "--calibration", out / "calibration.yaml", "--set", "calibration.rotation_scale=2", "--out", plain)
        self.assertGreater(self.far_off_m(plain), 5.0)

    def test_a_second_time_gives_the_same_bytes(self):
        (first, _), (second, _) = self.calibrate("first"), self.calibrate("second")
        for name in ["calibration.yaml", "segments.csv", "metrics.json"]:
            self.assertEqual((first / name).read_bytes(), (second / name).read_bytes(), name)

    def test_a_way_without_turns_says_what_it_does_not_tell(self):
        straight = self.folder / "straight.log"
        straight.write_text("\n".join(self.lines[:2] + self.lines[3:105]) + "\n")  # the first side of the block
        out, text = self.calibrate("straight", log=straight)
        found = json.loads((out / "metrics.json").read_text())["calibration"]
        for name in ["lidar_x_m", "lidar_y_m", "turn_scale"]:
            self.assertFalse(found[name]["observable"], name)
            self.assertEqual(found[name]["value"], found[name]["before"], name)
        self.assertEqual(text.count("not observable: unchanged"), sum(not entry["observable"] for entry in found.values()))

    def refuse(self, *arguments, says):
        out = self.folder / "refused"
        done = self.patrol(*arguments, "--out", out, code=2)
        self.assertEqual(len(done.stderr.strip().splitlines()), 1, done.stderr)
        self.assertIn(says, done.stderr)
        self.assertFalse(out.exists())

    def test_a_reversed_lidar_is_refused(self):
        reversed_lines = []
        for line in self.lines:
            words = line.split()
            if words[0] == "FLASER":
                count = int(words[1])
                words[2:2 + count] = words[1 + count:1:-1]
            reversed_lines.append(" ".join(words))
        log = self.folder / "reversed.log"
        log.write_text("\n".join(reversed_lines) + "\n")
        self.refuse("calibrate", log, says="odometry and lidar turn in opposite directions")

    def test_bad_input_is_refused_in_one_line_and_leaves_nothing(self):
        short, damaged, wrong = self.folder / "short.log", self.folder / "damaged.log", self.folder / "wrong.yaml"
        short.write_text("\n".join(self.lines[:30]) + "\n")
        damaged.write_text("\n".join(self.lines[:40]) + "\n" + self.lines[40][:300] + "\n")
        wrong.write_text("rotation_scal: 1.1\n")
        self.refuse("calibrate", short, says="short.log: calibration needs at least")
        self.refuse("calibrate", damaged, says="damaged.log:41")
        self.refuse("calibrate", self.folder / "absent.log", says="absent.log")
        self.refuse("calibrate", self.log, "--set", "passes=0", says="passes")
        self.refuse("slam", self.log, "--calibration", wrong, says="rotation_scale")
        self.refuse("slam", self.log, "--calibration", self.folder / "absent.yaml", says="absent.yaml")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
