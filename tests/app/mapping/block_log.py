"""A CARMEN log made here: a robot drives twice round a block of offices."""
import itertools
import math

STEP_M, BEAMS, START_S = 0.15, 180, 976052890.25


def walls():
    """Outer walls of 20 m x 14 m, a block in the middle with niches, and cupboards along the walls."""
    corners = [(0, 0), (20, 0), (20, 14), (0, 14)]
    segments = list(zip(corners, corners[1:] + corners[:1]))
    for x0, y0, x1, y1 in [(3, 3, 9, 11), (9, 4, 12, 10), (12, 3, 17, 11), (5, 0, 6.2, 0.5), (13, 0, 13.7, 0.6), (19.4, 5, 20, 7), (8, 13.5, 10, 14), (0, 9, 0.5, 10.4), (0, 4, 0.4, 4.8)]:
        box = [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]
        segments += list(zip(box, box[1:] + box[:1]))
    return segments


def beams_towards(ax, ay, bx, by):
    """Beams that may hit the segment from a to b, given in the frame of the lidar with beam 0 along x; all where the segment passes the lidar closely."""
    first = math.atan2(ay, ax)
    turn = math.remainder(math.atan2(by, bx) - first, 2 * math.pi)
    if abs(turn) > 3.0:
        return range(BEAMS)
    low = math.floor(min(first, first + turn) * BEAMS / math.pi) - 1
    high = math.ceil(max(first, first + turn) * BEAMS / math.pi) + 2
    return itertools.chain(*(range(max(0, low + shift), min(BEAMS, high + shift)) for shift in (-2 * BEAMS, 0, 2 * BEAMS)))


def ranges_from(x, y, yaw, segments):
    angles = [yaw - 0.5 * math.pi + beam * math.pi / BEAMS for beam in range(BEAMS)]
    directions = [(math.cos(angle), math.sin(angle)) for angle in angles]
    found = [81.83] * BEAMS
    c0, s0 = directions[0]
    for (ax, ay), (bx, by) in segments:
        ex, ey, px, py, qx, qy = bx - ax, by - ay, ax - x, ay - y, bx - x, by - y
        for beam in beams_towards(c0 * px + s0 * py, c0 * py - s0 * px, c0 * qx + s0 * qy, c0 * qy - s0 * qx):
            c, s = directions[beam]
            determinant = c * ey - s * ex
            if abs(determinant) < 1e-12:
                continue
            along = (px * ey - py * ex) / determinant
            share = (px * s - py * c) / determinant
            if along > 0.0 and 0.0 <= share <= 1.0 and along < found[beam]:
                found[beam] = along
    return found


def drive():
    """Poses (x, y, yaw) round the block, twice."""
    corners = [(1.6, 1.5), (18.2, 1.5), (18.2, 12.4), (1.6, 12.4), (1.6, 1.5)]
    poses = []
    for _ in range(2):
        for (ax, ay), (bx, by) in zip(corners, corners[1:]):
            heading, length = math.atan2(by - ay, bx - ax), math.hypot(bx - ax, by - ay)
            if poses:
                turn = math.remainder(heading - poses[-1][2], 2 * math.pi)
                poses += [(ax, ay, poses[-1][2] + turn * k / 10) for k in range(1, 11)]
            steps = int(length / STEP_M)
            poses += [(ax + (bx - ax) * k / steps, ay + (by - ay) * k / steps, heading) for k in range(steps + 1)]
    return poses


def carmen_lines(poses, lidar=(0.0, 0.0, 0.0), way=1.03, turn=1.0, steering=0.01, max_range=80.0, no_return="81.83"):
    """A log of a lidar at (x, y, yaw) in the body, and of wheels that count `way` times the way, `turn` times the turn, and `steering` rad more for each meter that they count."""
    segments, odometry, last = walls(), (0.0, 0.0, 0.0), None
    lines = ["# CARMEN Logfile", "PARAM robot_frontlaser_offset 0.0 0.0 host 0.0"]
    for k, (x, y, yaw) in enumerate(poses):
        if last:
            dx, dy = x - last[0], y - last[1]
            forward = way * (math.cos(last[2]) * dx + math.sin(last[2]) * dy)
            turned = turn * math.remainder(yaw - last[2], 2 * math.pi) + steering * abs(forward)
            odometry = (odometry[0] + forward * math.cos(odometry[2]), odometry[1] + forward * math.sin(odometry[2]), odometry[2] + turned)
        last = (x, y, yaw)
        eye = (x + lidar[0] * math.cos(yaw) - lidar[1] * math.sin(yaw), y + lidar[0] * math.sin(yaw) + lidar[1] * math.cos(yaw), yaw + lidar[2])
        noise = [0.01 * math.sin(12.9898 * (k * BEAMS + beam)) for beam in range(BEAMS)]
        readings = " ".join(f"{r + n:.2f}" if r < max_range else no_return for r, n in zip(ranges_from(*eye, segments), noise))
        pose = " ".join(f"{value:.6f}" for value in odometry)
        stamp = START_S + 0.2 * k
        lines.append(f"FLASER {BEAMS} {readings} {pose} {pose} {stamp:.6f} host {stamp - START_S:.6f}")
    return lines
