#!/usr/bin/env python3
"""A mecanum robot, imported from a description whose rollers are links on joints, passes its check and patrols the substation.

usage: mecanum_test.py PATROL SOURCE_DIR [TEST...]
"""
import json
import math
import pathlib
import subprocess
import sys
import tempfile
import unittest

from documented_metrics import load_metrics

PATROL, SOURCE = pathlib.Path(sys.argv[1]).absolute(), pathlib.Path(sys.argv[2]).absolute()
RADIUS_M, ROLLER_RADIUS_M, NUM_ROLLERS = 0.127, 0.02, 9


def inertial(mass, size):
    x, y, z = size
    return (f'<inertial><mass value="{mass}"/><inertia ixx="{mass * (y * y + z * z) / 12}" ixy="0" ixz="0" '
            f'iyy="{mass * (x * x + z * z) / 12}" iyz="0" izz="{mass * (x * x + y * y) / 12}"/></inertial>')


def joint(name, kind, parent, child, xyz, axis=(0, 0, 1), more=""):
    numbers = [" ".join(f"{value:.9f}" for value in vector) for vector in (xyz, axis)]
    return (f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/><origin xyz="{numbers[0]}"/>'
            f'<axis xyz="{numbers[1]}"/>{more}</joint>\n')


def roller(hub, index, slope_rad):
    """A roller at an angle about the axle; `slope_rad`: direction of the axis of the lowest one, from x to the left."""
    angle = 2.0 * math.pi * index / NUM_ROLLERS
    out_x, out_z = -math.sin(angle), -math.cos(angle)
    axis = (-math.cos(slope_rad) * out_z, math.sin(slope_rad), math.cos(slope_rad) * out_x)
    name, reach = f"{hub}_{index}", RADIUS_M - ROLLER_RADIUS_M
    rpy = f"{-math.asin(axis[1]):.9f} {math.atan2(axis[0], axis[2]):.9f} 0"
    shape = f'<origin rpy="{rpy}"/><geometry><cylinder radius="{ROLLER_RADIUS_M}" length="0.06"/></geometry>'
    return (joint(f"{name}_axle", "continuous", hub, name, (reach * out_x, 0, reach * out_z), axis) +
            f'<link name="{name}">{inertial(0.05, (0.04, 0.04, 0.04))}<visual>{shape}</visual><collision>{shape}</collision></link>\n')


def description():
    """A platform of 40 kg with a lidar and a GNSS antenna."""
    size = (0.7, 0.44, 0.2)
    text = ('<robot name="platform">\n<link name="deck">' + inertial(35, size) +
            f'<collision><geometry><box size="{size[0]} {size[1]} {size[2]}"/></geometry></collision></link>\n')
    for index, (x, y) in enumerate(((0.22, 0.28), (0.22, -0.28), (-0.22, 0.28), (-0.22, -0.28))):
        hub = f"hub_{index}"
        hub_shape = '<origin rpy="1.5707963 0 0"/><geometry><cylinder radius="0.07" length="0.05"/></geometry>'
        text += f'<link name="{hub}">{inertial(0.8, (0.14, 0.05, 0.14))}<collision>{hub_shape}</collision></link>\n'
        text += joint(f"drive_{index}", "continuous", "deck", hub, (x, y, -0.05), (0, 1, 0), '<limit effort="20" velocity="12"/>')
        slope = (-1 if x * y > 0 else 1) * math.pi / 4
        text += "".join(roller(hub, k, slope) for k in range(NUM_ROLLERS))
    for name, at in (("scanner_head", (0.2, 0.0, 0.4)), ("antenna", (-0.3, 0.0, 0.4))):
        text += f'<link name="{name}"/>\n' + joint(f"{name}_mount", "fixed", "deck", name, at)
    return text + "</robot>\n"


class Mecanum(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.work = pathlib.Path(self.folder.name)
        (self.work / "platform.urdf").write_text(description())
        self.run_patrol("import", "robot", "platform.urdf", "--frame", "lidar=scanner_head", "--frame", "gnss=antenna",
                        "--out", "models/platform")

    def tearDown(self):
        self.folder.cleanup()

    def run_patrol(self, *arguments, expected=0):
        done = subprocess.run([PATROL, *arguments], capture_output=True, text=True, cwd=self.work)
        self.assertEqual(done.returncode, expected, done.stdout + done.stderr)
        return done

    def test_passes_its_check_with_5_m_sideways_to_2_percent(self):
        self.run_patrol("check", "platform", "--out", "check")
        check = json.loads((self.work / "check/check.json").read_text())
        self.assertEqual(check["drive"], "mecanum wheels")
        figures = {each["name"]: each["figures"] for each in check["maneuvers"]}
        self.assertAlmostEqual(figures["sideways"]["distance_ratio"], 1.0, delta=0.02)

    def test_patrols_the_substation_without_a_touch(self):
        scenario = SOURCE / "worlds/substation/scenarios/patrol.yaml"
        # The expectations of the file are those of another robot.
        done = subprocess.run([PATROL, "run", scenario, "--set", "robot=platform", "--out", "run"], capture_output=True, text=True, cwd=self.work)
        self.assertIn(done.returncode, (0, 1), done.stdout + done.stderr)
        metrics = load_metrics(PATROL, self.work / "run")
        self.assertTrue(metrics["mission"]["completed"])
        self.assertEqual(metrics["mission"]["collisions"], 0)
        self.assertLess(metrics["pose"]["site"]["ate_rmse_m"], 0.07)
        self.assertLess(metrics["odometry"]["ate_rmse_m"], 0.02 * metrics["mission"]["distance_m"])

    def test_refuses_the_type_for_a_robot_with_steered_wheels_with_exit_code_2(self):
        done = self.run_patrol("check", "cart", "--set", "wheel_drive.type=mecanum", "--out", "cart", expected=2)
        self.assertIn("wheel_drive.type = mecanum: robot cart: mecanum wheels: wheel", done.stderr)
        self.assertIn("is steered: must not be steered", done.stderr)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v", *sys.argv[3:]])
