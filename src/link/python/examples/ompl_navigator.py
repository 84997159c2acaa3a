"""Navigation to the first goal of a tracked robot on a known map: RRT-Connect of OMPL as the global planner, pure pursuit,
dead reckoning by tracks and gyro. It needs `pip install ompl PyYAML`.

patrol run tunnel/navigate --stack "python3 src/link/python/examples/ompl_navigator.py" --set time_limit_s=100
"""

import math
import xml.etree.ElementTree

import numpy as np
import ompl.base
import ompl.geometric
import ompl.util
import yaml

import patrol_client

SPEED, UNDOCKING, LOOK_AHEAD = 0.5, 1.5, 1.0  # m/s, m, m
CLEARANCE, TOLERANCE = 0.65, 0.3  # m
STANDING = 4.0  # s, for the bias of the gyro


def yaw_of(orientation):
    return 2.0 * math.atan2(orientation[2], orientation[3])


def blocked_cells(grid):
    """Cells of an OccupancyGrid nearer than the clearance to an occupied or unknown cell, [row, column]."""
    cells = np.asarray(grid.data).reshape(grid.info.height, grid.info.width)
    blocked = (cells > 50) | (cells < 0)
    radius = math.ceil(CLEARANCE / grid.info.resolution)
    for _ in range(radius):  # grows by one cell in the four directions
        grown = blocked.copy()
        grown[1:] |= blocked[:-1]
        grown[:-1] |= blocked[1:]
        grown[:, 1:] |= blocked[:, :-1]
        grown[:, :-1] |= blocked[:, 1:]
        blocked = grown
    return blocked


class Navigator:
    def start(self, client):
        hello = client.hello
        self.seed = hello.seed % 2**32
        self.grid = next(one.content for one in client.documents if one.topic == "/site_map")
        self.blocked = blocked_cells(self.grid)
        odometry = yaml.safe_load(hello.documents)["stack"]["odometry"]["tracked"]
        sprocket = xml.etree.ElementTree.fromstring(hello.robot).find(".//link[@name='left_sprocket']//cylinder")
        self.meters_per_tick = 2 * math.pi * float(sprocket.get("radius")) / odometry["ticks_per_sprocket_turn"]
        # Start pose in map: surveyed start, and the registration of the map.
        start, registration = hello.site["start"], hello.registration or hello.site["start"]
        turn = yaw_of(registration["orientation"])
        dx, dy = (start["position"][i] - registration["position"][i] for i in (0, 1))
        self.x, self.y = math.cos(turn) * dx + math.sin(turn) * dy, math.cos(turn) * dy - math.sin(turn) * dx
        self.yaw = yaw_of(start["orientation"]) - turn
        self.goal = hello.goals[0]["position"][:2]
        self.ticks = self.last_imu = None
        self.bias, self.num_at_rest, self.traveled = 0.0, 0, 0.0
        self.path, self.next_point = None, 0

    def is_free(self, state):
        """State validity of OMPL."""
        origin, resolution = self.grid.info.origin.position, self.grid.info.resolution
        column, row = int((state[0] - origin.x) / resolution), int((state[1] - origin.y) / resolution)
        return 0 <= row < self.blocked.shape[0] and 0 <= column < self.blocked.shape[1] and not self.blocked[row, column]

    def plan(self):
        ompl.util.RNG.setSeed(self.seed)
        space = ompl.base.RealVectorStateSpace(2)
        bounds, info = ompl.base.RealVectorBounds(2), self.grid.info
        for axis, (low, size) in enumerate(((info.origin.position.x, info.width), (info.origin.position.y, info.height))):
            bounds.setLow(axis, low)
            bounds.setHigh(axis, low + size * info.resolution)
        space.setBounds(bounds)
        setup = ompl.geometric.SimpleSetup(space)
        setup.setStateValidityChecker(self.is_free)
        start, goal = space.allocState(), space.allocState()
        start[0], start[1] = self.x, self.y
        goal[0], goal[1] = self.goal
        setup.setStartAndGoalStates(start, goal, TOLERANCE)
        planner = ompl.geometric.RRTConnect(setup.getSpaceInformation())
        planner.setRange(2.0)
        setup.setPlanner(planner)
        checks = iter(range(100_000))  # a limit of time would make the path depend on the computer
        setup.solve(ompl.base.PlannerTerminationCondition(lambda: next(checks, None) is None))
        if not setup.haveExactSolutionPath():
            raise RuntimeError("OMPL finds no path to the first goal")
        path = setup.getSolutionPath()
        path.interpolate(int(path.length() / 0.2))
        self.path = [(path.getState(i)[0], path.getState(i)[1]) for i in range(path.getStateCount())]

    def add(self, message):
        """Dead reckoning."""
        content = message.content
        if message.topic == "/track_ticks":
            if self.ticks is not None:
                distance = 0.5 * self.meters_per_tick * (content.left + content.right - self.ticks)
                self.x += distance * math.cos(self.yaw)
                self.y += distance * math.sin(self.yaw)
                self.traveled += abs(distance)
            self.ticks = content.left + content.right
        elif message.topic == "/imu/data":
            stamp, rate = content.header.stamp.sec + 1e-9 * content.header.stamp.nanosec, content.angular_velocity.z
            if stamp < STANDING:
                self.num_at_rest += 1
                self.bias += (rate - self.bias) / self.num_at_rest
            elif self.last_imu is not None:
                self.yaw += (rate - self.bias) * (stamp - self.last_imu)
            self.last_imu = stamp

    def on_turn(self, turn):
        for message in turn.messages:
            self.add(message)
        pose = turn.new("/pose")
        pose.header.frame_id = "map"
        pose.pose.pose.position.x, pose.pose.pose.position.y = self.x, self.y
        pose.pose.pose.orientation.z, pose.pose.pose.orientation.w = math.sin(self.yaw / 2), math.cos(self.yaw / 2)
        turn.publish("/pose", pose)
        if turn.now < STANDING:
            return
        if self.path is None and self.traveled < UNDOCKING:
            return turn.publish_velocity(-0.25)  # backward from the charging post
        if self.path is None:
            self.plan()
        turn.publish_velocity(*self.pursue())
        if math.dist((self.x, self.y), self.goal) < TOLERANCE and not turn.is_last:
            turn.publish_velocity(0.0)
            event = turn.new("/events")
            event.kind, event.subject, event.value, event.pose = "goal_reached", "goal_1", 1.0, pose.pose.pose
            turn.publish("/events", event)
            turn.mission_is_over = True

    def pursue(self):
        """Pure pursuit: velocity and yaw rate toward the point of the path at the look-ahead distance."""
        while self.next_point + 1 < len(self.path) and math.dist((self.x, self.y), self.path[self.next_point]) < LOOK_AHEAD:
            self.next_point += 1
        target = self.path[self.next_point]
        bearing = math.atan2(target[1] - self.y, target[0] - self.x) - self.yaw
        bearing = math.atan2(math.sin(bearing), math.cos(bearing))
        if abs(bearing) > 0.8:
            return 0.0, 0.0, math.copysign(0.4, bearing)
        return SPEED, 0.0, 2.0 * SPEED * math.sin(bearing) / LOOK_AHEAD


navigator = Navigator()
patrol_client.run(navigator.on_turn, topics=["/track_ticks", "/imu/data"], turn_period=0.05, stack="ompl",
                  on_start=navigator.start)
