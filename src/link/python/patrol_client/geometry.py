"""Transforms of ROS messages as 4 x 4 matrices."""

import numpy as np


def matrix_of(translation, rotation):
    """Returns the matrix of a translation (or position) and a quaternion (or orientation)."""
    x, y, z, w = rotation.x, rotation.y, rotation.z, rotation.w
    matrix = np.eye(4)
    matrix[:3, :3] = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                      [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                      [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
    matrix[:3, 3] = translation.x, translation.y, translation.z
    return matrix


def set_pose(pose, matrix):
    """Sets a geometry_msgs/Pose from a matrix."""
    pose.position.x, pose.position.y, pose.position.z = matrix[:3, 3]
    r = matrix[:3, :3]
    # The largest component comes from the diagonal: no angle is singular.
    squares = np.array([1 + np.trace(r), *(1 + 2 * r[i, i] - np.trace(r) for i in range(3))])
    products = np.array([[squares[0], r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]],
                         [r[2, 1] - r[1, 2], squares[1], r[0, 1] + r[1, 0], r[0, 2] + r[2, 0]],
                         [r[0, 2] - r[2, 0], r[0, 1] + r[1, 0], squares[2], r[1, 2] + r[2, 1]],
                         [r[1, 0] - r[0, 1], r[0, 2] + r[2, 0], r[1, 2] + r[2, 1], squares[3]]])
    largest = int(np.argmax(squares))
    quaternion = products[largest] / (2.0 * np.sqrt(squares[largest]))
    pose.orientation.w, pose.orientation.x, pose.orientation.y, pose.orientation.z = quaternion


def sensor_mount(documents, frame):
    """Returns the transform from the body to a sensor, from the documents of a client. Raises KeyError if it has none."""
    for message in documents:
        if message.topic == "/tf_static":
            for stamped in message.content.transforms:
                if stamped.child_frame_id == frame:
                    return matrix_of(stamped.transform.translation, stamped.transform.rotation)
    raise KeyError(f"no transform of {frame}")
