#!/usr/bin/env python3
"""tools/cost_of_size: drawn offices, exponents, picture, and wrong input.

usage: cost_of_size_test.py SOURCE_DIR
"""
import importlib.machinery
import importlib.util
import pathlib
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree as xml

SOURCE = pathlib.Path(sys.argv[1]).resolve()
sys.dont_write_bytecode = True
LOADER = importlib.machinery.SourceFileLoader("cost_tool", str(SOURCE / "tools/cost_of_size"))
cost = importlib.util.module_from_spec(importlib.util.spec_from_loader(LOADER.name, LOADER))
LOADER.exec_module(cost)
import results_tables as tables  # noqa: E402


def row(path, area_m2, processor_s):
    return {"site": 1, "path": path, "area_m2": area_m2, "distance_m": 50.0 * path, "duration_s": 100.0 * path, "processor_s": processor_s,
            "score_s": 0.5, "memory_mb": 200.0, "log_mb": 10.0 * path}


class CostOfSize(unittest.TestCase):
    def test_free_area_of_the_plan_grows_with_the_number_of_units(self):
        with tempfile.TemporaryDirectory() as folder:
            free = []
            for units in (1, 2):
                cost.draw_office(pathlib.Path(folder), units)
                cells = pathlib.Path(folder, "office.pgm").read_bytes().split(b"255\n", 1)[1]
                self.assertEqual(len(cells), (480 * units + 20) * 220)
                free.append(cells.count(254) * cost.CELL_M**2)
        self.assertAlmostEqual(free[0], 225.0, delta=10.0)
        self.assertAlmostEqual(free[1] / free[0], 2.0, delta=0.02)

    def test_the_exponent_of_a_quadratic_cost_is_2(self):
        rows = [row(1, 240.0, 3.0), row(2, 240.0, 12.0), row(4, 240.0, 48.0)]
        self.assertAlmostEqual(tables.growth(rows, "distance_m", "processor_s"), 2.0)
        self.assertAlmostEqual(tables.growth(rows, "distance_m", "memory_mb"), 0.0)
        self.assertIsNone(tables.growth(rows[:1], "distance_m", "processor_s"))

    def test_a_run_of_both_series_has_one_line(self):
        first = row(1, 240.0, 3.0)
        text = tables.cost_table({"path": [first, row(2, 240.0, 6.0)], "site": [first, row(1, 480.0, 3.0)]})
        self.assertEqual(len(text.splitlines()), 2 + 3 + 2)
        self.assertIn("| growth with the path: exponent | | | 1.00 | 0.00 | 0.00 | 1.00 |", text)

    def test_a_linear_cost_is_on_the_dashed_line_of_the_picture(self):
        root = xml.fromstring(cost.picture([("Path", "distance_m", [row(1, 240.0, 3.0), row(4, 240.0, 12.0)])]))
        name = "{http://www.w3.org/2000/svg}"
        points = root.find(f"{name}polyline").get("points").split()
        dashed = next(line for line in root.iter(f"{name}line") if line.get("stroke-dasharray"))
        self.assertEqual(points, [f"{dashed.get('x1')},{dashed.get('y1')}", f"{dashed.get('x2')},{dashed.get('y2')}"])

    def test_a_refused_input_is_told_from_a_failure_and_a_missed_expectation_is_neither(self):
        self.assertGreaterEqual(cost.processor_s(["sh", "-c", "exit 1"]), 0.0)
        with self.assertRaisesRegex(cost.InputError, "^second$"):
            cost.processor_s(["sh", "-c", "echo first >&2; echo second >&2; exit 2"])
        with self.assertRaisesRegex(RuntimeError, "exit code 3: no message"):
            cost.processor_s(["sh", "-c", "exit 3"])

    def test_wrong_input_gives_one_line_and_exit_code_2(self):
        for words, message in ((["--path", "2,1"], "--path 2,1"), (["--site", "a"], "--site a"), (["--patrol", "/nowhere"], "cannot be executed")):
            done = subprocess.run([SOURCE / "tools/cost_of_size", *words], capture_output=True, text=True)
            self.assertEqual((done.returncode, done.stderr.count("\n")), (2, 1), done.stderr)
            self.assertIn(message, done.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
