#!/usr/bin/env python3
"""Poses of ROS messages and matrices agree for every angle.

usage: geometry_test.py
"""
import types
import unittest

import numpy as np

from patrol_client.geometry import matrix_of, sensor_mount, set_pose


def pose_of(position, quaternion):
    return types.SimpleNamespace(position=types.SimpleNamespace(**dict(zip("xyz", position))),
                                 orientation=types.SimpleNamespace(**dict(zip("xyzw", quaternion))))


class Geometry(unittest.TestCase):
    def test_a_quarter_turn_to_the_left_turns_x_to_y(self):
        pose = pose_of((1.0, 2.0, 3.0), (0.0, 0.0, np.sqrt(0.5), np.sqrt(0.5)))
        np.testing.assert_allclose(matrix_of(pose.position, pose.orientation) @ [1.0, 0.0, 0.0, 1.0], [1.0, 3.0, 3.0, 1.0], atol=1e-12)

    def test_matrices_there_and_back_for_1000_rotations_and_half_turns(self):
        random = np.random.default_rng(7)
        quaternions = [*random.normal(size=(1000, 4)), *np.eye(4), [1.0, 1.0, 0.0, 1e-9], [0.0, 0.0, 1.0, -1e-12]]
        for quaternion in quaternions:
            quaternion = np.asarray(quaternion) / np.linalg.norm(quaternion)
            was = pose_of(random.normal(size=3), quaternion)
            matrix, found = matrix_of(was.position, was.orientation), pose_of((0, 0, 0), (0, 0, 0, 1))
            set_pose(found, matrix)
            back = np.array([found.orientation.x, found.orientation.y, found.orientation.z, found.orientation.w])
            np.testing.assert_allclose(np.sign(back @ quaternion) * back, quaternion, atol=1e-12)
            np.testing.assert_allclose(matrix_of(found.position, found.orientation), matrix, atol=1e-12)

    def test_a_missing_sensor_is_named(self):
        with self.assertRaisesRegex(KeyError, "no transform of lidar3d"):
            sensor_mount([], "lidar3d")


if __name__ == "__main__":
    unittest.main()
