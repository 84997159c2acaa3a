#!/usr/bin/env python3
"""The connection of patrol_client with a simulator of this test: its errors, declarations and times.

usage: client_test.py
"""
import gc
import socket
import tempfile
import threading
import unittest
import warnings

from mcap import data_stream, records

from patrol_client import cdr
from patrol_client.client import Client, LinkError, run

MAGIC = b"\x89MCAP0\r\n"
TIME = "=" * 80 + "\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n"
TYPES = {"/link/hello": ("patrol_msgs/msg/LinkHello",
                         "uint32 protocol\nstring program\nstring scenario\nuint64 seed\nbuiltin_interfaces/Time tick\n"
                         "float64 forward_mps\nfloat64 backward_mps\nfloat64 sideways_mps\nfloat64 yaw_rate_radps\n"
                         "string robot\nstring site\nstring goals\nstring registration\nstring documents\n" + TIME),
         "/link/turn": ("patrol_msgs/msg/LinkTurn", "builtin_interfaces/Time now\nbool is_last\n" + TIME),
         "/link/failure": ("patrol_msgs/msg/LinkFailure", "string text\n"),
         "/a": ("my_msgs/msg/Value", "float64 x\n"),
         "/a again": ("my_msgs/msg/Value", "uint8 number\n")}  # on /a, too


class Simulator:
    """One connection of a simulator, with the steps of a test: functions that send, or read."""

    def __init__(self, folder, steps):
        self.address = f"unix:{folder}/socket"
        self.server = socket.socket(socket.AF_UNIX)
        self.server.bind(f"{folder}/socket")
        self.server.listen()
        self.received = b""
        self.thread = threading.Thread(target=self._run, args=(steps,))
        self.thread.start()

    def _run(self, steps):
        self.connection, _ = self.server.accept()
        with self.connection, self.server:
            for step in steps:
                step(self)

    def send(self, topic, **values):
        builder = data_stream.RecordBuilder()
        message = cdr.message_type(*TYPES[topic])(**values)
        records.Message(channel_id=list(TYPES).index(topic) + 1, sequence=0, log_time=0, publish_time=0,
                        data=message.encode()).write(builder)
        self.connection.sendall(builder.end())

    def greet(self):
        builder = data_stream.RecordBuilder()
        builder.write(MAGIC)
        for number, (topic, (name, definition)) in enumerate(TYPES.items(), 1):
            records.Schema(id=number, name=name, encoding="ros2msg", data=definition.encode()).write(builder)
            records.Channel(id=number, topic=topic.split()[0], message_encoding="cdr", metadata={}, schema_id=number).write(builder)
        self.connection.sendall(builder.end())
        self.send("/link/hello", protocol=1)

    def turn(self, nanoseconds=0, is_last=False):
        turn = cdr.message_type(*TYPES["/link/turn"])()
        turn.now.sec, turn.now.nanosec = divmod(nanoseconds, 10**9)
        self.send("/link/turn", now=turn.now, is_last=is_last)

    def read(self):
        self.received += self.connection.recv(10**6)


class Connection(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def simulator(self, *steps):
        simulator = Simulator(self.folder.name, steps)
        self.addCleanup(simulator.thread.join, 20)
        return simulator

    def test_the_reason_of_the_simulator_is_raised_when_it_no_longer_reads(self):
        closed = threading.Event()

        def fail(simulator):
            simulator.send("/link/failure", text="that was too much")
            simulator.connection.close()
            closed.set()

        simulator = self.simulator(Simulator.greet, Simulator.read, Simulator.turn, fail)
        with Client(simulator.address) as client:
            client.begin("test")
            turn = client.next_turn()
            closed.wait(20)
            with self.assertRaisesRegex(LinkError, "that was too much"):
                client.done(turn)
            client.fail("too late")  # changes nothing

    def test_the_end_of_the_connection_is_a_link_error(self):
        closed = threading.Event()

        def close(simulator):
            simulator.connection.close()
            closed.set()

        simulator = self.simulator(Simulator.greet, Simulator.read, Simulator.turn, close)
        with Client(simulator.address) as client:
            client.begin("test")
            turn = client.next_turn()
            closed.wait(20)
            for _ in range(2):
                with self.assertRaisesRegex(LinkError, "closed the connection"):
                    client.done(turn)

    def test_a_connection_that_fails_leaves_no_socket_open(self):
        simulator = self.simulator(lambda simulator: simulator.connection.sendall(b"HTTP/1.1"))
        with warnings.catch_warnings(record=True) as found:
            warnings.simplefilter("always")
            with self.assertRaisesRegex(LinkError, "not a simulator of Patrol"):
                Client(simulator.address)
            with self.assertRaises(FileNotFoundError):
                Client(f"unix:{self.folder.name}/no_socket")
            gc.collect()
        self.assertEqual([str(one.message) for one in found], [])

    def test_invalid_addresses_are_errors(self):
        for address in ("tcp:localhost", "tcp:5000", "localhost:5000", "/tmp/socket"):
            with self.assertRaisesRegex(LinkError, "must be unix:PATH or tcp:HOST:PORT"):
                Client(address)

    def test_topics_are_a_list(self):
        simulator = self.simulator(Simulator.greet, Simulator.read)
        with self.assertRaisesRegex(TypeError, "topics: must be a list of names, not '/scan'"):
            run(lambda turn: None, topics="/scan", address=simulator.address)
        simulator.thread.join(20)
        self.assertIn(b"topics: must be a list", simulator.received)  # the run has the reason

    def test_two_topics_of_one_type_have_their_own_definitions(self):
        simulator = self.simulator(Simulator.greet, Simulator.read, Simulator.turn, Simulator.read)
        with Client(simulator.address) as client:
            client.begin("test")
            turn = client.next_turn()
            for topic, definition in (("/b", "float64 first\n"), ("/c", "float64 second\n"), ("/d", "float64 first\n")):
                client.declare(topic, "my_msgs/msg/Mine", definition)
                turn.publish(topic, client.type_of(topic)())
                client.declare(topic, "my_msgs/msg/Mine", definition)  # the same again
                with self.assertRaisesRegex(ValueError, f"{topic}: has messages of another type"):
                    client.declare(topic, "my_msgs/msg/Mine", "float64 third\n")
            client.done(turn)
        simulator.thread.join(20)
        self.assertEqual([simulator.received.count(text) for text in (b"float64 first\n", b"float64 second\n")], [1, 1])

    def test_a_message_of_another_type_than_that_of_its_topic_is_an_error(self):
        simulator = self.simulator(Simulator.greet, Simulator.read, Simulator.turn, Simulator.read)
        with Client(simulator.address) as client:
            client.begin("test")
            turn = client.next_turn()
            client.declare("/b", "my_msgs/msg/Other", "float64 x\n")  # the same bytes as on /a
            for message, name in ((turn.new("/a"), "my_msgs/Value"), (None, "NoneType"), ("text", "str")):
                with self.assertRaisesRegex(cdr.CdrError, f"^/b: message is a {name}: must be a my_msgs/Other$"):
                    turn.publish("/b", message)
            for call in (lambda: turn.new("/nope"), lambda: turn.publish("/nope", turn.new("/a"))):
                with self.assertRaisesRegex(KeyError, "/nope: unknown topic: must be one of Patrol or declared"):
                    call()
            client.done(turn)

    def test_messages_have_the_definition_of_their_channel(self):
        def send(simulator):
            simulator.send("/a", x=1.5)
            simulator.send("/a again", number=7)

        simulator = self.simulator(Simulator.greet, Simulator.read, send, Simulator.turn)
        with Client(simulator.address) as client:
            client.begin("test")
            first, second = client.next_turn().messages
        self.assertEqual((first.topic, second.topic), ("/a", "/a"))
        self.assertEqual((first.content.x, second.content.number), (1.5, 7))

    def test_times_are_those_of_their_decimals(self):
        times_ns = [300_000_000, 600_000_000, 700_000_000, 1_900_000_000]
        simulator = self.simulator(Simulator.greet, Simulator.read,
                                   *(lambda simulator, now=now: simulator.turn(now) for now in times_ns))
        with Client(simulator.address) as client:
            client.begin("test")
            self.assertEqual([client.next_turn().now for _ in times_ns], [0.3, 0.6, 0.7, 1.9])


if __name__ == "__main__":
    unittest.main(verbosity=2)
