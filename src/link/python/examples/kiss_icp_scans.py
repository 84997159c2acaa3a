"""Odometry by KISS-ICP on a 2D lidar, started from the recorded odometry: publishes /pose. It needs `pip install kiss-icp`.

patrol feed LOG --stack "python3 src/link/python/examples/kiss_icp_scans.py" --relations RELATIONS
"""

import numpy as np
from kiss_icp.config import load_config
from kiss_icp.kiss_icp import KissICP

import patrol_client
from patrol_client.geometry import matrix_of, sensor_mount, set_pose


class Odometry:
    def start(self, client):
        """Reads the mount of the lidar."""
        self.T_body_lidar = sensor_mount(client.documents, "lidar")
        self.T_odom_lidar = None  # by the recorded odometry, at the scan before
        config = load_config(None)
        config.data.max_range, config.data.min_range, config.data.deskew = 30.0, 0.1, False
        config.mapping.voxel_size = 0.1  # chosen with the log of tests/app/mapping/block_log.py
        config.registration.max_num_threads = 1  # the sum of the residuals depends on the order of threads
        self.icp = KissICP(config)

    def on_turn(self, turn):
        odometry = None
        for message in turn.messages:
            if message.topic == "/recorded_odometry":
                odometry = odometry or message.content.pose.pose  # the first of a scan is at its stamp
            else:
                self.register(message.content, matrix_of(odometry.position, odometry.orientation) @ self.T_body_lidar)
                self.publish(turn, message.content.header.stamp)
                odometry = None

    def register(self, scan, T_odom_lidar):
        if self.T_odom_lidar is not None:
            self.icp.last_delta = np.linalg.inv(self.T_odom_lidar) @ T_odom_lidar  # initial guess of the registration
        self.T_odom_lidar = T_odom_lidar
        ranges = scan.ranges.astype(np.float64)
        angles = scan.angle_min + scan.angle_increment * np.arange(len(ranges))
        is_return = np.isfinite(ranges) & (ranges < scan.range_max)
        points = np.stack([ranges * np.cos(angles), ranges * np.sin(angles), np.zeros(len(ranges))], axis=1)[is_return]
        self.icp.register_frame(points, np.zeros(len(points)))

    def publish(self, turn, stamp):
        message = turn.new("/pose")
        message.header.stamp, message.header.frame_id = stamp, "map"
        set_pose(message.pose.pose, self.T_body_lidar @ self.icp.last_pose @ np.linalg.inv(self.T_body_lidar))
        turn.publish("/pose", message)


odometry = Odometry()
patrol_client.run(odometry.on_turn, topics=["/scan", "/recorded_odometry"], turn_period=0.0, stack="kiss_icp", on_start=odometry.start)
