"""Follows the wall on the right at a distance of one meter for twenty meters. Run it with
patrol run street/short --stack "python3 src/link/python/examples/wall_follower.py"."""

import numpy as np

import patrol_client

WALL_DISTANCE = 1.0  # m
SPEED = 0.4  # m/s
SECONDS = 50.0


def nearest(scan, from_deg, to_deg):
    """Distance of the nearest beam end between two directions, counterclockwise from ahead, m."""
    angles = scan.angle_min + scan.angle_increment * np.arange(len(scan.ranges))
    angles = np.degrees(np.arctan2(np.sin(angles), np.cos(angles)))
    ranges = scan.ranges[(angles >= from_deg) & (angles <= to_deg)]
    ranges = ranges[(ranges > scan.range_min) & (ranges < scan.range_max)]
    return ranges.min() if len(ranges) else scan.range_max


def on_turn(turn):
    scan = turn.latest("/scan")
    if scan is None:
        return
    ahead, right, right_ahead = nearest(scan, -20, 20), nearest(scan, -110, -70), nearest(scan, -60, -30)
    error = min(right, 0.8 * right_ahead) - WALL_DISTANCE  # positive: too far from the wall
    yaw_rate = np.clip(-0.8 * error, -0.5, 0.5) if ahead > 1.2 else 0.6
    turn.publish_velocity(SPEED if ahead > 1.2 else 0.0, 0.0, yaw_rate)
    turn.mission_is_over = turn.now > SECONDS


patrol_client.run(on_turn, topics=["/scan"], turn_period=0.05, stack="wall follower")
