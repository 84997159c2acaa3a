#!/usr/bin/env python3
"""The Gymnasium environment keeps the rules of Gymnasium, and an episode is determined by its seed and its actions.

usage: env_test.py PATROL SOURCE
"""
import os
import pathlib
import sys
import tempfile
import unittest
import warnings

import gymnasium
import numpy as np
from gymnasium.utils.env_checker import check_env

from patrol_client.client import LinkError
from patrol_client.env import PatrolEnv

PATROL, SOURCE = sys.argv[1], sys.argv[2]
os.chdir(SOURCE)


def episode(env, seed, actions):
    observation, _ = env.reset(seed=seed)
    observations = [observation]
    for action in actions:
        observation, _, terminated, truncated, info = env.step(action)
        observations.append(observation)
        if terminated or truncated:
            return observations, terminated, truncated, info
    return observations, False, False, info


def same(a, b):
    return all(np.array_equal(one[key], other[key]) for one, other in zip(a, b, strict=True) for key in one)


class Env(unittest.TestCase):
    def make(self, scenario="street/short", **options):
        env = PatrolEnv(scenario, patrol=PATROL, **options)
        self.addCleanup(env.close)
        return env

    def test_check_env_finds_nothing(self):
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            check_env(self.make(episode_s=3.0), skip_render_check=True)

    def test_spaces_are_those_of_the_robot(self):
        legs = self.make(episode_s=3.0)
        self.assertEqual(legs.action_space.shape, (3,))  # a quadruped walks sideways
        self.assertEqual((legs.limits.forward, legs.limits.sideways, legs.limits.yaw_rate), (1.0, 0.3, 1.0))
        tracks = self.make("tunnel/navigate", episode_s=3.0)
        self.assertEqual(tracks.action_space.shape, (2,))
        self.assertNotEqual(legs.observation_space["scan"].shape, (0,))

    def test_an_episode_is_determined_by_its_seed_and_its_actions(self):
        env = self.make(episode_s=3.0)
        draw = np.random.default_rng(1)
        actions = [draw.uniform(env.action_space.low, env.action_space.high) for _ in range(10)]
        first, second, other = (episode(env, seed, actions)[0] for seed in (1, 1, 2))
        self.assertTrue(same(first, second))
        self.assertFalse(same(first, other))

    def test_a_time_limit_truncates_and_the_run_is_scored(self):
        env = self.make(episode_s=4.0)
        _, terminated, truncated, info = episode(env, 1, [np.array([1.0, 0.0, 0.0])] * 100)
        self.assertEqual((terminated, truncated), (False, True))
        self.assertAlmostEqual(info["time"], 4.0, places=6)
        self.assertGreater(info["metrics"]["mission"]["distance_m"], 1.0)
        with self.assertRaises(Exception):
            env.step(env.action_space.sample())

    def test_a_fall_ends_the_run_and_is_its_verdict(self):
        with tempfile.TemporaryDirectory() as out:
            env = self.make(episode_s=10.0, settings=["locomotion.max_forward_mps=3"], out=out)
            _, terminated, truncated, info = episode(env, 3, [np.ones(3)] * 100)
            self.assertEqual((terminated, truncated), (True, False))
            self.assertTrue(info["metrics"]["mission"]["fell"])
            self.assertAlmostEqual(info["time"], info["metrics"]["mission"]["duration_s"], places=6)
            self.assertNotIn("stack failed", (pathlib.Path(out) / "episode_1/junit.xml").read_text())
            with self.assertRaises(gymnasium.error.ResetNeeded):
                env.step(env.action_space.sample())

    def test_every_step_takes_time_and_has_one_reward(self):
        limits = ({"episode_s": 1.0}, {"settings": ["time_limit_s=1.0"]}, {"episode_s": 0.95},
                  {"episode_s": 1.0, "settings": ["stack.compute.model=fixed", "stack.compute.delay_s=0.05"]})
        for options in limits:
            turns = []
            env = self.make(reward=lambda turn: turns.append((turn.now, turn.is_last, len(turn.messages))) or 1.0, **options)
            observation, info = env.reset(seed=3)
            times, is_over = [info["time"]], False
            while not is_over:
                before = observation
                observation, reward, _, is_over, info = env.step(np.full(3, 0.5))
                self.assertFalse(np.array_equal(before["imu"], observation["imu"]))
                self.assertEqual((reward, turns[-1][:2]), (1.0, (info["time"], is_over)))
                self.assertGreater(turns[-1][2], 0)
                times.append(info["time"])
            self.assertEqual(len(turns), len(times) - 1)
            self.assertGreater(min(np.diff(times)), 0.04, times)
            self.assertEqual(times[-1], options.get("episode_s", 1.0))

    def test_run_directories_continue_with_the_next_number(self):
        with tempfile.TemporaryDirectory() as folder:
            out = pathlib.Path(folder, "new/out")
            first = self.make(episode_s=0.5, out=out)
            self.assertFalse(out.exists())  # the constructor has no episode
            self.assertTrue(episode(first, 1, [np.zeros(3)] * 10)[2])
            log = (out / "episode_1/log.mcap").read_bytes()
            second, third = (self.make(episode_s=0.5, out=out) for _ in range(2))
            second.reset(seed=2)
            third.reset(seed=2)  # at once
            self.assertTrue(episode(third, 3, [np.zeros(3)] * 10)[2])
            second.close()
            self.assertEqual(sorted(path.name for path in out.iterdir()), [f"episode_{number}" for number in (1, 2, 3, 4)])
            self.assertEqual((out / "episode_1/log.mcap").read_bytes(), log)
            self.assertEqual(list(out.glob("*/INCOMPLETE")), [])
            given_up = [path.parent.name for path in sorted(out.glob("*/junit.xml"))
                        if "the environment was reset or closed during the episode" in path.read_text()]
            self.assertEqual(given_up, ["episode_2", "episode_3"])

    def test_an_invalid_action_is_an_error_and_the_episode_continues(self):
        env = self.make(episode_s=3.0)
        env.reset(seed=1)
        for action in (np.zeros(2), 0.0, np.array([0.0, np.nan, 0.0]), np.full(3, np.inf)):
            with self.assertRaisesRegex(ValueError, "action"):
                env.step(action)
        self.assertAlmostEqual(env.step(np.zeros(3))[4]["time"], 0.3)

    def test_a_killed_program_is_an_error_and_the_next_one_begins(self):
        env = self.make(episode_s=3.0)
        env.reset(seed=1)
        env._process.kill()
        env._process.wait()
        with self.assertRaises(LinkError):
            env.step(np.zeros(3))
        with self.assertRaises(gymnasium.error.ResetNeeded):
            env.step(np.zeros(3))
        self.assertAlmostEqual(env.reset(seed=1)[1]["time"], 0.2)
        env.close()
        env.close()
        with self.assertRaises(gymnasium.error.ClosedEnvironmentError):
            env.reset()

    def test_a_learner_may_pause_for_a_day_and_the_reason_of_a_shorter_limit_is_named(self):
        with tempfile.TemporaryDirectory() as out:
            env = self.make(episode_s=3.0, out=out)
            env.reset(seed=1)
            self.assertIn("\n  timeout_s: 86400\n", (pathlib.Path(out) / "episode_1/scenario.yaml").read_text())
        env = self.make(episode_s=3.0, settings=["stack.timeout_s=5"])
        env.reset(seed=1)
        env._process.wait()  # the pause
        with self.assertRaisesRegex(LinkError, r"the stack was silent at 0\.200 s: no answer within 5 s"):
            env.step(np.zeros(3))
        self.assertAlmostEqual(env.reset(seed=1)[1]["time"], 0.2)

    def test_environments_in_processes(self):
        envs = gymnasium.vector.AsyncVectorEnv([lambda: PatrolEnv("street/short", patrol=PATROL, episode_s=1.0)] * 2)
        self.addCleanup(envs.close)
        envs.reset(seed=[1, 2])
        for _ in range(10):
            observation, _, _, _, _ = envs.step(np.zeros((2, 3), np.float32))
        self.assertEqual(observation["command"].shape, (2, 3))

    def test_the_error_of_the_program_is_named_after_it_has_connected(self):
        with self.assertRaisesRegex(LinkError, r"closed the connection: patrol: --set start.left_m=1000: .*no ground"):
            PatrolEnv("street/short", patrol=PATROL, settings=["start.left_m=1000"])

    def test_options_that_exclude_each_other_are_refused_at_construction(self):
        for error, text, options in ((ValueError, "turn_period=1.0: must be shorter than episode_s=1.0", {"turn_period": 1.0, "episode_s": 1.0}),
                                     (ValueError, "turn_period=nan: must be a positive number", {"turn_period": float("nan")}),
                                     (ValueError, "turn_period=0: must be a positive number", {"turn_period": 0}),
                                     (ValueError, "episode_s=-1: must be a positive number", {"episode_s": -1}),
                                     (TypeError, "must be a list of \"path=value\"", {"settings": "time_limit_s=5"}),
                                     (ValueError, "seed=4: reset", {"settings": ["seed=4"]}),
                                     (ValueError, "stack.command=x: the environment is the stack", {"settings": ["stack.command=x"]}),
                                     (ValueError, "time_limit_s=5: episode_s", {"settings": ["time_limit_s=5"], "episode_s": 2})):
            with self.subTest(options), self.assertRaises(error) as caught:
                PatrolEnv("street/short", patrol="no-such-program", **options)
            self.assertIn(text, str(caught.exception))

    def test_an_unknown_scenario_is_an_error_with_its_line(self):
        with self.assertRaisesRegex(LinkError, "no_such"):
            PatrolEnv("street/no_such", patrol=PATROL)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v"])
