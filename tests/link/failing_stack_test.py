#!/usr/bin/env python3
"""A stack that ends, hangs or violates the protocol gives its run a verdict and a complete directory.

usage: failing_stack_test.py PATROL SOURCE
"""
import json
import pathlib
import random
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree

import stack_runs
from stack_runs import messages, run, write_stack

AT = """
import os
import signal
import time
import patrol_client

def on_turn(turn):
    if turn.now_ns >= {at_ns}:
        {action}
    turn.publish_velocity(0.3)

patrol_client.run(on_turn, topics=["/scan"], turn_period=0.02)
"""

# Speaks bytes that are no records.
GARBAGE = """
import os
import socket

connection = socket.socket(socket.AF_UNIX)
connection.connect(os.environ["PATROL_STACK_SOCKET"])
connection.recv(100)
connection.sendall({data!r})
connection.recv(10 ** 6)
while connection.recv(10 ** 6):
    pass
"""

DIES = "os.kill(os.getpid(), signal.SIGKILL)"


class FailingStack(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.path = pathlib.Path(self.folder.name)

    def assert_verdict(self, out, done, code, reason):
        """The run has ended with the exit code and the reason, and its directory is complete."""
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        self.assertIn(reason, done.stdout)
        self.assertFalse(list(out.glob("INCOMPLETE*")), "marked incomplete")
        json.loads((out / "metrics.json").read_text())
        error = xml.etree.ElementTree.parse(out / "junit.xml").getroot().find(".//error")
        self.assertIsNotNone(error)
        self.assertIn(reason, error.get("message"))
        self.assertTrue(messages(out))  # the log has its summary
        self.assertTrue((out / "stack.log").exists())

    def run_stack(self, text, **options):
        out = self.path / "run"
        return out, run(out, write_stack(self.path, "stack.py", text), **options)

    def run_until(self, at_s, action, **options):
        return self.run_stack(AT.format(at_ns=round(at_s * 1e9), action=action), **options)

    def test_a_stack_that_is_killed_at_twenty_moments(self):
        draw = random.Random(24)
        for _ in range(20):
            at_s = round(draw.uniform(0.0, 2.0), 3)
            out, done = self.run_until(at_s, DIES)
            turn_s = -(-round(at_s * 1000) // 20) * 20 / 1000
            self.assert_verdict(out, done, 3, f"the stack was killed by signal 9 (Killed) at {turn_s:.3f} s")

    def test_a_failed_run_is_scored_again_as_failed_and_fed_with_a_note(self):
        text = AT.format(at_ns=500_000_000, action=DIES)
        for limit_s, code, end in ((4.0, 3, "stack failed"), (0.4, 4, "time limit")):
            out, done = self.run_stack(text, time_limit_s=limit_s)
            self.assertEqual(done.returncode, code, done.stderr)
            scored = subprocess.run([stack_runs.PATROL, "score", str(out)], cwd=stack_runs.SOURCE, capture_output=True,
                                    text=True, timeout=120)
            self.assertEqual(scored.returncode, code, scored.stdout)
            verdict = done.stdout.splitlines()[0].split(": ", 1)[1]
            self.assertIn(end, verdict)
            self.assertEqual(scored.stdout.splitlines()[0].split(": ", 1)[1], verdict)
            fed = stack_runs.feed(out, self.path / "fed")
            self.assertIn(f"patrol: {out}: the run ended early ({end}: ", fed.stderr)

    def test_a_run_whose_stack_failed_cannot_be_verified(self):
        out, _ = self.run_until(1.0, DIES)
        done = stack_runs.verify(out)
        self.assertEqual(done.returncode, 2)
        self.assertRegex(done.stderr, r"log\.mcap: its stack failed after its turn at 0\.980 s: only a complete run can be verified")

    def test_verify_refuses_a_command_before_it_simulates(self):
        done = run(self.path / "run", write_stack(self.path, "stack.py", AT.format(at_ns=0, action="pass")), time_limit_s=0.5)
        self.assertEqual(done.returncode, 4, done.stderr)
        for stack, reason in (("no-such-program", "stack no-such-program: program not found"),
                              ("python3 'a", "quotation mark is not closed"),
                              ("tcp:localhost", "must be unix:PATH or tcp:HOST:PORT")):
            done = stack_runs.verify(self.path / "run", stack)
            self.assertEqual((done.returncode, done.stdout), (2, ""), done.stderr)
            self.assertIn(reason, done.stderr)
            self.assertNotIn("rerunning", done.stderr)

    def test_a_run_whose_stack_failed_in_its_first_turn_cannot_be_verified(self):
        out, _ = self.run_until(0.0, DIES)
        done = stack_runs.verify(out)
        self.assertEqual(done.returncode, 2)
        self.assertRegex(done.stderr, r"log\.mcap: its stack failed before the end of its first turn: only a complete run")

    def test_a_stack_that_hangs(self):
        out, done = self.run_until(1.0, "time.sleep(1000)", settings=["stack.timeout_s=5"])
        self.assert_verdict(out, done, 4, "the stack was silent at 1.000 s: no answer within 5 s")

    def test_a_stack_that_never_connects(self):
        out, done = self.run_stack("import time\ntime.sleep(1000)", settings=["stack.timeout_s=0.5"])
        self.assert_verdict(out, done, 4, "the stack was silent before the start: no stack connected within 0.5 s")

    def test_a_stack_that_ends_without_connecting(self):
        out, done = self.run_stack("print('no license')\nraise SystemExit(5)")
        self.assert_verdict(out, done, 3, "the stack exited with code 5 before the start; its output: stack.log")
        self.assertEqual((out / "stack.log").read_text(), "no license\n")

    def test_a_file_that_is_no_program(self):
        broken, out = self.path / "broken", self.path / "run"
        broken.write_text("#!/no/such/interpreter\n")
        broken.chmod(0o755)
        done = run(out, str(broken))
        self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
        self.assertEqual(done.stderr, f"patrol: stack {broken}: cannot be started: No such file or directory\n")
        self.assertFalse(out.exists())

    def test_a_stack_that_prints_a_lot_before_it_connects(self):
        out, done = self.run_stack("import sys\nsys.stdout.write('x' * 3_000_000 + '\\n')\nraise SystemExit(5)")
        self.assert_verdict(out, done, 3, "the stack exited with code 5 before the start; its output: stack.log")
        self.assertEqual(len((out / "stack.log").read_text()), 3_000_001)

    def test_a_stack_beside_a_simulator_that_cannot_be_built(self):
        out, done = self.run_stack(f"open({str(self.path / 'id')!r}, 'w').write(str(__import__('os').getpid()))\n"
                                   "__import__('time').sleep(1000)", settings=["start.left_m=1000"])
        self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
        self.assertRegex(done.stderr, r"\Apatrol: --set start\.left_m=1000: start pose \(.*\): no ground below in .*\n\Z")
        self.assertFalse(out.exists())
        if (self.path / "id").exists() and (self.path / "id").read_text():
            self.assertFalse(pathlib.Path("/proc", (self.path / "id").read_text()).exists(), "the process remains")

    def test_a_message_that_patrol_cannot_use_in_the_last_turn(self):
        out, done = self.run_until(1.5, "turn.is_last and turn.publish_velocity(float('nan'))", time_limit_s=1.5)
        self.assert_verdict(out, done, 3, "the stack failed at 1.500 s: message on /cmd_vel: contains a number")

    def test_an_exception_of_a_stack(self):
        out, done = self.run_until(1.0, "print(1 / 0)")
        self.assert_verdict(out, done, 3, "the stack failed at 1.000 s: ZeroDivisionError: division by zero")
        self.assertIn("Traceback", (out / "stack.log").read_text())

    def test_a_built_in_stack_on_a_full_disk(self):
        full = "import os, resource\nresource.setrlimit(resource.RLIMIT_FSIZE, (0, 0))\n"  # Python ignores SIGXFSZ
        out, done = self.run_stack(full + f"os.execv({stack_runs.PATROL!r}, ['patrol', 'stack'])")
        self.assert_verdict(out, done, 3, "documents.yaml: cannot be written: File too large")

    def test_bytes_that_are_no_records(self):
        for data, reason in ((b"HTTP/1.1 200 OK\r\n", "does not begin with the magic of MCAP"),
                             (b"\x89MCAP0\r\n\x05" + b"\xff" * 8, "record of 18446744073709551615 bytes"),
                             (b"\x89MCAP0\r\n\x05" + (30).to_bytes(8, "little") + bytes(30), "not declared")):
            out, done = self.run_stack(GARBAGE.format(data=data))
            self.assert_verdict(out, done, 3, reason)

    def test_messages_that_patrol_cannot_use(self):
        publish = "turn.publish('{0}', turn.client.type_of('{0}')())"
        declare = ("turn.client.declare('{0}', '{1}', 'float64 x\\n'); "
                   "turn.publish('{0}', turn.client.type_of('{0}')(x=1.0)); return")
        for action, reason in ((publish.format("/scan"), "message on /scan: only the simulator writes this topic"),
                               (publish.format("/tf_static"), "/tf_static: only the simulator writes this topic"),
                               (publish.format("/link/hello_reply"), "hello_reply: only the first message of a stack answers"),
                               (declare.format("", "a/msg/B"), "message on a topic without a name: name of a topic must begin with /"),
                               (declare.format("/ground_truth/odom", "a/msg/B"), "only the simulator writes this topic"),
                               (declare.format("/pose", "a/msg/B"), "/pose: type is a/msg/B: must be geometry_msgs"),
                               (declare.format("speed", "a/msg/B"), "name of a topic must begin with /"),
                               ("turn.publish_velocity(float('nan'))", "/cmd_vel: contains a number that is not finite"),
                               ("turn.next_turn_ns = turn.now_ns - 1", "next turn at"),
                               ("turn.now_ns += 1", "end of the turn at")):
            out, done = self.run_until(1.0, action)
            self.assert_verdict(out, done, 3, reason)

    def test_an_event_whose_subject_is_not_utf_8(self):
        event = ("e = turn.new('/events'); e.kind, e.subject = 'station_reached', 'ABCD'; data = e.encode(); "
                 r"type(e).encode = lambda self: data.replace(b'ABCD', b'caf\xe9'); turn.publish('/events', e)")
        out, done = self.run_until(1.0, event)
        self.assert_verdict(out, done, 3, "the stack failed at 1.000 s: message on /events: subject is not UTF-8")

    def test_an_end_of_the_process_after_the_run_is_a_warning(self):
        for end, text in (("raise SystemExit(3)", "exited with code 3"),
                          (DIES, "was killed by signal 9 (Killed)"),
                          ("time.sleep(1000)", "did not exit within 2 s")):
            _, done = self.run_stack(AT.format(at_ns=0, action="pass") + end, time_limit_s=0.3)
            self.assertEqual(done.returncode, 4, done.stderr)
            self.assertEqual(done.stderr, f"patrol: warning: the stack {text} after the run; its output: stack.log\n")

    def test_an_event_with_an_unknown_subject_is_a_warning(self):
        event = ("e = turn.new('/events'); e.kind, e.subject = 'station_reached', 'valve_well_zero'; "
                 "e.pose.orientation.w = 1.0; turn.publish('/events', e)")
        _, done = self.run_until(1.0, event, time_limit_s=1.5)
        self.assertEqual(done.returncode, 4, done.stderr)
        self.assertRegex(done.stderr, r"\Apatrol: warning: station_reached with subject valve_well_zero is not scored: "
                                      r"stations of the run: \w+, .*\n\Z")

    def test_a_pose_with_the_time_of_the_wall_clock(self):
        stamp = "p = turn.client.type_of('/pose')(); p.header.stamp.sec = int(time.time()); turn.publish('/pose', p)"
        out, done = self.run_until(1.0, stamp)
        self.assert_verdict(out, done, 3, "the stack failed at 1.000 s: message on /pose: stamp is 1")

    def test_a_pose_in_another_frame_is_a_warning(self):
        pose = "p = turn.new('/pose'); p.header.frame_id = 'banana'; p.pose.pose.orientation.w = 1.0; turn.publish('/pose', p)"
        _, done = self.run_until(1.0, pose, time_limit_s=1.5)
        self.assertEqual(done.returncode, 4, done.stderr)
        self.assertEqual(done.stderr.count("patrol: warning: frame of /pose is banana: it is taken as map"), 1, done.stderr)

    def test_a_pose_of_a_plan_in_another_frame_is_a_warning(self):
        plan = ("p = turn.new('/plan'); e = p.element('poses'); e.header.frame_id = 'site'; e.pose.orientation.w = 1.0; "
                "p.poses.append(e); turn.publish('/plan', p)")
        _, done = self.run_until(1.0, plan, time_limit_s=1.5)
        self.assertEqual(done.returncode, 4, done.stderr)
        self.assertEqual(done.stderr, "patrol: warning: frame of /plan is site: it is taken as map\n")

    def test_a_command_to_an_instrument_that_the_robot_lacks_is_a_warning(self):
        topics = ("/scanner/command", "/tem/antenna_command", "/tem/command", "/warning")
        publish = f"[turn.publish(one, turn.new(one)) for one in {topics}]"
        _, done = self.run_until(1.0, publish, time_limit_s=1.5)
        self.assertEqual(done.returncode, 4, done.stderr)
        self.assertEqual(done.stderr, "".join(
            f"patrol: warning: command on {topic} has no effect: the robot has no such instrument\n" for topic in topics[:3]))

    def test_a_topic_that_the_simulator_does_not_send_is_a_warning(self):
        text = AT.format(at_ns=0, action="pass").replace('["/scan"]', '["/scan", "/scann", "/cmd_vel", "/scann"]')
        _, done = self.run_stack(text, time_limit_s=0.5)
        self.assertEqual(done.returncode, 4, done.stderr)
        self.assertEqual(done.stderr, "patrol: warning: the stack wants messages on /cmd_vel: the simulator sends none\n"
                                      "patrol: warning: the stack wants messages on /scann: the simulator sends none\n")

    def test_a_topic_of_the_stacks_own_is_in_the_log(self):
        out, done = self.run_until(1.0, "turn.client.declare('/mine', 'my_msgs/msg/Mine', 'float64 x\\n'); "
                                        "turn.publish('/mine', turn.client.type_of('/mine')(x=1.5))", time_limit_s=1.5)
        self.assertEqual(done.returncode, 4, done.stderr)
        mine = [data for topic, _, data in messages(out) if topic == "/mine"]
        self.assertEqual(len(mine), 27)  # turns from 1.00 to 1.50 s, and the last one

    def test_a_stack_that_needs_more_memory_than_it_may(self):
        out, done = self.run_until(1.0, "bytearray(10 ** 9)", settings=["stack.memory_limit_mb=600"])
        self.assert_verdict(out, done, 3, "the stack failed at 1.000 s: MemoryError")

    def test_a_socket_that_exists_is_not_replaced(self):
        path, out = self.path / "socket", self.path / "refused"
        path.write_text("")
        done = run(out, f"unix:{path}")
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn(f"unix:{path}: Address already in use", done.stderr)
        self.assertFalse(out.exists())
        self.assertTrue(path.exists())

    def test_the_port_that_the_system_has_chosen_is_named(self):
        done = run(self.path / "run", "tcp:127.0.0.1:0", settings=["stack.timeout_s=0.1"])
        self.assertEqual(done.returncode, 4, done.stderr)
        self.assertRegex(done.stderr, r"\Apatrol: waiting for a stack at tcp:127\.0\.0\.1:[1-9][0-9]*\n\Z")

    def test_runs_at_the_same_time_do_not_wait_at_one_address(self):
        out = self.path / "sweep"
        command = [stack_runs.PATROL, "sweep", "street/short", "--set", f"stack.command=unix:{self.path}/socket", "--seeds", "2",
                   "--jobs", "2", "--out", str(out)]
        done = subprocess.run(command, cwd=stack_runs.SOURCE, capture_output=True, text=True, timeout=280)
        self.assertEqual((done.returncode, done.stdout), (2, ""), done.stderr)
        self.assertIn(f"--jobs 2: not possible with stack.command = unix:{self.path}/socket", done.stderr)
        self.assertFalse(out.exists())

    def test_an_invalid_command_is_invalid_input_and_writes_nothing(self):
        for stack, reason in (("no-such-program", "stack no-such-program: program not found"),
                              ("python3 'a", "quotation mark is not closed"),
                              ("tcp:0.0.0.0:5000", "allowed only with stack.allow_network = true"),
                              ("tcp:localhost", "must be unix:PATH or tcp:HOST:PORT")):
            out = self.path / "refused"
            done = run(out, stack)
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn(reason, done.stderr)
            self.assertFalse(out.exists())


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v"])
