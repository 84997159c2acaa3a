"""Odometry by KISS-ICP on a 3D lidar: publishes /odom and /pose, and drives nothing. It needs `pip install kiss-icp`.

patrol run street/short --set sensors.lidar3d.enabled=true --out out/kiss/run
patrol feed out/kiss/run --stack "python3 src/link/python/examples/kiss_icp_odometry.py" --out out/kiss/fed
"""

import numpy as np
from kiss_icp.config import load_config
from kiss_icp.kiss_icp import KissICP

import patrol_client
from patrol_client.geometry import sensor_mount, set_pose

FIELDS = np.dtype({"names": ["x", "y", "z", "time"], "formats": ["<f4"] * 4, "offsets": [0, 4, 8, 18], "itemsize": 22})


class Odometry:
    def start(self, client):
        """Reads the mount of the lidar."""
        self.T_body_lidar = sensor_mount(client.documents, "lidar3d")
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
        for topic, frame in (("/odom", "odom"), ("/pose", "map")):
            message = turn.new(topic)
            message.header.stamp, message.header.frame_id = stamp, frame
            set_pose(message.pose.pose, T_odom_body)
            turn.publish(topic, message)


odometry = Odometry()
patrol_client.run(odometry.on_turn, topics=["/points"], turn_period=0.1, stack="kiss_icp", on_start=odometry.start)
