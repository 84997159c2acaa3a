#!/usr/bin/env python3
"""A run ends by what happens first: the fall of the robot, the end of the mission or the time limit. Its parts are measured apart.

usage: run_loop_test.py PATROL SOURCE
"""
import json
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest

PATROL = pathlib.Path(sys.argv[1]).resolve()

# Gravity points along the ground: the robot slides to the wall and lies there.
WORLD = """
<mujoco model="tilted">
  <option timestep="0.002" gravity="0 9.6 -2"/>
  <worldbody>
    <geom name="ground" type="plane" size="0 0 1"/>
    <geom name="wall" type="box" pos="0 1.1 1" size="20 0.1 1"/>
  </worldbody>
</mujoco>
"""

# Publishes no event. Ends the mission in the turn at `end_s`.
STACK = """
import patrol_client

def on_turn(turn):
    turn.publish_velocity(0.0)
    turn.mission_is_over = turn.now_ns == round({end_s} * 1e9)

patrol_client.run(on_turn, topics=["/scan"], turn_period={period_s})
"""

# Publishes a map whose scoring takes seconds.
LARGE_MAP = """
import numpy
import patrol_client

def on_turn(turn):
    turn.publish("/pose", turn.new("/pose"))
    if turn.is_last:
        map = turn.new("/map")
        map.info.resolution, map.info.width, map.info.height = 0.01, 4000, 4000
        map.data = numpy.full(4000 * 4000, 100, numpy.int8)
        turn.publish("/map", map)

patrol_client.run(on_turn, topics=["/scan"])
"""


class EndOfARun(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.path = pathlib.Path(self.folder.name)

    def run_in(self, world, period_s, end_s, time_limit_s, settings=()):
        """Runs a standing robot; returns the first line of the result, the exit code and the metrics."""
        (self.path / "worlds" / "site").mkdir(parents=True)
        (self.path / "worlds/site/site.xml").write_text(world)
        (self.path / "stack.py").write_text(STACK.format(period_s=period_s, end_s=end_s))
        done = subprocess.run([PATROL, "run", "site", "--robot", "wheeled", "--start", "0,0", "--goal", "5,0",
                               "--set", f"time_limit_s={time_limit_s}", "--stack", f"{sys.executable} {self.path / 'stack.py'}",
                               "--out", "run", *(word for setting in settings for word in ("--set", setting))],
                              cwd=self.path, capture_output=True, text=True, timeout=100)
        self.assertTrue(done.stdout, done.stderr)
        return done.stdout.splitlines()[0], done.returncode, json.loads((self.path / "run/metrics.json").read_text())

    def test_a_fall_without_an_event_of_the_stack_is_in_the_score(self):
        line, code, metrics = self.run_in(WORLD, period_s=0.05, end_s=-1, time_limit_s=4)
        self.assertIn("fall (the robot fell at", line)
        self.assertEqual(code, 1)
        self.assertTrue(metrics["mission"]["fell"])

    def test_a_fall_with_a_computing_time_is_fed_to_the_log_of_the_run(self):
        line, _, _ = self.run_in(WORLD, period_s=0.05, end_s=-1, time_limit_s=4,
                                 settings=["stack.compute.model=fixed", "stack.compute.delay_s=0.06"])
        self.assertIn("fall (the robot fell at", line)
        subprocess.run([PATROL, "feed", "run", "--stack", f"{sys.executable} {self.path / 'stack.py'}", "--out", "fed"],
                       cwd=self.path, capture_output=True, timeout=100)
        self.assertEqual((self.path / "fed/log.mcap").read_bytes(), (self.path / "run/log.mcap").read_bytes())

    def test_a_fall_before_the_time_limit_is_a_fall_though_the_stack_has_no_turn_after_it(self):
        line, code, _ = self.run_in(WORLD, period_s=20, end_s=-1, time_limit_s=4)
        self.assertIn("fall (the robot fell at", line)
        self.assertEqual(code, 1)

    def test_a_mission_that_ends_at_the_time_limit_has_ended(self):
        line, code, metrics = self.run_in(WORLD.replace("0 9.6 -2", "0 0 -9.81"), period_s=0.05, end_s=0.5, time_limit_s=0.5)
        self.assertNotIn("time limit", line)
        self.assertEqual(code, 0)
        self.assertFalse(metrics["mission"]["fell"])

    def test_one_signal_ends_the_scoring(self):
        (self.path / "worlds/site").mkdir(parents=True)
        (self.path / "worlds/site/site.xml").write_text(WORLD.replace("0 9.6 -2", "0 0 -9.81"))
        (self.path / "stack.py").write_text(LARGE_MAP)
        for ending in (signal.SIGINT, signal.SIGTERM):
            run = subprocess.Popen([PATROL, "run", "site", "--robot", "wheeled", "--start", "0,0", "--goal", "5,0",
                                    "--set", "time_limit_s=0.1", "--stack", f"{sys.executable} {self.path / 'stack.py'}",
                                    "--out", "run"], cwd=self.path, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
            self.addCleanup(run.kill)
            log, deadline = self.path / "run/log.mcap", time.monotonic() + 100
            while not (log.exists() and log.read_bytes().endswith(b"\x89MCAP0\r\n") and log.stat().st_size > 100):
                self.assertIsNone(run.poll())
                self.assertLess(time.monotonic(), deadline)
                time.sleep(0.05)
            time.sleep(0.5)
            run.send_signal(ending)
            output, errors = run.communicate(timeout=20)
            self.assertIn(run.returncode, (-ending, 3), (output, errors))  # 3: the stack was still ending
            self.assertEqual(output, b"")
            self.assertTrue((self.path / "run/INCOMPLETE").exists())

    def test_the_parts_of_a_run_in_one_thread_add_up_to_its_time_at_most(self):
        (self.path / "worlds/site").mkdir(parents=True)
        (self.path / "worlds/site/site.xml").write_text(WORLD.replace("0 9.6 -2", "0 0 -9.81"))
        subprocess.run([PATROL, "run", "site", "--robot", "wheeled", "--start", "0,0", "--goal", "5,0", "--set", "time_limit_s=12",
                        "--threads", "1", "--out", "run"], cwd=self.path, capture_output=True, timeout=100)
        performance = json.loads((self.path / "run/metrics.json").read_text())["performance"]
        self.assertGreater(performance["parts_s"]["slam"], 0.0)
        self.assertLessEqual(sum(performance["parts_s"].values()), performance["wall_s"])


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v"])
