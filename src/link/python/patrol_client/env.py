"""Gymnasium environment on Patrol: each episode is one run of a scenario, with the agent as the stack of the robot.

    env = PatrolEnv("street/short", patrol="build/patrol", episode_s=20.0)
    observation, info = env.reset(seed=1)
    observation, reward, terminated, truncated, info = env.step(env.action_space.sample())
"""

import json
import pathlib
import shutil
import subprocess
import tempfile
import time

import gymnasium
import numpy as np

from patrol_client.client import Client, LinkError


# Usual full scales of inertial sensors: 2000 degrees per second and 16 g.
_IMU_RANGE = np.array([34.9] * 3 + [157.0] * 3, np.float32)


class PatrolEnv(gymnasium.Env):
    """Environment whose action is the velocity of the robot, and whose observation is its lidar and its IMU.

    Action: forward velocity and yaw rate, and the velocity to the left between them for a robot that moves sideways. 1 and
    -1 are the limits of the base (`limits`). Observation: `scan`, ranges of the newest scan in m, a beam without return at
    the maximum range; `imu`, newest angular velocity (rad/s) and acceleration (m/s²); `command`, the last action.

    An episode ends (`terminated`) when the robot falls, and is cut off (`truncated`) after `episode_s` or at the time limit
    of the scenario. `info` has the simulated time (`time`, s) and, at the end, the score of the run (`metrics`). The reward
    is 0 unless `reward(turn)` is given, which sees what a robot sees. The same seed and actions give the same episode.

    `patrol`: the program. `turn_period`: time of a step, s. `settings`: "path=value" of the scenario. `out`: folder that
    keeps the run directories, one for each episode; None: none is kept.
    """

    metadata = {"render_modes": []}

    def __init__(self, scenario, *, patrol="patrol", turn_period=0.1, episode_s=None, settings=(), reward=None, out=None,
                 render_mode=None):
        self.render_mode = render_mode
        self._command = [patrol, "run", str(scenario)]
        for setting in settings:
            self._command += ["--set", setting]
        if episode_s is not None:
            self._command += ["--set", f"time_limit_s={episode_s}"]
        self._turn_period = turn_period
        self._reward = reward or (lambda turn: 0.0)
        self._temporary = tempfile.TemporaryDirectory(prefix="patrol-env-")
        self._out = pathlib.Path(out) if out is not None else None
        self._episode = 0
        self._process = self._client = self._turn = None
        try:
            self._start_run(seed=1)
            self._make_spaces()
            self._stop_run()
        except BaseException:
            self.close()
            raise

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        self._stop_run()
        self._start_run(int(self.np_random.integers(2**31)))
        return self._observation(), {"time": self._turn.now}

    def step(self, action):
        if self._turn is None:
            raise gymnasium.error.ResetNeeded("call reset before step")
        self._last_action = action = np.clip(np.asarray(action, np.float32), -1.0, 1.0)
        limits = self.limits
        forward, yaw_rate = float(action[0]), float(action[-1])
        left = float(action[1]) if len(action) == 3 else 0.0
        self._turn.publish_velocity(forward * (limits.forward if forward > 0.0 else limits.backward), left * limits.sideways,
                                    yaw_rate * limits.yaw_rate)
        self._client.done(self._turn)
        self._next_turn()
        turn, info = self._turn, {"time": self._turn.now}
        has_fallen = turn.latest("/fall") is not None
        observation, reward = self._observation(), float(self._reward(turn))
        if turn.is_last:
            info["metrics"] = self._finish_run()
        return observation, reward, has_fallen, turn.is_last and not has_fallen, info

    def close(self):
        self._stop_run()
        self._temporary.cleanup()

    def _make_spaces(self):
        self.limits, scan = self._client.hello.limits, self._scan
        box = gymnasium.spaces.Box
        self.action_space = box(-1.0, 1.0, self._last_action.shape, np.float32)
        self.observation_space = gymnasium.spaces.Dict({
            "scan": box(0.0, float(scan.range_max), (len(scan.ranges),), np.float32),
            "imu": box(-_IMU_RANGE, _IMU_RANGE),
            "command": self.action_space})

    def _observation(self):
        ranges = np.asarray(self._scan.ranges, np.float32)
        limit = np.float32(self._scan.range_max)
        rate, acceleration = self._imu.angular_velocity, self._imu.linear_acceleration
        imu = np.array([rate.x, rate.y, rate.z, acceleration.x, acceleration.y, acceleration.z], np.float32)
        return {"scan": np.clip(np.where(np.isfinite(ranges), ranges, limit), 0.0, limit),
                "imu": np.clip(imu, -_IMU_RANGE, _IMU_RANGE),
                "command": self._last_action.copy()}

    def _start_run(self, seed):
        self._episode += 1
        self._directory = (self._out or pathlib.Path(self._temporary.name)) / f"episode_{self._episode}"
        socket_path = pathlib.Path(self._temporary.name) / f"socket_{self._episode}"
        with open(pathlib.Path(self._temporary.name) / "patrol.log", "w") as log:
            self._process = subprocess.Popen(
                self._command + ["--seed", str(seed), "--stack", f"unix:{socket_path}", "--out", str(self._directory)],
                stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=log)
        while not socket_path.exists():
            if self._process.poll() is not None:
                raise LinkError((pathlib.Path(self._temporary.name) / "patrol.log").read_text().strip())
            time.sleep(0.002)
        self._client = _connect(socket_path)
        self._client.begin("patrol_client.env", ["/scan", "/imu/data", "/fall"], self._turn_period)
        self._scan = self._imu = None
        self._next_turn()
        while self._scan is None or self._imu is None:  # until the sensors have delivered
            if self._turn.is_last:
                raise LinkError("the run ended before the first scan and IMU message")
            self._client.done(self._turn)
            self._next_turn()
        self._last_action = np.zeros(3 if self._client.hello.limits.sideways > 0.0 else 2, np.float32)

    def _next_turn(self):
        self._turn = self._client.next_turn()
        self._scan = self._turn.latest("/scan") or self._scan
        self._imu = self._turn.latest("/imu/data") or self._imu

    def _finish_run(self):
        """Ends the last turn and returns the metrics of the run."""
        self._client.done(self._turn)
        self._turn = None
        self._process.wait()
        metrics = json.loads((self._directory / "metrics.json").read_text())
        self._stop_run()
        return metrics

    def _stop_run(self):
        if self._client is not None:
            self._client.close()
        if self._process is not None and self._process.poll() is None:
            self._process.terminate()
            self._process.wait()
        if self._out is None and self._episode > 0:
            shutil.rmtree(self._directory, ignore_errors=True)
        self._process = self._client = self._turn = None


def _connect(socket_path):
    """The socket exists a moment before it listens."""
    deadline = time.monotonic() + 10.0
    while True:
        try:
            return Client(f"unix:{socket_path}")
        except ConnectionRefusedError:
            if time.monotonic() > deadline:
                raise
            time.sleep(0.002)
