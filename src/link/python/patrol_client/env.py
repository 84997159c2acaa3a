"""Gymnasium environment on Patrol: each episode is one run of a scenario, with the agent as the stack of the robot.

    env = PatrolEnv("street/short", patrol="build/patrol", episode_s=20.0)
    observation, info = env.reset(seed=1)
    observation, reward, terminated, truncated, info = env.step(env.action_space.sample())
"""

import json
import math
import pathlib
import re
import shutil
import subprocess
import tempfile
import time
import xml.etree.ElementTree

import gymnasium
import numpy as np

from patrol_client.client import Client, LinkError


# Usual full scales of inertial sensors: 2000 degrees per second and 16 g.
_IMU_RANGE = np.array([34.9] * 3 + [157.0] * 3, np.float32)


_PAUSE_S = 86400  # limit of the time between two steps, the largest value of stack.timeout_s
_TIME_TO_END_S = 10.0  # of a program whose run has failed
_NO_ERRORS = ("patrol: waiting for ", "patrol: warning: ")  # beginnings of other lines of the program


class PatrolEnv(gymnasium.Env):
    """Environment whose action is the velocity of the robot, and whose observation is its lidar and its IMU.

    Action: forward velocity and yaw rate, and the velocity to the left between them for a robot that moves sideways. 1 and
    -1 are the limits of the base (`limits`). Observation: `scan`, ranges of the newest scan in m, a beam without return at
    the maximum range; `imu`, newest angular velocity (rad/s) and acceleration (m/s²); `command`, the last action.

    An episode ends (`terminated`) when the robot falls, and is cut off (`truncated`) after `episode_s`, or without it at
    the time limit of the scenario. `info` has the simulated time (`time`, s) and, at the end, the score of the run
    (`metrics`). The reward is 0 unless `reward(turn)` is given, which sees what a robot sees. In the last step `turn` is the
    last turn of the run, with all messages since the action. The same seed and actions give the same episode.

    `patrol`: the program. `turn_period`: time of a step, s. `settings`: "path=value" of the scenario. `out`: folder that
    keeps the run directories, one for each episode; the numbers of `episode_1`, `episode_2`, ... continue after those in the
    folder, also if several environments use it. None: none is kept.

    The program waits for the next step for a day: a learner may pause. `stack.timeout_s` in `settings` is another limit, s.

    Raises LinkError with the reason of the program if a run cannot start or ends with an error. Raises ValueError for an
    action of another shape or with a number that is not finite, for a step that is not shorter than the episode, and for
    settings that the environment sets: `seed`, `stack.command`, and `time_limit_s` beside `episode_s`.
    """

    metadata = {"render_modes": []}

    def __init__(self, scenario, *, patrol="patrol", turn_period=0.1, episode_s=None, settings=(), reward=None, out=None,
                 render_mode=None):
        _check_options(turn_period, episode_s, settings)
        self.render_mode = render_mode
        self._command = [patrol, "run", str(scenario), "--set", f"stack.timeout_s={_PAUSE_S}"]
        for setting in settings:
            self._command += ["--set", setting]
        if episode_s is not None:
            self._command += ["--set", f"time_limit_s={episode_s}"]
        self._turn_period = turn_period
        self._reward = reward or (lambda turn: 0.0)
        self._temporary = tempfile.TemporaryDirectory(prefix="patrol-env-")
        self._log = pathlib.Path(self._temporary.name) / "patrol.log"
        self._out = pathlib.Path(out).absolute() if out is not None else None
        self._num_runs = 0
        self._limit_ns = None
        self._is_closed = False
        self._directory = self._process = self._client = self._turn = None
        try:
            self._start_run(1, pathlib.Path(self._temporary.name) / "probe")
            self._make_spaces()
            self._stop_run()
        except BaseException:
            self.close()
            raise

    def reset(self, *, seed=None, options=None):
        if self._is_closed:
            raise gymnasium.error.ClosedEnvironmentError("reset of a closed environment")
        super().reset(seed=seed)
        self._stop_run()
        directory = pathlib.Path(self._temporary.name) / "episode" if self._out is None else _new_directory(self._out)
        self._start_run(int(self.np_random.integers(2**31)), directory)
        return self._observation(), {"time": self._turn.now}

    def step(self, action):
        if self._turn is None:
            raise gymnasium.error.ResetNeeded("call reset before step")
        self._last_action = action = self._checked(action)
        limits = self.limits
        forward, yaw_rate = float(action[0]), float(action[-1])
        left = float(action[1]) if len(action) == 3 else 0.0
        try:
            self._turn.publish_velocity(forward * (limits.forward if forward > 0.0 else limits.backward),
                                        left * limits.sideways, yaw_rate * limits.yaw_rate)
            self._client.done(self._turn)
            self._next_turn()
        except LinkError as error:
            raise self._failure(error) from error
        turn, info = self._turn, {"time": self._turn.now}
        has_fallen = turn.latest("/fall") is not None
        observation, reward = self._observation(), float(self._reward(turn))
        if turn.is_last:
            info["metrics"] = self._finish_run()
        return observation, reward, has_fallen, turn.is_last and not has_fallen, info

    def close(self):
        self._is_closed = True
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

    def _checked(self, action):
        action = np.asarray(action, np.float32)
        if action.shape != self.action_space.shape:
            raise ValueError(f"action of shape {action.shape}: must be {self.action_space.shape}")
        if not np.isfinite(action).all():
            raise ValueError(f"action {action}: contains a number that is not finite")
        return np.clip(action, -1.0, 1.0)

    def _observation(self):
        ranges = np.asarray(self._scan.ranges, np.float32)
        limit = np.float32(self._scan.range_max)
        rate, acceleration = self._imu.angular_velocity, self._imu.linear_acceleration
        imu = np.array([rate.x, rate.y, rate.z, acceleration.x, acceleration.y, acceleration.z], np.float32)
        return {"scan": np.clip(np.where(np.isfinite(ranges), ranges, limit), 0.0, limit),
                "imu": np.clip(imu, -_IMU_RANGE, _IMU_RANGE),
                "command": self._last_action.copy()}

    def _start_run(self, seed, directory):
        self._num_runs += 1
        self._directory = directory
        socket_path = pathlib.Path(self._temporary.name) / f"socket_{self._num_runs}"
        try:
            with open(self._log, "w") as log:
                self._process = subprocess.Popen(
                    self._command + ["--seed", str(seed), "--stack", f"unix:{socket_path}", "--out", str(directory)],
                    stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=log)
            self._client = self._connect(socket_path)
            self._client.begin("patrol_client.env", ["/scan", "/imu/data", "/fall"], self._turn_period)
            self._scan = self._imu = None
            self._next_turn()
            while self._scan is None or self._imu is None:  # until the sensors have delivered
                self._client.done(self._turn)
                if self._turn.is_last:
                    raise LinkError("the run ended before the first scan and IMU message")
                self._next_turn()
        except LinkError as error:
            raise self._failure(error) from error
        except BaseException:
            self._stop_run()
            raise
        self._last_action = np.zeros(3 if self._client.hello.limits.sideways > 0.0 else 2, np.float32)

    def _connect(self, socket_path):
        """Waits until the simulator listens. Raises LinkError if it ends before."""
        while True:
            try:
                return Client(f"unix:{socket_path}")
            except (FileNotFoundError, ConnectionRefusedError) as error:
                if self._process.poll() is not None:
                    raise LinkError("the program ended before the start of the run") from error
                time.sleep(0.002)

    def _next_turn(self):
        """Waits for the next turn. At the time limit and after a fall, the end of the run follows, and its last turn is taken
        with the messages of the turns before it."""
        turn = self._client.next_turn()
        if self._limit_ns is None:
            self._limit_ns = _time_limit_ns(self._directory)
        while not turn.is_last and (turn.now_ns >= self._limit_ns or turn.latest("/fall") is not None):
            self._client.done(turn)
            following = self._client.next_turn()
            following.messages[:0] = turn.messages
            turn = following
        self._turn = turn
        self._scan = turn.latest("/scan") or self._scan
        self._imu = turn.latest("/imu/data") or self._imu

    def _finish_run(self):
        """Ends the last turn and returns the metrics of the run."""
        try:
            self._client.done(self._turn)
            self._process.wait()
            metrics = json.loads((self._directory / "metrics.json").read_text())
        except (LinkError, OSError) as error:
            raise self._failure(LinkError(f"the run was not completed: {error}")) from error
        self._stop_run()
        return metrics

    def _failure(self, error):
        """Ends the run and returns its error with the reason of the program."""
        if self._client is not None:
            self._client.close()
        self._wait()
        reason = self._reason()
        self._stop_run()
        return LinkError(reason if str(error) in reason else f"{error}: {reason}" if reason else str(error))

    def _reason(self):
        """Returns why the run ended: the error in its verdict, or else the last line of the program; empty if unknown."""
        if (self._directory / "metrics.json").exists():
            error = xml.etree.ElementTree.parse(self._directory / "junit.xml").find(".//error")
            if error is not None:
                return error.get("message")
        lines = [line for line in self._log.read_text(errors="replace").split("\n") if line and not line.startswith(_NO_ERRORS)]
        return lines[-1] if lines else ""

    def _wait(self):
        """Gives the program, whose connection is closed, time to write its run directory."""
        try:
            self._process.wait(_TIME_TO_END_S)
        except subprocess.TimeoutExpired:
            pass  # _stop_run ends it

    def _stop_run(self):
        is_kept = self._directory is not None and self._directory.parent == self._out
        if is_kept and self._turn is not None:
            self._client.fail("the environment was reset or closed during the episode")
        if self._client is not None:
            self._client.close()
        if is_kept and self._process is not None:
            self._wait()
        if self._process is not None and self._process.poll() is None:
            self._process.terminate()
            self._process.wait()
        if self._directory is not None and not is_kept:
            shutil.rmtree(self._directory, ignore_errors=True)
        self._directory = self._process = self._client = self._turn = None


def _check_options(turn_period, episode_s, settings):
    """Raises TypeError or ValueError if the options of an environment exclude each other or are out of range."""
    for name, seconds in (("turn_period", turn_period), ("episode_s", episode_s)):
        if seconds is not None and not (math.isfinite(seconds) and seconds > 0.0):
            raise ValueError(f"{name}={seconds}: must be a positive number of seconds")
    if episode_s is not None and turn_period >= episode_s:
        raise ValueError(f"turn_period={turn_period}: must be shorter than episode_s={episode_s}")
    if isinstance(settings, (str, bytes)):
        raise TypeError(f'settings={settings!r}: must be a list of "path=value"')
    own = {"seed": "reset(seed=...) sets it", "stack.command": "the environment is the stack"}
    if episode_s is not None:
        own["time_limit_s"] = "episode_s sets it"
    for setting in settings:
        if (path := setting.partition("=")[0]) in own:
            raise ValueError(f"settings: {setting}: {own[path]}")


def _new_directory(folder):
    """Makes and returns the run directory of an episode, with the number after the largest one in the folder."""
    folder.mkdir(parents=True, exist_ok=True)
    matches = [re.fullmatch(r"episode_(\d+)", path.name) for path in folder.iterdir()]
    number = max((int(match[1]) for match in matches if match), default=0) + 1
    while True:
        directory = folder / f"episode_{number}"
        try:
            directory.mkdir()
            return directory
        except FileExistsError:  # made by another environment
            number += 1


def _time_limit_ns(directory):
    """Returns the time limit of a run that has started, ns."""
    text = (directory / "scenario.yaml").read_text()
    return round(float(re.search(r"^time_limit_s: (\S+)$", text, re.MULTILINE)[1]) * 1e9)
