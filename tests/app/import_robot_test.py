#!/usr/bin/env python3
"""`patrol import robot`: writes a robot that the program drives, or one line and nothing.

usage: import_robot_test.py PATROL SOURCE_DIR [TEST]...
"""
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

PATROL = SOURCE = None


def wheel(name, x, y):
    return f"""<joint name="{name}_j" type="continuous"><parent link="chassis"/><child link="{name}"/><origin xyz="{x} {y} 0"/><axis xyz="0 1 0"/></joint>
<link name="{name}"><inertial><mass value="1"/><inertia ixx="0.003" ixy="0" ixz="0" iyy="0.005" iyz="0" izz="0.003"/></inertial>
<collision><origin rpy="1.5708 0 0"/><geometry><cylinder radius="0.1" length="0.05"/></geometry></collision></link>
"""


def vendor_urdf():
    wheels = "".join(wheel(f"roue{i}", x, y) for i, (x, y) in enumerate([(0.2, 0.25), (0.2, -0.25), (-0.2, 0.25), (-0.2, -0.25)]))
    return f"""<robot name="four"><link name="chassis"><inertial><mass value="20"/><inertia ixx="0.5" ixy="0" ixz="0" iyy="0.8" iyz="0" izz="1"/></inertial>
<collision><origin xyz="0 0 0.08"/><geometry><box size="0.6 0.4 0.1"/></geometry></collision></link>
<joint name="laser_j" type="fixed"><parent link="chassis"/><child link="laser"/><origin xyz="0 0 0.3"/></joint><link name="laser"/>
{wheels}</robot>"""


class ImportRobot(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.urdf = self.folder / "four.urdf"
        self.urdf.write_text(vendor_urdf())

    def patrol(self, *arguments):
        return subprocess.run([PATROL, *map(str, arguments)], cwd=self.folder, capture_output=True, text=True)

    def refuse(self, text, *arguments):
        result = self.patrol("import", "robot", *arguments)
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)
        self.assertIn(text, result.stderr)
        self.assertFalse((self.folder / "models/four").exists(), "nothing is half-written")

    def test_the_name_of_a_robot_of_patrol_is_refused(self):
        self.refuse("--out models/tracked: tracked is a robot in ", self.urdf, "--out", "models/tracked")
        self.assertFalse((self.folder / "models").exists())

    def test_the_imported_robot_is_found_in_the_working_directory_and_drives_ten_seconds_of_a_scenario(self):
        result = self.patrol("import", "robot", self.urdf, "--frame", "lidar=laser", "--out", "models/four")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("assumptions; models/four", result.stdout)
        for name in ("four.urdf", "four.yaml", "README.md"):
            self.assertTrue((self.folder / "models/four" / name).exists(), name)
        run = self.patrol("run", SOURCE / "worlds/substation/scenarios/patrol.yaml", "--set", "robot=four", "--set", "time_limit_s=10",
                          "--out", "run")
        self.assertEqual(run.returncode, 4, "the time limit: " + run.stderr)
        self.assertIn("Distance", run.stdout)
        self.assertTrue((self.folder / "run/metrics.json").exists())

    def test_a_folder_in_which_no_scenario_finds_the_robot_is_a_warning(self):
        self.assertEqual(self.patrol("import", "robot", self.urdf, "--out", "models/four").stderr, "")
        other = self.patrol("import", "robot", self.urdf, "--out", "robots/four/")
        self.assertEqual(other.returncode, 0)
        self.assertEqual(other.stderr, "patrol: warning: --out robots/four/: scenarios find four in folders named models only: "
                         "move it to models/four\n")

    def test_a_xacro_file_needs_no_python_but_that_of_the_source_tree(self):
        if not (SOURCE / ".deps/python/bin/python3").exists():
            self.skipTest("tools/setup was not run")
        (self.folder / "bin").mkdir()
        (self.folder / "bin/python3").symlink_to("/bin/false")  # a python3 without xacro
        source = self.folder / "four.xacro"
        source.write_text(vendor_urdf().replace('<robot name="four">', '<robot name="four" xmlns:xacro="http://ros.org/wiki/xacro">'))
        environment = {name: value for name, value in os.environ.items() if name != "PATROL_PYTHON"} | {"PATH": f"{self.folder}/bin"}
        done = subprocess.run([PATROL, "import", "robot", source, "--out", "models/four"], cwd=self.folder, env=environment, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertTrue((self.folder / "models/four/four.urdf").exists())

    def test_joints_that_are_too_slow_to_walk_are_reported(self):
        urdf = (SOURCE / "models/quadruped/quadruped.urdf").read_text()
        for name, limit, is_limited, is_slow in [("fast", "21", False, False), ("limited", "12", True, False), ("slow", "1.5", True, True)]:
            source = self.folder / f"{name}.urdf"
            source.write_text(re.sub(r'velocity="[0-9.]+"', f'velocity="{limit}"', urdf))
            result = self.patrol("import", "robot", source, "--out", f"models/{name}")
            self.assertEqual(result.returncode, 0, result.stderr)
            page = (self.folder / "models" / name / "README.md").read_text()
            self.assertEqual("of clearance below the feet needs" in page, is_slow, page)
            self.assertEqual("speed limits of the legs' joints" in result.stdout, is_limited)
            self.assertEqual("allow a walk at 0.43 m/s, instead of the 1.00 m/s of the size" in page, is_limited and not is_slow, page)

    def test_a_robot_without_a_lidar_is_imported_and_checked_as_the_same_robot_with_one(self):
        self.assertEqual(self.patrol("import", "robot", self.urdf, "--out", "models/four").returncode, 0)
        self.assertEqual(self.patrol("import", "robot", self.urdf, "--frame", "lidar=laser", "--out", "models/seeing").returncode, 0)
        self.assertNotIn("lidar", (self.folder / "models/four/four.yaml").read_text())
        check, seeing = self.patrol("check", "four", "--out", "check"), self.patrol("check", "seeing", "--out", "check")
        self.assertIn("passed   square", check.stdout, check.stderr)
        self.assertEqual((check.returncode, check.stdout.replace("four", "seeing")), (seeing.returncode, seeing.stdout))
        refused = self.patrol("run", SOURCE / "worlds/street/scenarios/short.yaml", "--set", "robot=four", "--out", "run")
        self.assertEqual(refused.returncode, 2)
        self.assertIn("robot: four has no lidar (2D lidar), which stack.slam requires, and no tdlas", refused.stderr)

    def test_the_known_robots_of_a_message_are_those_of_the_working_directory_and_of_the_program(self):
        self.assertEqual(self.patrol("import", "robot", self.urdf, "--out", "models/four").returncode, 0)
        (self.folder / "worlds").mkdir()
        refused = self.patrol("check", "fuor")
        self.assertEqual(refused.returncode, 2)
        known = refused.stderr.split("known: ")[1].rstrip(")\n").split(", ")
        self.assertEqual(known, sorted(known))
        self.assertLessEqual({"four", "cart", "quadruped", "tracked", "wheeled"}, set(known))
        self.assertNotIn("lidars", known)

    def test_a_broken_file_is_one_line_with_file_line_and_element(self):
        self.urdf.write_text(vendor_urdf().replace('<parent link="chassis"/><child link="roue1"/>', '<parent link="nowhere"/><child link="roue1"/>'))
        line = 1 + self.urdf.read_text().split("nowhere")[0].count("\n")
        self.refuse(f"four.urdf:{line}: ", self.urdf, "--out", "models/four")

    def test_options_out_of_their_form_are_one_line(self):
        self.refuse("--package courier: must be NAME=VALUE", self.urdf, "--package", "courier", "--out", "models/four")
        self.refuse("is given twice", self.urdf, "--frame", "lidar=laser", "--frame", "lidar=chassis", "--out", "models/four")
        self.refuse("--drive", self.urdf, "--drive", "hover", "--out", "models/four")
        self.refuse("missing.urdf", self.folder / "missing.urdf", "--out", "models/four")

    def test_a_folder_with_content_is_not_overwritten(self):
        (self.folder / "models/other").mkdir(parents=True)
        (self.folder / "models/other/notes.txt").write_text("mine")
        self.refuse("models/other", self.urdf, "--out", "models/other")
        self.assertEqual((self.folder / "models/other/notes.txt").read_text(), "mine")


if __name__ == "__main__":
    PATROL, SOURCE = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    unittest.main(argv=sys.argv[:1] + sys.argv[3:], verbosity=2)
