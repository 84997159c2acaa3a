#!/usr/bin/env python3
"""Other people's tools read a run directory and find in it what it says of itself.

usage: run_files_test.py RUN_DIRECTORY
"""
import json
import math
import pathlib
import sys
import unittest
import xml.etree.ElementTree

import numpy as np
import yaml
from evo.core import metrics, sync
from evo.tools import file_interface
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
from PIL import Image

RUN = pathlib.Path(sys.argv[1])

# What the brief names and what ROS tools need, with the types that ROS 2 has for them.
TYPES = {
    "/scan": "sensor_msgs/msg/LaserScan",
    "/imu/data": "sensor_msgs/msg/Imu",
    "/joint_states": "sensor_msgs/msg/JointState",
    "/odom": "nav_msgs/msg/Odometry",
    "/pose": "geometry_msgs/msg/PoseWithCovarianceStamped",
    "/cmd_vel": "geometry_msgs/msg/TwistStamped",
    "/map": "nav_msgs/msg/OccupancyGrid",
    "/plan": "nav_msgs/msg/Path",
    "/tf": "tf2_msgs/msg/TFMessage",
    "/tf_static": "tf2_msgs/msg/TFMessage",
    "/ground_truth/odom": "nav_msgs/msg/Odometry",
}


def seconds(stamp):
    return stamp.sec + 1e-9 * stamp.nanosec


class Log(unittest.TestCase):
    """The official MCAP reader and its ROS 2 decoder."""

    def messages(self, topic, count=None):
        """The first `count` messages of a topic, decoded."""
        found = []
        with open(RUN / "log.mcap", "rb") as file:
            reader = make_reader(file, decoder_factories=[DecoderFactory()], validate_crcs=True)
            for _, _, _, message in reader.iter_decoded_messages(topics=[topic]):
                found.append(message)
                if count and len(found) == count:
                    break
        return found

    def test_summary_lists_topics_with_ros_2_types(self):
        with open(RUN / "log.mcap", "rb") as file:
            reader = make_reader(file, validate_crcs=True)
            self.assertEqual(reader.get_header().profile, "ros2")
            summary = reader.get_summary()
        types = {channel.topic: summary.schemas[channel.schema_id].name for channel in summary.channels.values()}
        for topic, expected in TYPES.items():
            self.assertEqual(types.get(topic), expected, topic)
        self.assertEqual({schema.encoding for schema in summary.schemas.values()}, {"ros2msg"})
        self.assertEqual({channel.message_encoding for channel in summary.channels.values()}, {"cdr"})
        self.assertEqual(sum(summary.statistics.channel_message_counts.values()), summary.statistics.message_count)

    def test_every_message_decodes_and_log_times_never_go_back(self):
        count, last = 0, 0
        with open(RUN / "log.mcap", "rb") as file:
            reader = make_reader(file, decoder_factories=[DecoderFactory()], validate_crcs=True)
            total = reader.get_summary().statistics.message_count
            for _, _, message, decoded in reader.iter_decoded_messages(log_time_order=False):
                self.assertIsNotNone(decoded)
                self.assertGreaterEqual(message.log_time, last)
                last = message.log_time
                count += 1
        self.assertEqual(count, total)

    def test_a_scan_has_the_geometry_it_says(self):
        scan = self.messages("/scan", 3)[-1]
        self.assertEqual(scan.header.frame_id, "lidar")
        self.assertAlmostEqual(scan.angle_max, scan.angle_min + (len(scan.ranges) - 1) * scan.angle_increment, delta=1e-3)
        self.assertAlmostEqual(len(scan.ranges) * scan.angle_increment, 2 * math.pi, delta=1e-2)
        ranges = np.array(scan.ranges)
        hits = ranges[np.isfinite(ranges)]
        self.assertGreater(len(hits), 100)
        self.assertTrue(((hits >= scan.range_min) & (hits <= scan.range_max)).all(), "REP 117")

    def test_the_imu_at_the_start_reads_gravity_upwards(self):
        imus = self.messages("/imu/data", 200)
        up = np.mean([imu.linear_acceleration.z for imu in imus])
        self.assertAlmostEqual(up, 9.81, delta=0.3)
        self.assertEqual(imus[0].orientation_covariance[0], -1.0, "REP 145: no orientation")

    def test_ground_truth_is_what_truth_tum_says(self):
        odometry = self.messages("/ground_truth/odom")
        self.assertEqual(odometry[0].header.frame_id, "world")
        self.assertEqual(odometry[0].child_frame_id, "base_link")
        by_time = {round(seconds(o.header.stamp), 6): o.pose.pose.position for o in odometry}
        tum = np.loadtxt(RUN / "truth.tum")
        self.assertGreater(len(tum), 100)
        for t, x, y, z in tum[:: max(1, len(tum) // 50), :4]:
            position = by_time[round(t, 6)]
            np.testing.assert_allclose([position.x, position.y, position.z], [x, y, z], atol=1e-8)

    def test_frames_chain_from_map_to_base_link(self):
        edges = {(t.header.frame_id, t.child_frame_id) for message in self.messages("/tf", 500) for t in message.transforms}
        self.assertLessEqual({("map", "odom"), ("odom", "base_footprint"), ("base_footprint", "base_link")}, edges)
        static = {(t.header.frame_id, t.child_frame_id) for t in self.messages("/tf_static")[0].transforms}
        self.assertLessEqual({("base_link", "lidar"), ("base_link", "imu")}, static)


class Trajectories(unittest.TestCase):
    def test_evo_agrees_on_the_aligned_error_to_a_micrometre(self):
        truth = file_interface.read_tum_trajectory_file(RUN / "truth.tum")
        estimate = file_interface.read_tum_trajectory_file(RUN / "estimate.tum")
        truth, estimate = sync.associate_trajectories(truth, estimate, max_diff=0.01)  # evo_ape's own choice
        estimate.align(truth, correct_scale=False)
        error = metrics.APE(metrics.PoseRelation.translation_part)
        error.process_data((truth, estimate))
        ours = json.loads((RUN / "metrics.json").read_text())["pose"]["aligned"]
        for name, figure in (("rmse_m", metrics.StatisticsType.rmse), ("mean_m", metrics.StatisticsType.mean),
                             ("max_m", metrics.StatisticsType.max)):
            self.assertAlmostEqual(error.get_statistic(figure), ours[name], delta=1e-6, msg=name)
        self.assertEqual(len(error.error), ours["pairs"])

    def test_odometry_opens_too(self):
        self.assertGreater(file_interface.read_tum_trajectory_file(RUN / "odometry.tum").num_poses, 100)


class Maps(unittest.TestCase):
    def test_both_maps_open_with_three_greys_only(self):
        for name in ("map", "truth_map"):
            with self.subTest(name):
                about = yaml.safe_load((RUN / f"{name}.yaml").read_text())
                self.assertEqual(about["mode"], "trinary")
                self.assertEqual(len(about["origin"]), 3)
                with Image.open(RUN / about["image"]) as image:
                    pixels = np.asarray(image)
                self.assertLessEqual(set(np.unique(pixels)), {0, 205, 254})
                self.assertGreater((pixels == 0).sum(), 100, "walls")
                self.assertGreater((pixels == 254).sum(), 1000, "free space")

    def test_built_walls_lie_where_the_metrics_say(self):
        """Every occupied cell, by brute force: its error in map_errors.pgm is its distance to the truth, and the metrics are their statistics.

        truth_map holds the observable part of the reference, so a distance to it may only be larger than the error.
        """
        def image_of(name):
            with Image.open(RUN / name) as image:
                return np.asarray(image)[::-1]

        def occupied(name):
            about = yaml.safe_load((RUN / f"{name}.yaml").read_text())
            rows, cols = np.nonzero(image_of(about["image"]) == 0)
            return np.array(about["origin"][:2]) + about["resolution"] * (np.stack([cols, rows], axis=1) + 0.5)

        ours = json.loads((RUN / "metrics.json").read_text())["map"]
        errors = 1e-3 * image_of("map_errors.pgm")[image_of("map.pgm") == 0].astype(float)  # in whole millimeters
        is_saturated = errors > 0.2535
        self.assertEqual(len(errors), ours["occupied_cells"])
        self.assertLess(is_saturated.mean(), 0.02)
        # The saturated cells, 254 mm and more, are known from the mean only.
        rest = ours["nearest_mean_m"] * len(errors) - errors[~is_saturated].sum()
        self.assertGreater(rest, 0.254 * is_saturated.sum() - 0.5e-3 * len(errors))
        self.assertLess(rest, 1.0 * is_saturated.sum() + 0.5e-3 * len(errors))
        self.assertAlmostEqual(float(np.percentile(errors, 95)), ours["nearest_p95_m"], delta=0.6e-3)

        origin = ours["origin_in_world"]
        c, s = math.cos(origin["yaw_rad"]), math.sin(origin["yaw_rad"])
        built = occupied("map") @ np.array([[c, s], [-s, c]]) + np.array([origin["x_m"], origin["y_m"]])
        true = occupied("truth_map")

        def distance_to_truth(points):
            return np.concatenate([np.sqrt(((true[None] - part[:, None]) ** 2).sum(axis=2).min(axis=1))
                                   for part in np.array_split(points, 1 + len(points) // 200)])

        # Ours is bilinear between the centers of the reference's cells.
        about = yaml.safe_load((RUN / "truth_map.yaml").read_text())
        position = (built - np.array(about["origin"][:2])) / about["resolution"] - 0.5
        low = np.floor(position)
        expected = np.zeros(len(built))
        for corner in ((0, 0), (1, 0), (0, 1), (1, 1)):
            center = np.array(about["origin"][:2]) + about["resolution"] * (low + corner + 0.5)
            weight = np.prod(np.where(np.array(corner) == 1, position - low, 1.0 - (position - low)), axis=1)
            expected += weight * distance_to_truth(center)
        rounding = 0.6e-3
        self.assertLessEqual(float((errors - expected)[~is_saturated].max()), rounding)
        is_same = np.abs(errors - expected) <= rounding
        self.assertGreater(is_same[expected < 0.1].mean(), 0.95)


class Report(unittest.TestCase):
    def test_junit_is_green_and_names_what_was_checked(self):
        suites = xml.etree.ElementTree.parse(RUN / "junit.xml").getroot()
        self.assertEqual(suites.tag, "testsuites")
        self.assertEqual(suites.get("failures"), "0")
        self.assertEqual(suites.get("errors"), "0")
        cases = suites.findall("testsuite/testcase")
        self.assertEqual(len(cases), int(suites.get("tests")))
        self.assertEqual(suites.findall(".//failure") + suites.findall(".//error"), [])
        names = [case.get("name") for case in cases]
        for metric in yaml.safe_load((RUN / "scenario.yaml").read_text())["expect"]:
            self.assertTrue(any(name.startswith(metric) for name in names), metric)

    def test_nothing_is_half_written(self):
        self.assertFalse((RUN / "INCOMPLETE").exists())
        self.assertEqual([file.name for file in RUN.glob("*.part")], [])

    def test_the_scenario_is_written_out_with_every_default(self):
        scenario = yaml.safe_load((RUN / "scenario.yaml").read_text())
        self.assertIn("seed", scenario)
        self.assertIn("beams", scenario["sensors"]["lidar"])


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v"])
