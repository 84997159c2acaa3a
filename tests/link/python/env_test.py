#!/usr/bin/env python3
"""The Gymnasium environment keeps the rules of Gymnasium, and an episode is determined by its seed and its actions.

usage: env_test.py PATROL SOURCE
"""
import os
import sys
import unittest
import warnings

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

    def test_an_unknown_scenario_is_an_error_with_its_line(self):
        with self.assertRaisesRegex(LinkError, "no_such"):
            PatrolEnv("street/no_such", patrol=PATROL)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v"])
