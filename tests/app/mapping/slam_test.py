#!/usr/bin/env python3
"""patrol slam on a CARMEN log made here: a robot drives twice round a block of offices, its wheels 3 % too long and turning by 0.01 rad/m.

usage: slam_test.py PATROL SOURCE_DIR
"""
import functools
import gzip
import json
import math
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

from block_log import START_S, carmen_lines, drive

PATROL, SOURCE = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])


class Slam(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder_object = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.folder_object.name)
        cls.poses = drive()
        cls.lines = carmen_lines(cls.poses)
        cls.log = cls.folder / "block.log"
        cls.log.write_text("\n".join(cls.lines) + "\n")

    @classmethod
    def tearDownClass(cls):
        cls.folder_object.cleanup()

    def patrol(self, *arguments, code=0):
        done = subprocess.run([PATROL, *map(str, arguments)], capture_output=True, text=True, timeout=200, cwd=SOURCE)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done

    def map(self, name, *more, log=None):
        self.patrol("slam", log or self.log, "--out", self.folder / name, *more)
        return self.folder / name

    @classmethod
    @functools.cache
    def mapped(cls):
        """The map by the default settings, made once."""
        subprocess.run([PATROL, "slam", cls.log, "--out", cls.folder / "mapped"], capture_output=True, timeout=200, cwd=SOURCE, check=True)
        return cls.folder / "mapped"

    @classmethod
    @functools.cache
    def mapped_by(cls, method, cores=None):
        """The map by a method on some of the cores, made once; on all without `cores`."""
        cores = cores or frozenset(os.sched_getaffinity(0))
        out = cls.folder / f"{method}_{len(cores)}_cores"
        subprocess.run([PATROL, "slam", cls.log, "--method", method, "--out", out], capture_output=True, timeout=200, cwd=SOURCE, check=True,
                       preexec_fn=lambda: os.sched_setaffinity(0, cores), env={**os.environ, "OMP_NUM_THREADS": str(len(cores))})
        return out

    def errors_m(self, out, file="estimate.tum"):
        """Distance from the truth, both from the first pose."""
        x0, y0, yaw0 = self.poses[0]
        rows = [line.split() for line in (out / file).read_text().splitlines() if not line.startswith("#")]
        self.assertEqual(len(rows), len(self.poses))
        found = []
        for k, (row, (x, y, _)) in enumerate(zip(rows, self.poses)):
            self.assertAlmostEqual(float(row[0]), START_S + 0.2 * k, places=6)
            dx, dy = x - x0, y - y0
            tx, ty = math.cos(yaw0) * dx + math.sin(yaw0) * dy, -math.sin(yaw0) * dx + math.cos(yaw0) * dy
            found.append(math.hypot(float(row[1]) - tx, float(row[2]) - ty))
        return found

    def test_all_methods_follow_to_centimeters_where_odometry_is_meters_off(self):
        for method, limit_m in [("graph", 0.04), ("submap_rbpf", 0.12), ("rbpf", 0.12)]:
            out = self.mapped_by(method)
            self.assertLess(max(self.errors_m(out)), limit_m, method)
        self.assertGreater(max(self.errors_m(out, "odometry.tum")), 3.0)

    def test_every_file_is_there_and_the_graph_has_loops(self):
        out = self.mapped()
        self.assertEqual(sorted(file.name for file in out.iterdir()),
                         ["estimate.tum", "keyframes.mcap", "map.pgm", "map.yaml", "metrics.json", "odometry.tum", "performance.csv", "pose_graph.g2o", "report.html", "settings.yaml", "submaps.csv"])
        metrics = json.loads((out / "metrics.json").read_text())
        self.assertEqual(metrics["log"]["scans"], len(self.poses))
        self.assertGreater(metrics["graph"]["cross_submap_edges"], 0)
        self.assertEqual(set(metrics["loop_closures"]), {"searched", "closed", "not_found", "ambiguous", "no_overlap", "mismatched"})
        self.assertEqual(metrics["loop_closures"]["searched"], sum(metrics["loop_closures"].values()) - metrics["loop_closures"]["searched"])
        self.assertTrue(metrics["consistency"]["consistent"])
        self.assertEqual((metrics["consistency"]["disagreeing_pairs"], metrics["consistency"]["disagreements"]), (0, []))
        self.assertGreater(metrics["consistency"]["compared_pairs"], 0)
        odometry = metrics["odometry"]
        self.assertAlmostEqual(odometry["distance_scale"]["value"], 1 / 1.03, delta=0.004)
        self.assertEqual((odometry["faulty_segments"], odometry["delay_s"], odometry["gaps"]), (0, 0, 0))
        self.assertLess(metrics["performance"]["peak_memory_mb"], 300)
        self.assertEqual((out / "pose_graph.g2o").read_text().count("VERTEX_SE2"), metrics["graph"]["nodes"])

    def test_the_page_shows_the_map_and_what_scans_cost(self):
        out = self.mapped()
        html = (out / "report.html").read_text()
        for text in ["mapped by graph", "Computation time per scan", "estimated path"]:
            self.assertIn(text, html)
        self.patrol("report", out, "--out", self.folder / "copy.html")
        self.assertEqual((self.folder / "copy.html").read_text(), html)

    def test_a_second_session_is_located_in_the_map_of_the_first(self):
        half = len(self.lines) // 2
        cut = next(k for k in range(half, len(self.lines)) if self.lines[k].startswith("FLASER")) + 1
        logs = [self.folder / "first.log", self.folder / "second.log"]
        logs[0].write_text("\n".join(self.lines[:cut]) + "\n")
        logs[1].write_text("\n".join(self.lines[cut:]) + "\n")
        first = self.map("first", log=logs[0])
        second = self.map("second", "--map", first, log=logs[1])
        metrics = [json.loads((out / "metrics.json").read_text()) for out in (first, second)]
        self.assertIsNone(metrics[0]["earlier_map"])
        self.assertEqual(metrics[1]["earlier_map"], {"located": True, "nodes": metrics[0]["graph"]["nodes"]})
        self.assertLess(metrics[1]["graph"]["nodes"], 1.1 * metrics[0]["graph"]["nodes"])
        self.assertTrue(metrics[1]["consistency"]["consistent"])
        lines = [(out / "estimate.tum").read_text().splitlines() for out in (first, second)]
        joined = self.folder / "joined"
        joined.mkdir()
        (joined / "estimate.tum").write_text("\n".join(lines[0] + lines[1][1:]) + "\n")
        self.assertLess(max(self.errors_m(joined)), 0.1)
        again = self.map("again", "--map", first, log=logs[1])
        self.assertEqual((second / "keyframes.mcap").read_bytes(), (again / "keyframes.mcap").read_bytes())

    def test_a_map_that_cannot_be_extended_is_refused(self):
        refused = self.patrol("slam", self.log, "--map", self.folder / "nothing", "--out", self.folder / "refused", code=2)
        self.assertEqual(len(refused.stderr.strip().splitlines()), 1)
        self.assertIn("keyframes.mcap", refused.stderr)
        out = self.mapped()
        before = (out / "keyframes.mcap").read_bytes()
        refused = self.patrol("slam", self.log, "--map", out, "--out", out, code=2)
        self.assertIn("--out: must not be the directory of --map", refused.stderr)
        self.assertEqual((out / "keyframes.mcap").read_bytes(), before)
        refused = self.patrol("slam", self.log, "--map", out, "--method", "rbpf", "--out", self.folder / "refused", code=2)
        self.assertIn("method rbpf cannot extend a map", refused.stderr)
        self.assertFalse((self.folder / "refused").exists())

    def test_gzip_and_a_second_time_give_the_same_bytes(self):
        packed = self.folder / "block.log.gz"
        packed.write_bytes(gzip.compress(self.log.read_bytes()))
        first, second = self.mapped(), self.map("packed", log=packed)
        for name in ["estimate.tum", "map.pgm", "pose_graph.g2o"]:
            self.assertEqual((first / name).read_bytes(), (second / name).read_bytes(), name)

    def test_one_core_and_two_give_the_same_bytes(self):
        for method in ["graph", "submap_rbpf"]:
            one, all_cores = self.mapped_by(method, frozenset({min(os.sched_getaffinity(0))})), self.mapped_by(method)
            for name in ["estimate.tum", "map.pgm", "pose_graph.g2o"]:
                self.assertEqual((one / name).read_bytes(), (all_cores / name).read_bytes(), name)

    def test_eight_meters_for_no_return_are_found_and_are_no_wall(self):
        log = self.folder / "eight.log"
        log.write_text("\n".join(carmen_lines(self.poses, max_range=8.0, no_return="8.00")) + "\n")
        done = self.patrol("slam", log, "--out", self.folder / "eight")
        self.assertIn("detected: 8 m encodes no return", done.stdout)
        self.assertLess(max(self.errors_m(self.folder / "eight")), 0.06)
        done = self.patrol("slam", log, "--out", self.folder / "walls", "--set", "log.detect_no_return=false")
        self.assertNotIn("detected", done.stdout)
        self.assertGreater(max(self.errors_m(self.folder / "walls")), 0.06)

    def test_relations_score_the_estimate(self):
        out = self.mapped()
        lines, pairs = [], [(10, 20), (50, 90), (3, 200), (100, len(self.poses) - 5)]
        for a, b in pairs:
            (ax, ay, ayaw), (bx, by, byaw) = self.poses[a], self.poses[b]
            dx, dy = bx - ax, by - ay
            x, y = math.cos(ayaw) * dx + math.sin(ayaw) * dy, -math.sin(ayaw) * dx + math.cos(ayaw) * dy
            lines.append(f"{START_S + 0.2 * a:.6f} {START_S + 0.2 * b:.6f} {x:.6f} {y:.6f} 0 0 0 {math.remainder(byaw - ayaw, 2 * math.pi):.6f}")
        relations = self.folder / "block.relations"
        relations.write_text("\n".join(lines) + "\n")
        # The same errors from the two files, computed here: each relation between the poses at its two stamps.
        rows = [list(map(float, line.split())) for line in (out / "estimate.tum").read_text().splitlines() if not line.startswith("#")]
        trans, rot = [], []
        for a, b, line in zip(*zip(*pairs), lines):
            (ax, ay, ayaw), (bx, by, byaw) = [(row[1], row[2], 2 * math.atan2(row[6], row[7])) for row in (rows[a], rows[b])]
            dx, dy = bx - ax, by - ay
            x, y = math.cos(ayaw) * dx + math.sin(ayaw) * dy, -math.sin(ayaw) * dx + math.cos(ayaw) * dy
            tx, ty, *_, tyaw = map(float, line.split()[2:])
            trans.append(math.hypot(x - tx, y - ty))
            rot.append(abs(math.degrees(math.remainder(byaw - ayaw - tyaw, 2 * math.pi))))
        printed = self.printed_means(self.patrol("score", "--estimate", out / "estimate.tum", "--relations", relations).stdout)
        self.assertAlmostEqual(printed["translation, m"], sum(trans) / len(trans), delta=0.00006)
        self.assertAlmostEqual(printed["rotation, deg"], sum(rot) / len(rot), delta=0.0006)
        # The map is right to centimeters. Odometry, 3 % too long and turning by 0.01 rad/m, is not.
        self.assertLess(printed["translation, m"], 0.04)
        self.assertLess(printed["rotation, deg"], 0.3)
        of_odometry = self.printed_means(self.patrol("score", "--estimate", out / "odometry.tum", "--relations", relations).stdout)
        self.assertGreater(of_odometry["translation, m"], 0.5)
        self.assertGreater(of_odometry["rotation, deg"], 5.0)

    def printed_means(self, text):
        """First number of each row of the printed table, by the row's name."""
        found = {}
        for line in text.splitlines():
            row = re.match(r"  (\S.*?)\s{2,}([-0-9.e]+)", line)
            if row:
                found[row[1]] = float(row[2])
        return found

    def test_a_graph_is_solved_and_one_that_is_damaged_refused(self):
        ring = ["VERTEX_SE2 0 0 0 0", "VERTEX_SE2 1 1 0 0", "VERTEX_SE2 2 2 0 0"]
        edges = [f"EDGE_SE2 {a} {b} {x} 0 0 1 0 0 1 0 1" for a, b, x in [(0, 1, 1.0), (1, 2, 1.0), (0, 2, 2.3)]]
        graph, solved = self.folder / "three.g2o", self.folder / "solved.g2o"
        graph.write_text("\n".join(ring + edges) + "\n")
        done = self.patrol("solve", graph, "--out", solved)
        self.assertIn("0.09 -> 0.03", done.stdout)
        self.assertAlmostEqual(float(solved.read_text().splitlines()[1].split()[2]), 1.1, places=6)
        graph.write_text("\n".join(ring + edges[:1] + ["EDGE_SE2 1 2 1.0 0"]) + "\n")
        self.assertIn("three.g2o:5", self.patrol("solve", graph, "--out", self.folder / "absent.g2o", code=2).stderr)
        self.assertFalse((self.folder / "absent.g2o").exists())

    def test_the_folder_of_a_solved_graph_is_made_and_parts_are_warned_of(self):
        nodes = [f"VERTEX_SE2 {k} {k} 0 0" for k in range(4)]
        edges = [f"EDGE_SE2 {a} {b} 1 0 0 1 0 0 1 0 1" for a, b in [(0, 1), (2, 3)]]
        graph = self.folder / "parts.g2o"
        for lines, warning in [(nodes + edges, "2 parts that no edge connects: "), (nodes, "has no edges: "), (nodes[:2] + edges[:1], "")]:
            graph.write_text("\n".join(lines) + "\n")
            out = self.folder / f"solved_{len(lines)}" / "solved.g2o"
            done = self.patrol("solve", graph, "--out", out)
            self.assertTrue(out.exists())
            self.assertEqual(done.stderr.count("\n"), 1 if warning else 0)
            self.assertIn(f"patrol: {graph}: {warning}" if warning else "", done.stderr)

    def ranges_replaced(self, ranges_of):
        """The log with the ranges of line k by `ranges_of(k)`."""
        lines = []
        for k, line in enumerate(self.lines):
            words = line.split()
            lines.append(" ".join(words[:2] + ranges_of(k) + words[182:]))
        return "\n".join(lines) + "\n"

    def test_a_log_half_of_whose_scans_have_no_returns_is_not_consistent(self):
        log = self.folder / "dead.log"
        log.write_text(self.ranges_replaced(lambda k: ["81.83"] * 180 if k > len(self.lines) // 2 else self.lines[k].split()[2:182]))
        out = self.map("dead", log=log)
        metrics = json.loads((out / "metrics.json").read_text())["consistency"]
        self.assertFalse(metrics["consistent"])
        self.assertAlmostEqual(metrics["scans_without_returns"], len(self.lines) / 2, delta=2)

    def test_a_frozen_lidar_is_named_and_odometry_is_not_blamed(self):
        first = len(self.lines) // 2
        log = self.folder / "frozen.log"
        log.write_text(self.ranges_replaced(lambda k: self.lines[min(k, first)].split()[2:182]))
        done = self.patrol("slam", log, "--out", self.folder / "frozen")
        self.assertIn(f": the lidar is frozen: {len(self.lines) - first - 1} scans repeat the one before while odometry moves", done.stdout)
        self.assertIn("odometry not checked: the lidar is frozen", done.stdout)

    def refuse(self, text, *says, more=()):
        damaged = self.folder / "damaged.log"
        damaged.write_text(text)
        out = self.folder / "refused"
        done = self.patrol("slam", damaged, "--out", out, *more, code=2)
        self.assertEqual(len(done.stderr.strip().splitlines()), 1, done.stderr)
        for part in says:
            self.assertIn(part, done.stderr)
        self.assertFalse(out.exists())

    def test_a_damaged_log_is_refused_with_its_line_and_leaves_nothing(self):
        self.refuse("\n".join(self.lines[:40]) + "\n" + self.lines[40][:300] + "\n", "damaged.log:41", "FLASER")
        self.refuse("\n".join(self.lines[:20] + [self.lines[20].replace("FLASER 180", "FLASER 181")]) + "\n", "damaged.log:21")
        self.refuse("\n".join(self.lines[:20] + [self.lines[20].replace(" host", " host", 1).replace("FLASER 180 ", "FLASER 180 nan_")]) + "\n", "damaged.log:21")
        self.refuse("", "damaged.log")

    def test_what_can_be_read_of_a_damaged_log_is_used_when_asked_for(self):
        damaged = self.folder / "skipped.log"
        damaged.write_text("\n".join(self.lines[:40] + [self.lines[40][:300]] + self.lines[41:]) + "\n")
        out = self.map("skipped", "--skip-invalid", log=damaged)
        metrics = json.loads((out / "metrics.json").read_text())
        self.assertEqual((metrics["log"]["scans"], metrics["log"]["skipped"]), (len(self.poses) - 1, 1))

    def test_a_wrong_method_and_a_wrong_setting_are_refused(self):
        for more, says in [(("--method", "magic"), "graph"), (("--set", "slam.graph.scan_odometri.x=1"), "scan_odometry"), (("--set", "slam.rbpf.particles=0"), "particles")]:
            done = self.patrol("slam", self.log, "--out", self.folder / "wrong", *more, code=2)
            self.assertIn(says, done.stderr)
            self.assertFalse((self.folder / "wrong").exists())


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
