#!/usr/bin/env python3
"""patrol feed with recorded logs: a stack gets every scan with its odometry, and its estimates are scored.

usage: feed_log_test.py PATROL SOURCE
"""
import json
import math
import pathlib
import struct
import subprocess
import sys
import tempfile
import unittest

from mcap.reader import make_reader
from mcap.writer import Writer

from block_log import START_S, carmen_lines, drive

PATROL, SOURCE = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
EXAMPLES = SOURCE / "src/link/python/examples"

# Publishes the recorded odometry as its pose, every second scan by its turn period.
ODOMETRY = """
import patrol_client

def on_turn(turn):
    for message in turn.messages:
        pose = turn.new("/pose")
        pose.header.stamp = message.content.header.stamp
        pose.pose.pose = message.content.pose.pose
        turn.publish("/pose", pose)

patrol_client.run(on_turn, topics=["/recorded_odometry"], turn_period=0.35)
"""

# Checks the documents of a recorded log, and publishes nothing.
SILENT = """
import patrol_client

def on_start(client):
    hello = client.hello
    assert (hello.robot, hello.site, hello.scenario, hello.limits.forward) == ("", {}, "block.log", 0.0), hello
    assert "method: graph" in hello.documents

patrol_client.run(lambda turn: None, on_start=on_start)
"""

FAILING = """
import patrol_client

def on_turn(turn):
    if turn.now > 976052900.0:
        raise ValueError("no more scans")
    turn.publish("/pose", turn.new("/pose"))

patrol_client.run(on_turn, turn_period=0.0)
"""


FAR = """
import patrol_client

def on_turn(turn):
    pose = turn.new("/pose")
    pose.pose.pose.position.x, pose.pose.pose.orientation.w = 1e9, 1.0
    turn.publish("/pose", pose)

patrol_client.run(on_turn, turn_period=0.0)
"""

# Publishes a trajectory of one pose whose quaternion is zero.
NO_ROTATION = """
import patrol_client

def on_turn(turn):
    trajectory = turn.new("/trajectory")
    trajectory.poses.append(trajectory.element("poses"))
    trajectory.poses[0].pose.orientation.w = 0.0
    turn.publish("/trajectory", trajectory)

patrol_client.run(on_turn, turn_period=0.0)
"""

# Publishes the recorded poses, and the number of samples of a sensor that Patrol does not know.
AS_RECORDED = """
import patrol_client

COUNT = ("user_msgs/msg/Count", "uint32 count\\n")
num_samples = 0

def on_start(client):
    assert client.hello.robot == "" and client.hello.scenario == "robot.mcap", client.hello
    client.declare("/count", *COUNT)

def on_turn(turn):
    global num_samples
    for message in turn.messages:
        if message.topic == "/recorded/radar":
            assert list(message.content.strength) == [1.5, 2.5], message.content.strength
            num_samples += 1
        if message.topic == "/recorded/pose":
            pose = turn.new("/pose")
            pose.header.stamp = message.content.header.stamp
            pose.pose.pose = message.content.pose
            turn.publish("/pose", pose)
    if turn.is_last:
        turn.publish("/count", turn.client.type_of("/count")(count=num_samples))

patrol_client.run(on_turn, turn_period=0.5, on_start=on_start)
"""

_HEADER = ("=" * 80 + "\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n" + "=" * 80 +
           "\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n")
POSE = ("std_msgs/Header header\ngeometry_msgs/Pose pose\n" + "=" * 80 + "\nMSG: geometry_msgs/Pose\nPoint position\n"
        "Quaternion orientation\n" + "=" * 80 + "\nMSG: geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z\n" + "=" * 80 +
        "\nMSG: geometry_msgs/Quaternion\nfloat64 x\nfloat64 y\nfloat64 z\nfloat64 w\n" + _HEADER)


def write_recording(path, poses):
    """MCAP log of another program: poses, a sensor of its own at 20 Hz, and text in JSON without a schema."""
    with open(path, "wb") as file:
        writer = Writer(file)
        writer.start(profile="ros2")
        pose = writer.register_channel("/pose", "cdr", writer.register_schema("geometry_msgs/msg/PoseStamped", "ros2msg", POSE.encode()))
        radar = writer.register_channel("/radar", "cdr", writer.register_schema("user_msgs/msg/Radar", "ros2msg", b"float64[] strength\n"))
        notes = writer.register_channel("notes", "json", 0)
        for k, (x, y, yaw) in enumerate(poses):
            now = round((START_S + 0.2 * k) * 1e9)
            head = struct.pack("<4sii", bytes([0, 1, 0, 0]), *divmod(now, 10**9)) + struct.pack("<I4s", 4, b"map\0")
            data = head + struct.pack("<7d", x, y, 0, 0, 0, math.sin(yaw / 2), math.cos(yaw / 2))
            writer.add_message(pose, now, data, now)
            for i in range(4):
                writer.add_message(radar, now + i * 50_000_000, struct.pack("<4sI4x2d", bytes([0, 1, 0, 0]), 2, 1.5, 2.5), now)
            writer.add_message(notes, now, b"{}", now)
        writer.finish()


class FeedLog(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder_object = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.folder_object.name)
        cls.poses = drive()
        cls.lines = carmen_lines(cls.poses)
        cls.log = cls.folder / "block.log"
        cls.log.write_text("\n".join(cls.lines) + "\n")
        cls.relations = cls.folder / "block.relations"
        cls.relations.write_text("".join(cls.relation(i, i + 40) for i in range(0, len(cls.poses) - 40, 20)))

    @classmethod
    def tearDownClass(cls):
        cls.folder_object.cleanup()

    @classmethod
    def relation(cls, i, j):
        """True relative pose of two scans, in the format of the benchmark."""
        (x0, y0, yaw0), (x1, y1, yaw1) = cls.poses[i], cls.poses[j]
        dx, dy = x1 - x0, y1 - y0
        x, y = math.cos(yaw0) * dx + math.sin(yaw0) * dy, -math.sin(yaw0) * dx + math.cos(yaw0) * dy
        return f"{START_S + 0.2 * i:.6f} {START_S + 0.2 * j:.6f} {x:.6f} {y:.6f} 0 0 0 {math.remainder(yaw1 - yaw0, 2 * math.pi):.6f}\n"

    def patrol(self, *arguments, code=0):
        done = subprocess.run([PATROL, *map(str, arguments)], capture_output=True, text=True, timeout=280, cwd=SOURCE)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done

    def stack(self, name, text):
        path = self.folder / name
        path.write_text(text)
        return f"{sys.executable} {path}"

    def feed(self, name, *more, log=None, code=0):
        out = self.folder / name
        done = self.patrol("feed", log or self.log, "--out", out, *more, code=code)
        return json.loads((out / "metrics.json").read_text()), out, done

    def reference(self):
        """True trajectory (TUM)."""
        path = self.folder / "true.tum"
        path.write_text("".join(f"{START_S + 0.2 * k:.6f} {x} {y} 0 0 0 {math.sin(yaw / 2)} {math.cos(yaw / 2)}\n" for k, (x, y, yaw) in enumerate(self.poses)))
        return path

    def messages(self, out):
        with open(out / "log.mcap", "rb") as file:
            return [(channel.topic, message.log_time, message.data) for _, channel, message in make_reader(file).iter_messages(log_time_order=False)]

    def test_the_built_in_mapping_has_the_error_of_patrol_slam(self):
        fed, out, _ = self.feed("built_in", "--relations", self.relations)
        self.patrol("slam", self.log, "--out", self.folder / "mapped")
        score = json.loads(self.patrol("score", "--estimate", self.folder / "mapped/estimate.tum", "--relations", self.relations, "--json").stdout)
        error = fed["estimate"]["relations"]["translation_m"]["mean"]
        self.assertEqual(fed["estimate"]["topic"], "/trajectory")
        self.assertGreater(error, 0.0005)
        self.assertAlmostEqual(error, score["translation_m"]["mean"], delta=0.05 * score["translation_m"]["mean"])
        self.assertEqual((fed["estimate"]["poses"], fed["online"]["poses"]), (len(self.poses), len(self.poses)))
        self.assertGreater(fed["online"]["relations"]["translation_m"]["max"], error)
        self.assertEqual(sorted(file.name for file in out.iterdir()), ["estimate.tum", "log.mcap", "map.pgm", "map.yaml", "metrics.json", "online.tum", "settings.yaml"])

    def test_another_process_gives_the_same_messages(self):
        _, here, _ = self.feed("here")
        _, there, _ = self.feed("there", "--stack", f"{PATROL} stack")
        self.assertEqual([one for one in self.messages(there) if one[0] != "/stack/turns"], self.messages(here))
        self.assertEqual((there / "estimate.tum").read_bytes(), (here / "estimate.tum").read_bytes())

    def test_every_scan_is_delivered_at_any_turn_period(self):
        fed, out, done = self.feed("odometry", "--stack", self.stack("odometry.py", ODOMETRY), "--relations", self.relations)
        self.assertEqual((fed["estimate"]["topic"], fed["estimate"]["poses"]), ("/pose", len(self.poses)))
        self.assertNotIn("online", fed)
        self.assertGreater(fed["estimate"]["relations"]["translation_m"]["mean"], 0.1)  # odometry 3 % too long
        topics = [one[0] for one in self.messages(out)]
        self.assertEqual((topics.count("/scan"), topics.count("/recorded_odometry")), (len(self.poses), len(self.poses)))
        self.assertAlmostEqual(topics.count("/stack/turns"), len(self.poses) / 2, delta=2)
        self.assertIn("/pose: ", done.stdout)

    def test_a_reference_trajectory_scores_as_well(self):
        self.patrol("slam", self.log, "--out", self.folder / "reference")
        fed, _, _ = self.feed("referred", "--reference", self.folder / "reference/estimate.tum")
        self.assertLess(fed["estimate"]["reference"]["pose"]["ate_rmse_m"], 0.005)
        self.assertEqual(fed["estimate"]["reference"]["pose"]["coverage"], 1.0)

    def test_a_stack_that_publishes_nothing_is_reported(self):
        fed, out, done = self.feed("silent", "--stack", self.stack("silent.py", SILENT), "--relations", self.relations, code=2)
        self.assertIsNone(fed["estimate"])
        self.assertIn("not published: /pose", done.stdout)
        self.assertIn("patrol: the estimate is not scored by the reference: not published: /pose\n", done.stderr)
        self.assertFalse((out / "estimate.tum").exists())
        self.assertFalse((out / "INCOMPLETE").exists())
        self.feed("silent_without_reference", "--stack", self.stack("silent.py", SILENT))

    def test_a_reference_of_another_time_is_2_as_in_score(self):
        later = self.folder / "later.tum"
        later.write_text("".join(f"{START_S + 5000 + k} {k} 0 0 0 0 0 1\n" for k in range(5)))
        fed, out, done = self.feed("later", "--reference", later, code=2)
        self.assertIn("not_scored", fed["estimate"])
        score = self.patrol("score", "--estimate", out / "estimate.tum", "--reference", later, code=2)
        self.assertEqual(done.stderr.strip().splitlines()[-1].split("reference: ")[1], score.stderr.strip().removeprefix("patrol: "))

    def test_a_pose_far_away_is_a_failure_of_the_stack(self):
        fed, out, _ = self.feed("far", "--stack", self.stack("far.py", FAR), "--relations", self.relations, code=3)
        self.assertIn("/pose: contains a position with a coordinate of 1e+09 m", fed["message"])
        self.assertFalse((out / "INCOMPLETE").exists())

    def test_a_failing_stack_has_a_verdict_and_its_poses(self):
        fed, out, done = self.feed("failing", "--stack", self.stack("failing.py", FAILING), code=3)
        self.assertEqual(fed["status"], "stack failed")
        self.assertIn("ValueError: no more scans", fed["message"])
        self.assertGreater(fed["estimate"]["poses"], 20)
        self.assertIn("stack failed: ", done.stdout)
        self.assertIn("no more scans", (out / "stack.log").read_text())

    def test_wrong_input_has_one_line_and_leaves_nothing(self):
        out = self.folder / "refused"
        broken = self.folder / "broken.relations"
        broken.write_text("1 2 three\n")
        run = self.folder / "no_run"
        run.mkdir()
        for arguments, text in [((self.folder / "nothing.log",), "nothing.log"),
                                ((self.log, "--relations", broken), "broken.relations:1"),
                                ((self.log, "--reference", self.folder / "nothing.tum"), "nothing.tum"),
                                ((self.log, "--set", "slam.methd=rbpf"), "slam.methd"),
                                ((self.log, "--stack", "no_such_program"), "no_such_program"),
                                ((self.log, "--max-dt-s", "-1"), "--max-dt-s: Value -1 not in range"),
                                ((run, "--relations", self.relations), "only for a recorded log"),
                                ((run, "--set", "world=tunnel"), "--set world=tunnel: must be stack."),
                                ((run, "--set", "stack.command=true"), "--stack selects the stack")]:
            done = self.patrol("feed", *arguments, "--out", out, code=2)
            self.assertEqual(len(done.stderr.strip().splitlines()), 1, done.stderr)
            self.assertIn(text, done.stderr)
            self.assertFalse(out.exists())

    def test_a_log_of_one_scan_has_one_turn(self):
        one = self.folder / "block.log.one" / "block.log"
        one.parent.mkdir()
        one.write_text(next(line for line in self.lines if line.startswith("FLASER")) + "\n")
        fed, out, _ = self.feed("one", "--stack", f"{PATROL} stack", "--reference", self.reference(), log=one, code=2)
        self.assertEqual(fed["estimate"]["poses"], 1)
        self.assertIn("not_scored", fed["estimate"])  # a trajectory of one pose

    def test_a_trajectory_without_rotations_is_refused(self):
        fed, _, _ = self.feed("no_rotation", "--stack", self.stack("no_rotation.py", NO_ROTATION), code=3)
        self.assertIn("/trajectory: contains a quaternion whose norm is not 1", fed["message"])

    def test_a_silent_stack_ends_the_feeding(self):
        sleeper = self.stack("sleeper.py", "import time, patrol_client\npatrol_client.run(lambda turn: time.sleep(30))\n")
        fed, _, _ = self.feed("sleeper", "--stack", sleeper, "--set", "stack.timeout_s=1", code=4)
        self.assertEqual(fed["status"], "stack silent")

    def test_a_fed_log_can_be_fed_again(self):
        _, first, _ = self.feed("first")
        again, _, _ = self.feed("again", log=first / "log.mcap")
        self.assertEqual(again["estimate"]["poses"], len(self.poses))
        done = self.patrol("feed", first / "log.mcap", "--out", first, code=2)
        self.assertIn("must not be the directory of", done.stderr)
        self.assertTrue((first / "log.mcap").exists())

    def test_as_recorded_every_message_is_delivered_unchanged(self):
        recording = self.folder / "robot.mcap"
        write_recording(recording, self.poses)
        fed, out, done = self.feed("as_recorded", "--as-recorded", "--stack", self.stack("as_recorded.py", AS_RECORDED), "--reference", self.reference(), log=recording)
        self.assertEqual((fed["estimate"]["topic"], fed["estimate"]["poses"]), ("/pose", len(self.poses)))
        self.assertLess(fed["estimate"]["reference"]["pose"]["ate_rmse_m"], 1e-6)
        self.assertEqual(fed["log"]["messages"], 5 * len(self.poses))
        self.assertEqual(min(log_time for _, log_time, _ in self.messages(out)), round(START_S * 1e9))
        self.assertIn(f"left out: notes: {len(self.poses)} messages", done.stdout)
        written = self.messages(out)
        with open(recording, "rb") as file:
            recorded = [("/recorded" + channel.topic, message.log_time, message.data)
                        for _, channel, message in make_reader(file).iter_messages(log_time_order=False) if channel.topic != "notes"]
        self.assertEqual([one for one in written if one[0].startswith("/recorded/")], recorded)
        self.assertEqual([data for topic, _, data in written if topic == "/count"], [struct.pack("<4sI", bytes([0, 1, 0, 0]), 4 * len(self.poses))])
        turns = sum(topic == "/stack/turns" for topic, _, _ in written)
        self.assertAlmostEqual(turns, 0.2 * len(self.poses) / 0.5, delta=3)

    def test_as_recorded_refuses_what_it_cannot_feed(self):
        out, recording = self.folder / "refused", self.folder / "refused.mcap"
        write_recording(recording, self.poses[:5])
        stack = ("--as-recorded", "--stack", f"{PATROL} stack")
        for arguments, text in [((recording, "--as-recorded"), "--as-recorded: needs --stack"),
                                ((self.log, *stack), "block.log"),
                                ((recording, *stack, "--set", "slam.method=rbpf"), "slam"),
                                ((self.folder, *stack), "--as-recorded: only for a recorded log")]:
            done = self.patrol("feed", *arguments, "--out", out, code=2)
            self.assertEqual(len(done.stderr.strip().splitlines()), 1, done.stderr)
            self.assertIn(text, done.stderr)
            self.assertFalse(out.exists())

    def test_a_damaged_log_leaves_nothing(self):
        damaged = self.folder / "damaged.log"
        damaged.write_text("\n".join(self.lines[:40]) + "\n" + self.lines[40][:300] + "\n")
        done = self.patrol("feed", damaged, "--out", self.folder / "damaged", code=2)
        self.assertIn("damaged.log:41", done.stderr)
        self.assertFalse((self.folder / "damaged").exists())

    def test_kiss_icp_keeps_the_recorded_odometry_straight(self):
        fed, _, _ = self.feed("kiss", "--stack", f"{sys.executable} {EXAMPLES / 'kiss_icp_scans.py'}", "--relations", self.relations)
        error = fed["estimate"]["relations"]["translation_m"]["mean"]
        self.assertEqual(fed["estimate"]["poses"], len(self.poses))
        self.assertGreater(error, 0.001)
        self.assertLess(error, 0.1)  # recorded odometry: 0.18 m


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v"])
