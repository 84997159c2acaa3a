#!/usr/bin/env python3
"""`patrol list` states each as-built tolerance with its default, its unit and its source.

usage: list_test.py PATROL SOURCE_DIR
"""
import pathlib
import re
import subprocess
import sys
import unittest

PATROL, SOURCE = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
TITLE = "as-built tolerances (as_built)"
UNIT = re.compile(r"_(?:m|deg|s|ppm|px|k|db|arcsec|radps|mps2)(?:_per_\w+)?$|_per_m$")
NO_DIMENSION = re.compile(r"[._](?:ratio|scale|scale_std|rate_std|probability)$")


def tolerances(text):
    """{group: (source, {name: default})} of the section of the output."""
    groups = {}
    for line in text.split(TITLE + "\n")[1].splitlines():
        if not line.startswith("  "):
            break
        words = line.split()
        if line.startswith("    "):
            if "." in words[0]:
                groups[words[0].split(".")[0]][1][words[0]] = float(words[1])
        else:
            group, source = line.strip().split(": ", 1)
            groups[group] = (source, {})
    return groups


class List(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        done = subprocess.run([PATROL, "list"], capture_output=True, text=True, timeout=60, cwd=SOURCE)
        assert done.returncode == 0, done.stderr
        cls.groups = tolerances(done.stdout)

    def test_the_lidar_has_its_defaults_and_its_data_sheet(self):
        source, defaults = self.groups["lidar"]
        self.assertIn("Slamtec RPLIDAR C1 and S series data sheets", source)
        expected = {"lidar.noise_ratio": 0.64, "lidar.range_offset_m": 0.015, "lidar.range_scale": 0.0002, "lidar.reflectivity_m": 0.01,
                    "lidar.incidence_m": 0.008, "lidar.axis_tilt_deg": 0.2, "lidar.cone_deg": 1.5, "lidar.rate_std": 0.01}
        self.assertEqual(defaults, expected)

    def test_every_group_has_a_source_and_every_tolerance_a_unit_or_no_dimension(self):
        header = (SOURCE / "src/sim/as_built/as_built_settings.h").read_text()
        declared = re.findall(r"^  \w+Tolerances (\w+);", header, re.M)
        self.assertGreater(len(declared), 8)
        self.assertEqual(list(self.groups), declared)
        for group, (source, defaults) in self.groups.items():
            self.assertGreater(len(source), 10, group)
            self.assertTrue(defaults, group)
            for name in defaults:
                self.assertTrue(UNIT.search(name) or NO_DIMENSION.search(name), f"{name}: no unit")


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v"])
