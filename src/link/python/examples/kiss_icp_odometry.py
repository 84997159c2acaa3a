"""Odometry by KISS-ICP on a 3D lidar: publishes /odom and /pose, and drives nothing. It needs `pip install kiss-icp`.

patrol run street/short --set sensors.lidar3d.enabled=true --out out/kiss/run
patrol feed out/kiss/run --stack "python3 src/link/python/examples/kiss_icp_odometry.py" --out out/kiss/fed
"""

import numpy as np
from kiss_icp.config import load_config
from kiss_icp.kiss_icp import KissICP

import patrol_client

FIELDS = np.dtype({"names": ["x", "y", "z", "time"], "formats": ["<f4"] * 4, "offsets": [0, 4, 8, 18], "itemsize": 22})


def matrix(translation, rotation):
    """Transform from a translation and a quaternion of ROS."""
    x, y, z, w = rotation.x, rotation.y, rotation.z, rotation.w
    transform = np.eye(4)
    transform[:3, :3] = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                         [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                         [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
    transform[:3, 3] = translation.x, translation.y, translation.z
    return transform


def quaternion(rotation):
    """Quaternion x, y, z, w of a rotation matrix with an angle below pi."""
    w = 0.5 * np.sqrt(max(1.0 + np.trace(rotation), 1e-12))
    return np.array([rotation[2, 1] - rotation[1, 2], rotation[0, 2] - rotation[2, 0], rotation[1, 0] - rotation[0, 1],
                     4 * w * w]) / (4 * w)


class Odometry:
    def start(self, client):
        """Reads the mount of the lidar."""
        transforms = next(one.content for one in client.documents if one.topic == "/tf_static").transforms
        mount = next(one.transform for one in transforms if one.child_frame_id == "lidar3d")
        self.T_body_lidar = matrix(mount.translation, mount.rotation)
        config = load_config(None)
        config.data.max_range, config.data.min_range, config.data.deskew = 60.0, 0.6, True
        config.mapping.voxel_size = 0.5
        config.registration.max_num_threads = 1  # the sum of the residuals depends on the order of threads
        self.icp = KissICP(config)

    def on_turn(self, turn):
        for message in turn.messages:
            cloud = message.content
            points = np.frombuffer(cloud.data.tobytes(), FIELDS)
            xyz = np.stack([points["x"], points["y"], points["z"]], axis=1).astype(np.float64)
            times = points["time"].astype(np.float64)
            self.icp.register_frame(xyz, (times - times.min()) / max(np.ptp(times), 1e-9))
            self.publish(turn, cloud.header.stamp)

    def publish(self, turn, stamp):
        T_odom_body = self.T_body_lidar @ self.icp.last_pose @ np.linalg.inv(self.T_body_lidar)
        orientation = quaternion(T_odom_body[:3, :3])
        for topic, frame in (("/odom", "odom"), ("/pose", "map")):
            message = turn.new(topic)
            message.header.stamp, message.header.frame_id = stamp, frame
            pose = message.pose.pose
            pose.position.x, pose.position.y, pose.position.z = T_odom_body[:3, 3]
            pose.orientation.x, pose.orientation.y, pose.orientation.z, pose.orientation.w = orientation
            turn.publish(topic, message)


odometry = Odometry()
patrol_client.run(odometry.on_turn, topics=["/points"], turn_period=0.1, stack="kiss_icp", on_start=odometry.start)
