#!/usr/bin/env python3
"""Robots with other sensors than those of models/: without a lidar and with two, by runs of the program.

usage: robot_sensors_test.py PATROL SOURCE_DIR
"""
import math
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory

PATROL, SOURCE = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])

# Drives straight ahead by the IMU's clock alone, and ends the mission after five seconds.
WITHOUT_LIDAR = """
import patrol_client

def on_turn(turn):
    assert turn.latest("/scan") is None
    turn.publish_velocity(0.5 if turn.latest("/imu/data") is not None else 0.0)
    turn.mission_is_over = turn.now > 5.0

patrol_client.run(on_turn, topics=["/scan", "/imu/data"], turn_period=0.05)
"""

# Fails unless it gets the scans of both lidars.
TWO_LIDARS = """
import patrol_client

seen = set()

def on_turn(turn):
    for message in turn.messages:
        seen.add((message.topic, message.content.header.frame_id))
    turn.publish_velocity(0.2)
    if turn.now > 2.0:
        assert seen == {("/scan", "lidar"), ("/scan_rear", "lidar_rear")}, seen
        turn.mission_is_over = True

patrol_client.run(on_turn, topics=["/scan", "/scan_rear"], turn_period=0.05)
"""

SCENARIO = """world: street
robot: courier
mission: routes/short.json
time_limit_s: 20.0
"""

REAR = "mounts:\n  - {frame: lidar_rear, x_m: -0.45, z_m: 0.43, yaw_deg: 180.0, preset: utm30lx}\n"


def without(urdf, *frames):
    """Text of a URDF without some of its fixed frames."""
    for frame in frames:
        urdf = re.sub(rf'<joint name="{frame}_joint".*?</joint>', "", urdf, flags=re.S)
        urdf = re.sub(rf'<link name="{frame}">.*?</link>', "", urdf, flags=re.S)
    return urdf


def messages(run, *topics):
    """Topics and decoded messages of a run's log."""
    with open(run / "log.mcap", "rb") as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()])
        return [(channel.topic, content) for _, channel, _, content in reader.iter_decoded_messages(topics=topics or None)]


def points_in_body(scan, x, yaw):
    """Beam ends of a scan in the body, up to 8 m."""
    points = []
    for index, distance in enumerate(scan.ranges):
        if scan.range_min < distance < 8.0:
            angle = yaw + scan.angle_min + index * scan.angle_increment
            points.append((x + distance * math.cos(angle), distance * math.sin(angle)))
    return points


class RobotSensors(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def courier(self, missing=(), profile=""):
        """Makes the robot `courier` from the wheeled robot and returns a scenario of it."""
        models = self.folder / "models/courier"
        models.mkdir(parents=True)
        (models / "courier.urdf").write_text(without((SOURCE / "models/wheeled/wheeled.urdf").read_text(), *missing))
        drive = (SOURCE / "models/wheeled/wheeled.yaml").read_text()
        if "gnss" in missing:
            drive = drive.replace("  gnss: {enabled: true}\n", "")
        if "frame: tdlas" in profile:
            drive = drive.replace("  tdlas: {enabled: false}\n", "")
        (models / "courier.yaml").write_text(drive + profile)
        scenario = self.folder / "courier.yaml"
        scenario.write_text(SCENARIO)
        return scenario

    def patrol(self, *arguments):
        return subprocess.run([PATROL, *map(str, arguments)], cwd=self.folder, capture_output=True, text=True, timeout=280)

    def stack(self, text):
        (self.folder / "stack.py").write_text(text)
        return f"{sys.executable} {self.folder / 'stack.py'}"

    def test_street_patrol_refuses_a_robot_without_a_lidar_with_one_sentence_and_2(self):
        self.courier(["lidar"])
        done = self.patrol("run", SOURCE / "worlds/street/scenarios/patrol.yaml", "--set", "robot=courier", "--set", "actors=[]", "--out", "run")
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertEqual(done.stderr.replace(f"{SOURCE}/", "/"),
                         "patrol: /worlds/street/scenarios/patrol.yaml: robot: courier has no lidar (2D lidar), which stack.slam requires, "
                         "and no tdlas (open-path laser methane meter), which mission requires; add mounts of the frames lidar, tdlas "
                         "(models/courier/courier.yaml, mounts)\n")
        self.assertFalse((self.folder / "run").exists())

    def test_a_file_with_the_robot_is_named_with_its_line(self):
        scenario = self.courier(["lidar"], "mounts: [{frame: tdlas, x_m: 0.4, z_m: 0.2}]\n")
        done = self.patrol("run", scenario, "--out", "run")
        self.assertEqual((done.returncode, done.stderr),
                         (2, f"patrol: {scenario}:2: robot: courier has no lidar (2D lidar), which stack.slam requires; add a mount of the "
                             "frame lidar (models/courier/courier.yaml, mounts)\n"))

    def test_a_robot_without_lidar_and_gnss_is_checked_and_drives_with_an_external_stack(self):
        scenario = self.courier(["lidar", "gnss"])
        checked = self.patrol("check", "courier", "--out", "check")
        self.assertEqual(checked.returncode, 0, checked.stdout + checked.stderr)
        done = self.patrol("run", scenario, "--out", "run", "--stack", self.stack(WITHOUT_LIDAR))
        self.assertEqual(done.returncode, 0, done.stderr)
        topics = {topic for topic, _ in messages(self.folder / "run")}
        self.assertTrue({"/scan", "/scan_rear", "/gnss/fix", "/gas"}.isdisjoint(topics), topics)
        path = [content.pose.pose.position for _, content in messages(self.folder / "run", "/ground_truth/odom")]
        self.assertGreater(math.hypot(path[-1].x - path[0].x, path[-1].y - path[0].y), 1.5)
        for command in (("score", "run"), ("report", "run"), ("replay", "run", "--still", "3", "--out", "still.png")):
            after = self.patrol(*command)
            self.assertEqual(after.returncode, 0, f"{command}: {after.stderr}")

    def test_two_lidars_are_logged_with_ranges_that_agree_and_an_external_stack_gets_both(self):
        scenario = self.courier([], REAR)
        done = self.patrol("run", scenario, "--set", "as_built.enabled=false", "--out", "run", "--stack", self.stack(TWO_LIDARS))
        self.assertEqual(done.returncode, 0, done.stderr)
        logged = messages(self.folder / "run", "/scan", "/scan_rear")
        front = [content for topic, content in logged if topic == "/scan"]
        rear = [content for topic, content in logged if topic == "/scan_rear"]
        self.assertAlmostEqual(len(front), 20, delta=2)
        self.assertAlmostEqual(len(rear), 80, delta=4)
        mounts = {one.child_frame_id: one.transform for _, content in messages(self.folder / "run", "/tf_static") for one in content.transforms}
        self.assertAlmostEqual(mounts["lidar_rear"].translation.x, -0.45, delta=1e-12)
        self.assertAlmostEqual(mounts["lidar_rear"].translation.z, 0.43, delta=1e-12)
        ahead = points_in_body(front[0], mounts["lidar"].translation.x, 0.0)
        behind = points_in_body(rear[0], -0.45, math.pi)
        distances = sorted(min(math.dist(point, other) for other in ahead) for point in behind)
        self.assertGreater(len(distances), 100)
        self.assertLess(distances[len(distances) // 2], 0.05)

    def test_the_built_in_stack_drives_with_two_lidars_and_uses_the_first(self):
        scenario = self.courier([], REAR + "  - {frame: tdlas, x_m: 0.4, z_m: 0.2}\n")
        plain, both = (self.patrol("run", scenario, "--set", "time_limit_s=8", *more, "--out", name)
                       for name, more in (("plain", ("--set", "sensors.lidar_rear.enabled=false")), ("both", ())))
        self.assertEqual((plain.returncode, both.returncode), (4, 4), both.stderr)
        poses = [[content for _, content in messages(self.folder / run, "/pose")] for run in ("plain", "both")]
        self.assertGreater(len(poses[0]), 10)
        self.assertEqual(str(poses[0]), str(poses[1]))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
