#!/usr/bin/env python3
"""A run has the same bytes wherever its stack runs, however slow its process is, and `patrol verify` tells which half of a
run differs.

usage: same_bytes_test.py PATROL SOURCE
"""
import concurrent.futures
import os
import pathlib
import shutil
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import threading
import time
import unittest

import stack_runs
from stack_runs import feed, messages, run, verify, without_turns, write_stack

BUILT_IN = f"{stack_runs.PATROL} stack"
WALL_FOLLOWER = f"{stack_runs.PYTHON} {stack_runs.SOURCE / 'src/link/python/examples/wall_follower.py'}"

# Drives straight ahead; at 1.30 s of simulated time it draws a speed that no seed determines.
UNSEEDED = """
import random
import patrol_client

def on_turn(turn):
    speed = 0.3
    if turn.now_ns == 1_300_000_000:
        speed += 1e-3 * random.SystemRandom().random()
    turn.publish_velocity(speed)

patrol_client.run(on_turn, topics=["/scan"], turn_period=0.05)
"""

# Writes its process id, so that the test can stop it, and drives a circle.
CIRCLE = """
import os
import pathlib
import sys
import patrol_client

pathlib.Path(sys.argv[1]).write_text(str(os.getpid()))
patrol_client.run(lambda turn: turn.publish_velocity(0.3, 0.0, 0.3), topics=["/scan"], turn_period=0.05)
"""


# Ends the mission by its first turn after 0.49 s.
ENDS = """
import patrol_client

def on_turn(turn):
    turn.publish_velocity(0.3)
    turn.mission_is_over = turn.now > 0.49

patrol_client.run(on_turn, topics=["/scan"], turn_period=0.05)
"""

# Computes 20 ms in each turn, in a child if it is asked to fork.
BUSY = """
import os
import sys
import time
import patrol_client

def on_turn(turn):
    start = time.process_time()
    while time.process_time() - start < 0.02:
        pass
    turn.publish_velocity(0.3)

if "forks" in sys.argv and os.fork() > 0:
    os._exit(0)
patrol_client.run(on_turn, topics=["/scan"], turn_period=0.05)
"""

# Connects, and leaves the turns to a child.
HEIR = """
import os
import patrol_client

def fork(client):
    if os.fork() > 0:
        os._exit(0)

patrol_client.run(lambda turn: turn.publish_velocity(0.3), topics=["/scan"], turn_period=0.05, on_start=fork)
"""

# Answers in another way than in its first run, of which a file is left: from 1 s on, as its second argument says.
CHANGES = """
import pathlib
import sys
import patrol_client

has_run = pathlib.Path(sys.argv[1]).exists()
pathlib.Path(sys.argv[1]).touch()

def on_turn(turn):
    turn.publish_velocity(0.3)
    if has_run and turn.now_ns >= 10**9:
        exec(sys.argv[2])

patrol_client.run(on_turn, topics=["/scan"], turn_period=0.05)
"""

STRAIGHT = """
import sys
import patrol_client

patrol_client.run(lambda turn: turn.publish_velocity(0.3), topics=["/scan"], turn_period=0.05,
                  address=sys.argv[1] if len(sys.argv) > 1 else None)
"""


class SameBytes(unittest.TestCase):
    """`inside` and `outside`: runs with the built-in stack, which several claims read."""

    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.inside, cls.outside = pathlib.Path(folder.name) / "inside", pathlib.Path(folder.name) / "outside"
        for path, stack in (cls.inside, []), (cls.outside, [BUILT_IN]):
            done = run(path, *stack)
            assert done.returncode in (1, 4), done.stderr  # 4: time limit

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.path = pathlib.Path(self.folder.name)

    def run_to(self, name, *arguments, **options):
        done = run(self.path / name, *arguments, **options)
        self.assertIn(done.returncode, (1, 4), done.stderr)  # 4: time limit
        return self.path / name

    def test_the_built_in_stack_in_a_process_of_its_own_writes_the_same_log(self):
        self.assertEqual(without_turns(messages(self.outside)), messages(self.inside))

    def test_a_stack_that_is_fed_with_its_run_writes_the_log_of_the_run(self):
        self.assertEqual(feed(self.inside, self.path / "fed").returncode, 1)
        self.assertEqual((self.path / "fed/log.mcap").read_bytes(), (self.inside / "log.mcap").read_bytes())
        feed(self.inside, self.path / "fed_outside", BUILT_IN)
        self.assertEqual(without_turns(messages(self.path / "fed_outside")), messages(self.inside))

    def test_a_stack_with_a_computing_time_that_is_fed_with_its_run_writes_the_log_of_the_run(self):
        delay = ["stack.compute.model=fixed", "stack.compute.delay_s=0.04"]
        for stack in (None, BUILT_IN):
            delayed = self.run_to("delayed", stack, settings=delay)
            feed(delayed, self.path / "fed", stack)
            self.assertEqual((self.path / "fed/log.mcap").read_bytes(), (delayed / "log.mcap").read_bytes())

    def test_a_mission_that_ends_with_a_computing_time_is_fed_to_the_log_of_the_run(self):
        ends = write_stack(self.path, "ends.py", ENDS)
        # The next turn is due when the answer that ends the mission takes effect.
        delayed = self.run_to("ended", ends, settings=["stack.compute.model=fixed", "stack.compute.delay_s=0.06"])
        feed(delayed, self.path / "fed", ends)
        self.assertEqual((self.path / "fed/log.mcap").read_bytes(), (delayed / "log.mcap").read_bytes())
        self.assertEqual(len(self.delays_of(delayed)), 11)  # turns every 60 ms from 0 to 0.54 s, and the last one

    def test_a_fed_stack_has_its_turns_when_it_asks_for_them(self):
        # The run has a turn every 50 ms, the fed stack every 10 ms: it publishes odometry every 20 ms.
        circle = self.run_to("circle", write_stack(self.path, "circle.py", CIRCLE) + f" {self.path / 'process_id'}")
        feed(circle, self.path / "fed")
        times = [log_time for topic, log_time, _ in messages(self.path / "fed")
                 if topic == "/odom" and log_time > 2 * 10**9]  # after the start
        self.assertGreater(len(times), 90)
        self.assertEqual({later - earlier for earlier, later in zip(times, times[1:])}, {20_000_000})

    def test_a_run_whose_log_begins_with_its_values_as_built_is_fed_to_the_same_log_and_the_copy_is_not_verified(self):
        straight = write_stack(self.path, "straight.py", STRAIGHT)  # publishes in its first turn
        as_built = self.run_to("as_built", straight, settings=["as_built.enabled=true"], time_limit_s=1.0)
        self.assertEqual(messages(as_built)[1][0], "/ground_truth/as_built")  # after /tf_static
        feed(as_built, self.path / "fed", straight)
        self.assertEqual((self.path / "fed/log.mcap").read_bytes(), (as_built / "log.mcap").read_bytes())
        done = verify(self.path / "fed")
        self.assertEqual((done.returncode, done.stdout), (2, ""), done.stderr)
        self.assertRegex(done.stderr, r"\Apatrol: .*/fed: was made by patrol feed, .*: verify the run that was fed\n\Z")

    def test_feed_refuses_to_overwrite_the_run(self):
        done = feed(self.inside, self.inside)
        self.assertEqual(done.returncode, 2)
        self.assertIn("must not be the directory of the run", done.stderr)
        self.assertTrue((self.inside / "log.mcap").exists())

    def test_both_halves_of_a_run_are_verified(self):
        done = verify(self.outside, BUILT_IN)
        self.assertEqual(done.stdout, "simulator: byte-identical\nstack: byte-identical\n", done.stderr)
        done = verify(self.outside)
        self.assertIn("simulator: byte-identical\nstack: not verified", done.stdout)

    def test_a_python_stack_that_is_stopped_for_a_while_writes_the_same_log(self):
        process_id = self.path / "process_id"
        stack = write_stack(self.path, "circle.py", CIRCLE) + f" {process_id}"
        undisturbed = self.run_to("undisturbed", stack)
        process_id.unlink()

        def stop_for_a_while():
            while not process_id.exists() or not process_id.read_text():
                time.sleep(0.001)
            os.kill(int(process_id.read_text()), signal.SIGSTOP)
            time.sleep(2.0)
            os.kill(int(process_id.read_text()), signal.SIGCONT)

        disturber = threading.Thread(target=stop_for_a_while)
        disturber.start()
        stopped = self.run_to("stopped", stack)
        disturber.join()
        self.assertEqual(messages(stopped), messages(undisturbed))

    def test_a_stack_that_connects_by_tcp_writes_the_same_log(self):
        started = self.run_to("started", write_stack(self.path, "straight.py", STRAIGHT))
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            address = f"tcp:127.0.0.1:{free.getsockname()[1]}"
        with concurrent.futures.ThreadPoolExecutor() as pool:
            waiting = pool.submit(self.run_to, "waiting", address)
            deadline = time.monotonic() + 60
            while True:
                stack = subprocess.run([sys.executable, self.path / "straight.py", address], capture_output=True, text=True)
                if "ConnectionRefusedError" not in stack.stderr or time.monotonic() > deadline:
                    break
            self.assertEqual(stack.returncode, 0, stack.stderr)
            self.assertEqual(messages(waiting.result()), messages(started))

    def test_a_python_stack_writes_the_same_log_on_a_loaded_computer(self):
        alone = self.run_to("alone", WALL_FOLLOWER)
        load = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(os.cpu_count() or 2)]
        try:
            loaded = self.run_to("loaded", WALL_FOLLOWER)
        finally:
            for process in load:
                process.kill()
                process.wait()
        self.assertEqual(messages(loaded), messages(alone))

    def test_the_first_unseeded_draw_of_a_stack_is_named(self):
        stack = write_stack(self.path, "unseeded.py", UNSEEDED)
        done = verify(self.run_to("unseeded", stack), stack)
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertRegex(done.stdout, r"simulator: byte-identical\n"
                                      r"stack: differs: /cmd_vel at 1\.300000000 s: twist\.linear\.x is 0\.3\d+, was 0\.3\d+")

    def test_the_first_turn_in_which_a_stack_asks_for_another_turn_or_end_is_named(self):
        for change, difference in (("turn.next_turn_ns = turn.now_ns + 20_000_000", "next_turn.nanosec is 20000000, was 50000000"),
                                   ("turn.mission_is_over = True", "mission_is_over is true, was false")):
            stack = write_stack(self.path, "changes.py", CHANGES) + f" {self.path / 'has_run'} '{change}'"
            (self.path / "has_run").unlink(missing_ok=True)
            done = verify(self.run_to("changes", stack, time_limit_s=1.5), stack)
            self.assertEqual(done.returncode, 1, done.stderr)
            self.assertEqual(done.stdout, "simulator: byte-identical\n"
                                          f"stack: differs: /stack/turns at 1.000000000 s: {difference}\n")

    def test_the_end_of_the_output_of_a_stack_that_fails_is_printed(self):
        stack = write_stack(self.path, "changes.py", CHANGES) + f" {self.path / 'has_run'} 'print(1 / 0)'"
        done = verify(self.run_to("changes", stack, time_limit_s=1.5), stack)
        self.assertEqual((done.returncode, done.stdout), (3, "simulator: byte-identical\n"), done.stderr)
        self.assertRegex(done.stderr, r"verify: end of the output of the stack:\nTraceback .*(.*\n)+ZeroDivisionError: division by zero\n"
                                      r"patrol: the stack failed at 1\.000 s: ZeroDivisionError: division by zero; its output: above\n\Z")

    def test_a_run_whose_log_is_truncated_is_not_fed(self):
        run_directory, out = self.path / "truncated", self.path / "fed"
        shutil.copytree(self.inside, run_directory)
        log = (run_directory / "log.mcap").read_bytes()
        (run_directory / "log.mcap").write_bytes(log[:len(log) * 6 // 10])
        done = feed(run_directory, out)
        self.assertEqual((done.returncode, done.stdout), (2, ""), done.stderr)
        self.assertEqual(done.stderr, f"patrol: {run_directory}/log.mcap: is incomplete; cannot be fed\n")
        self.assertFalse(out.exists())

    def test_measured_computing_time_is_in_the_log_and_repeated_from_it(self):
        # A tenth of this computer's speed: the delays are longer than a tick, and differ from run to run.
        slow = self.run_to("slow", BUILT_IN, settings=["stack.compute.model=measured", "stack.compute.factor=10"])
        turns = [data for topic, _, data in messages(slow) if topic == "/stack/turns"]
        self.assertLess(len(turns), 1900)  # of the 2001 ticks: the stack is busy in the others
        self.assertGreater(len(turns), 10)
        done = verify(slow, BUILT_IN)
        self.assertEqual(done.stdout, "simulator: byte-identical\nstack: byte-identical\n", done.stderr)

    def delays_of(self, run_directory):
        """Delays of the turns, ns."""
        turns = [struct.unpack_from("<iIiI", data, 4) for topic, _, data in messages(run_directory) if topic == "/stack/turns"]
        return [seconds * 10**9 + nanoseconds for _, _, seconds, nanoseconds in turns]

    def test_the_computing_time_is_that_of_the_process_that_connects(self):
        busy = write_stack(self.path, "busy.py", BUSY)
        script = self.path / "wrapper.sh"
        script.write_text(f"{busy} $*\nexit $?\n")  # without exec
        for name, command in (("direct", busy), ("wrapped", f"sh {script}"), ("forked", busy + " forks")):
            out = self.run_to(name, command, settings=["stack.compute.model=measured", "stack.compute.factor=1"],
                              time_limit_s=1.0)
            delays = self.delays_of(out)
            self.assertGreater(min(delays[:-1]), 10_000_000, name)  # 20 ms of CPU time; the last turn has no delay

    def test_a_process_that_connects_and_leaves_the_turns_to_its_child_cannot_be_measured(self):
        command = write_stack(self.path, "heir.py", HEIR)
        done = run(self.path / "heir", command, settings=["stack.compute.model=measured"], time_limit_s=1.0)
        self.assertEqual(done.returncode, 3, done.stderr)
        self.assertRegex(done.stdout, r"the stack exited with code 0 at \d\.\d\d0 s")
        done = run(self.path / "free", command, time_limit_s=1.0)
        self.assertEqual(done.returncode, 4, done.stderr)

    def test_a_fixed_computing_time_delays_every_message(self):
        for stack in (None, BUILT_IN):
            delayed = self.run_to("delayed", stack,
                                  settings=["stack.compute.model=fixed", "stack.compute.delay_s=0.0301"])
            # Delay of 30.1 ms: until the tick at 32 ms.
            odometry = [log_time for topic, log_time, _ in messages(delayed) if topic == "/odom"]
            self.assertEqual({time % 32_000_000 for time in odometry}, {0})

    def test_a_stack_that_computes_beside_the_simulator_writes_the_same_log(self):
        delay = ["stack.compute.model=fixed", "stack.compute.delay_s=0.02"]
        for settings in ([], delay):
            one, two = (self.run_to(f"threads_{threads}", settings=settings, threads=threads) for threads in (1, 2))
            self.assertEqual((one / "log.mcap").read_bytes(), (two / "log.mcap").read_bytes())
        # The last two runs have the delay, with which a log has the turns of the built-in stack too.
        self.assertEqual(messages(self.run_to("outside", BUILT_IN, settings=delay)), messages(one))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v"])
