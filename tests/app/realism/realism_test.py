#!/usr/bin/env python3
"""patrol realism and patrol calibrate --sensor lidar on a CARMEN log made here: a lidar with a noise of 12 mm, an offset of 30 mm and lost beams in a known site.

usage: realism_test.py PATROL SOURCE_DIR
"""
import json
import math
import pathlib
import random
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "mapping"))
from block_log import BEAMS, START_S, drive, ranges_from, walls  # noqa: E402

PATROL, SOURCE = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
NOISE_M, OFFSET_M, LOST = 0.012, 0.030, 0.05
HALF_WALL_M = 0.0005  # the surfaces of the site are nearer than the walls of the log by this


def site():
    """The walls of the log as thin boxes."""
    geoms = []
    for (ax, ay), (bx, by) in walls():
        length, angle = math.hypot(bx - ax, by - ay), math.degrees(math.atan2(by - ay, bx - ax))
        geoms.append(f'<geom type="box" pos="{(ax + bx) / 2} {(ay + by) / 2} 0.5" size="{length / 2} {HALF_WALL_M} 0.5" euler="0 0 {angle}" rgba="0.5 0.5 0.5 1"/>')
    return "<mujoco>\n<worldbody>\n" + "\n".join(geoms) + "\n</worldbody>\n</mujoco>\n"


def write_log(folder):
    draw = random.Random(3)
    segments = walls()
    log, path = ["# CARMEN Logfile", "PARAM robot_frontlaser_offset 0.0 0.0 host 0.0"], []
    for k, (x, y, yaw) in enumerate(drive()[::3]):
        ranges = []
        for range_m in ranges_from(x, y, yaw, segments):
            if draw.random() < LOST or range_m > 80.0:
                ranges.append("81.83")
            else:
                ranges.append(f"{round((range_m + OFFSET_M + draw.gauss(0.0, NOISE_M)) / 0.01) * 0.01:.2f}")
        stamp = START_S + 0.4 * k
        pose = f"{x:.6f} {y:.6f} {yaw:.6f}"
        log.append(f"FLASER {BEAMS} {' '.join(ranges)} {pose} {pose} {stamp:.6f} host {stamp:.6f}")
        path.append(f"{stamp:.6f} {x:.6f} {y:.6f} 0 0 0 {math.sin(yaw / 2):.9f} {math.cos(yaw / 2):.9f}")
    (folder / "log.clf").write_text("\n".join(log) + "\n")
    (folder / "path.tum").write_text("\n".join(path) + "\n")
    (folder / "site.xml").write_text(site())


class Realism(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder_object = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.folder_object.name)
        write_log(cls.folder)
        cls.inputs = [cls.folder / "log.clf", "--site", cls.folder / "site.xml", "--trajectory", cls.folder / "path.tum"]

    @classmethod
    def tearDownClass(cls):
        cls.folder_object.cleanup()

    def patrol(self, *arguments, code=0):
        done = subprocess.run([PATROL, *map(str, arguments)], capture_output=True, text=True, timeout=200, cwd=SOURCE)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done

    def test_realism_measures_offset_noise_and_drop_outs(self):
        out = self.folder / "realism"
        self.patrol("realism", *self.inputs, "--out", out, "--set", "input.max_scans=60")
        self.assertEqual(sorted(file.name for file in out.iterdir()), ["index.html", "metrics.json", "residuals.csv", "settings.yaml"])
        recorded = json.loads((out / "metrics.json").read_text())["recorded"]
        self.assertAlmostEqual(recorded["static"]["median_m"], OFFSET_M, delta=0.002)
        self.assertAlmostEqual(recorded["static"]["robust_std_m"], math.hypot(NOISE_M, 0.01 / math.sqrt(12)), delta=0.001)
        self.assertAlmostEqual(recorded["dropout_rate"], LOST, delta=0.01)
        self.assertIn("Map of the residuals", (out / "index.html").read_text())

    def test_calibrate_finds_them_and_its_preset_halves_the_distance(self):
        out = self.folder / "calibration"
        text = self.patrol("calibrate", "--sensor", "lidar", *self.inputs, "--lidar", "tim571", "--out", out).stdout
        metrics = json.loads((out / "metrics.json").read_text())
        for name, planted in [("range_noise_std_m", NOISE_M), ("measured_range_offset_m", OFFSET_M + HALF_WALL_M), ("dropout_probability", LOST), ("range_quantization_m", 0.01)]:
            fitted = metrics["parameters"][name]
            self.assertTrue(fitted["seen"], name)
            self.assertLessEqual(fitted["low"], planted * 1.0001 + 1e-9, name)
            self.assertGreaterEqual(fitted["high"], planted * 0.9999 - 1e-9, name)
        self.assertFalse(metrics["parameters"]["measured_reflectivity_m"]["seen"])
        self.assertIn("not observable in this log: the surfaces of the site have nearly one reflectivity", text)
        self.assertLess(metrics["held_out"]["ks_ratio"], 0.5)
        again = self.patrol("realism", *self.inputs, "--lidar", out / "lidar.yaml", "--set", "input.max_scans=60", "--out", self.folder / "again")
        self.assertIn("Kolmogorov-Smirnov", again.stdout)
        self.assertLess(json.loads((self.folder / "again/metrics.json").read_text())["ks_distance"], 0.06)

    def test_the_angle_noise_of_a_run_on_its_true_path_is_found_with_the_mount_as_built(self):
        planted_deg = 0.1
        rows = [bytearray(b"\xfe" * 200) for _ in range(160)]  # a room of 20 x 16 m with partitions and pillars
        for x0, y0, x1, y1 in [(0, 0, 200, 2), (0, 158, 200, 160), (0, 0, 2, 160), (198, 0, 200, 160), (60, 0, 62, 60), (60, 100, 62, 160),
                               (130, 30, 132, 120), (90, 20, 100, 26), (30, 120, 34, 124), (160, 100, 164, 104), (160, 30, 170, 36)]:
            for y in range(y0, y1):
                rows[y][x0:x1] = bytes(x1 - x0)
        (self.folder / "hall.pgm").write_bytes(b"P5\n200 160\n255\n" + b"".join(reversed(rows)))
        (self.folder / "hall.yaml").write_text("image: hall.pgm\nresolution: 0.1\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.25\n")
        self.patrol("import", "site", self.folder / "hall.yaml", "--out", self.folder / "worlds/hall")
        run, out = self.folder / "run", self.folder / "of_run"
        (self.folder / "models").mkdir()
        done = subprocess.run([PATROL, "run", "hall", "--robot", "wheeled", "--start", "3,8,0", "--goal", "10,5", "--goal", "10,12", "--seed", "3", "--out", run, "--set",
                               f"sensors.lidar.angle_noise_std_deg={planted_deg}"], capture_output=True, text=True, timeout=200, cwd=self.folder)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        done = subprocess.run([PATROL, "calibrate", "--sensor", "lidar", run, "--out", out, "--set", "input.max_scans=200"], capture_output=True, text=True, timeout=200, cwd=self.folder)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        fitted = json.loads((out / "metrics.json").read_text())["parameters"]["angle_noise_std_deg"]
        self.assertTrue(fitted["seen"])
        self.assertAlmostEqual(fitted["value"], planted_deg, delta=0.2 * planted_deg)

    def test_a_path_that_is_not_that_of_the_log_is_refused_or_warned_of(self):
        rows = [line.split() for line in (self.folder / "path.tum").read_text().splitlines()]
        path = self.folder / "elsewhere.tum"
        path.write_text("".join(" ".join([row[0], str(float(row[1]) + 3.7), str(float(row[2]) - 2.9), *row[3:]]) + "\n" for row in rows))
        inputs = [self.folder / "log.clf", "--site", self.folder / "site.xml", "--trajectory", path]
        done = self.patrol("calibrate", "--sensor", "lidar", *inputs, "--out", self.folder / "none", code=2)
        self.assertIn("too few beams on surfaces of the site", done.stderr)
        self.assertFalse((self.folder / "none").exists())
        done = self.patrol("realism", *inputs, "--set", "input.max_scans=20", "--out", self.folder / "warned")
        self.assertIn("warning: most beams are not on surfaces of the site", done.stdout)
        self.assertEqual(json.loads((self.folder / "warned/metrics.json").read_text())["scans"], 20)

    def test_what_is_missing_or_does_not_fit_is_refused_without_output(self):
        log, out = self.folder / "log.clf", self.folder / "refused"
        site, path = ["--site", self.folder / "site.xml"], ["--trajectory", self.folder / "path.tum"]
        for arguments, message in [
                ([log, *path], "--site: required"),
                ([log, *site], "--trajectory: required"),
                ([log, *site, "--trajectory", "truth"], "only for a run directory"),
                ([log, *path, "--site", "moon"], "world = moon: "),
                ([log, *site, *path, "--lidar", "sick"], "--lidar = sick: must be one of"),
                ([self.folder / "absent", *site, *path], "log not found"),
                ([log, *site, *path, "--set", "input.max_scans=1"], "--set input.max_scans=1: 1 is out of range")]:
            for command in (["realism"], ["calibrate", "--sensor", "lidar"]):
                done = self.patrol(*command, *arguments, "--out", out, code=2)
                self.assertIn(message, done.stderr)
                self.assertEqual(len(done.stderr.strip().splitlines()), 1, done.stderr)
                self.assertFalse(out.exists())
        done = self.patrol("calibrate", log, *site, "--out", out, code=2)
        self.assertIn("only with --sensor lidar", done.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
