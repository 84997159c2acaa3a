#!/usr/bin/env python3
"""`patrol list` prints every section as text and as JSON; each as-built tolerance has its default, its unit and its source.

usage: list_test.py PATROL SOURCE_DIR
"""
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

PATROL, SOURCE = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
UNIT = re.compile(r"_(?:m|deg|s|ppm|px|k|db|arcsec|radps|mps2)(?:_per_\w+)?$|_per_m$")
NO_DIMENSION = re.compile(r"[._](?:ratio|scale|scale_std|rate_std|probability)$")


def run_list(*arguments, cwd=SOURCE, env=None):
    return subprocess.run([PATROL, "list", *arguments], capture_output=True, text=True, timeout=60, cwd=cwd, env=env)


class List(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        done = run_list("--json")
        assert done.returncode == 0, done.stderr
        cls.sections = json.loads(done.stdout)
        cls.sources = {row["name"]: row["source"] for row in cls.sections["as_built_sources"]}
        cls.tolerances = {row["name"]: row["default"] for row in cls.sections["as_built_tolerances"]}

    def test_the_lidar_has_its_defaults_and_its_data_sheet(self):
        self.assertIn("Slamtec RPLIDAR C1 and S series data sheets", self.sources["lidar"])
        expected = {"lidar.noise_ratio": "0.64", "lidar.range_offset_m": "0.015", "lidar.range_scale": "0.0002", "lidar.reflectivity_m": "0.01",
                    "lidar.incidence_m": "0.008", "lidar.axis_tilt_deg": "0.2", "lidar.cone_deg": "1.5", "lidar.rate_std": "0.01",
                    **{f"lidar.measured_{name}": "0" for name in ("range_offset_m", "range_scale", "reflectivity_m", "incidence_m")}}
        self.assertEqual({name: value for name, value in self.tolerances.items() if name.startswith("lidar.")}, expected)

    def test_every_group_has_a_source_and_every_tolerance_a_unit_or_no_dimension(self):
        header = (SOURCE / "src/sim/as_built/as_built_settings.h").read_text()
        declared = re.findall(r"^  \w+Tolerances (\w+);", header, re.M)
        self.assertGreater(len(declared), 8)
        self.assertEqual(list(self.sources), declared)
        for group, source in self.sources.items():
            self.assertGreater(len(source), 10, group)
            self.assertTrue([name for name in self.tolerances if name.startswith(group + ".")], group)
        for name in self.tolerances:
            if name != "enabled":
                self.assertTrue(UNIT.search(name) or NO_DIMENSION.search(name), f"{name}: no unit")

    def test_the_text_has_the_title_and_every_name_of_each_section(self):
        text = run_list().stdout
        for section, rows in self.sections.items():
            self.assertGreater(len(rows), 0, section)
            for row in rows:
                self.assertIn(next(iter(row.values())), text)

    def test_worlds_and_robots_of_the_working_directory_follow_those_of_the_program_and_are_marked(self):
        with tempfile.TemporaryDirectory() as folder:
            here = pathlib.Path(folder)
            (here / "worlds/mine/scenarios").mkdir(parents=True)
            (here / "worlds/mine/mine.xml").write_text("<mujoco/>")
            (here / "worlds/mine/scenarios/short.yaml").write_text("world: mine\n")
            (here / "worlds/other.123.part/scenarios").mkdir(parents=True)  # of an import that was killed
            (here / "worlds/other.123.part/scenarios/patrol.yaml").write_text("world: other\n")
            (here / "models/robot").mkdir(parents=True)
            (here / "models/robot/robot.urdf").write_text("<robot name='robot'/>")
            environment = {**os.environ, "PATROL_DATA": str(SOURCE)}
            done = run_list("--json", cwd=here, env=environment)
            self.assertEqual(done.returncode, 0, done.stderr)
            found = json.loads(done.stdout)
            for section, name in (("worlds", "worlds/mine/mine.xml"), ("robots", "models/robot/robot.urdf"),
                                  ("scenarios", "worlds/mine/scenarios/short.yaml")):
                own = [row["name"] for row in found[section] if row["folder"] == "working directory"]
                self.assertEqual(own, [name])
                self.assertEqual([row["name"] for row in found[section][:-1]], [row["name"] for row in self.sections[section]])
            self.assertIn("worlds/mine/mine.xml", run_list(cwd=here, env=environment).stdout)

    def test_without_worlds_in_the_working_directory_nothing_is_of_it(self):
        for section in ("worlds", "robots", "scenarios"):
            self.assertNotIn("working directory", [row["folder"] for row in self.sections[section]], section)

    def test_one_section_can_be_chosen(self):
        done = run_list("studies", "--json")
        self.assertEqual(list(json.loads(done.stdout)), ["studies"])

    def test_an_unknown_section_is_refused_with_the_known_ones(self):
        done = run_list("study")
        self.assertEqual(done.returncode, 2)
        self.assertIn("unknown section 'study' (known: scenarios, worlds,", done.stderr)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v"])
