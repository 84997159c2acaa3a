"""The turn protocol by the standard library alone, as a model for clients in other languages. Drives straight ahead with a
turn every 0.1 s, and lists the records of both directions in the order of the exchange.

patrol run street/short --set time_limit_s=0.2 --stack "python3 src/link/python/examples/raw_session.py"
"""
import os
import socket
import struct

MAGIC = b"\x89MCAP0\r\n"
HEADER, SCHEMA, CHANNEL, MESSAGE = 1, 3, 4, 5
NS = 10**9
TIME = "=" * 80 + "\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n"
CHANNELS = {  # of this stack: type and definition
    "/link/hello_reply": ("patrol_msgs/msg/LinkHelloReply",
                          "uint32 protocol\nstring stack\nstring[] topics\nbuiltin_interfaces/Duration turn_period\n" + TIME.replace("Time", "Duration")),
    "/link/done": ("patrol_msgs/msg/LinkDone", "builtin_interfaces/Time now\nbuiltin_interfaces/Time next_turn\nbool mission_is_over\n" + TIME),
    "/cmd_vel": ("geometry_msgs/msg/TwistStamped", "")}  # the definition of a type that Patrol knows may be empty


def text(value):
    """String of a record: length and bytes."""
    return struct.pack("<I", len(value)) + value.encode()


def record(opcode, content):
    return struct.pack("<BQ", opcode, len(content)) + content


class Cdr:
    """Writer of CDR, little-endian: numbers are aligned to their size, counted from the end of the four-byte header."""

    def __init__(self):
        self.data = b""

    def number(self, kind, value):
        size = struct.calcsize(kind)
        self.data += bytes(-len(self.data) % size) + struct.pack("<" + kind, value)
        return self

    def string(self, value):
        self.number("I", len(value) + 1)
        self.data += value.encode() + b"\0"
        return self

    def time(self, nanoseconds):
        return self.number("i", nanoseconds // NS).number("I", nanoseconds % NS)

    def bytes(self):
        return b"\x00\x01\x00\x00" + self.data


class Session:
    def __init__(self):
        self.socket = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        self.socket.connect(os.environ["PATROL_STACK_SOCKET"])
        self.stream = self.socket.makefile("rb")
        self.topics = {}   # of the simulator, by channel
        self.channels = {}  # of this stack, by topic

    def list(self, side, what):
        print(f"{side:<9}  {what}", flush=True)

    def read(self):
        """Returns topic and content of the next message of the simulator."""
        while True:
            opcode, size = struct.unpack("<BQ", self.stream.read(9))
            content = self.stream.read(size)
            if opcode == CHANNEL:
                number, _, length = struct.unpack_from("<HHI", content)
                self.topics[number] = content[8:8 + length].decode()
            elif opcode == MESSAGE:
                number, _, log_time, _ = struct.unpack_from("<HIQQ", content)
                return self.topics[number], log_time, content[22:]

    def begin(self):
        assert self.stream.read(8) == MAGIC
        self.list("simulator", "magic, header, schemas and channels of all topics")
        topic = ""
        while topic != "/link/hello":
            topic, time, _ = self.read()
            self.list("simulator", f"message {topic} at {time / NS:.3f} s")
        self.socket.sendall(MAGIC + record(HEADER, text("ros2") + text("raw_session")))
        self.list("stack", "magic, header")
        # Protocol 1, name, one topic to receive, turn period 0.1 s.
        self.send("/link/hello_reply", 0, Cdr().number("I", 1).string("raw_session").number("I", 1).string("/imu/data").time(NS // 10))

    def send(self, topic, time, content):
        if topic not in self.channels:
            self.channels[topic] = number = len(self.channels) + 1
            type_name, definition = CHANNELS[topic]
            schema = struct.pack("<H", number) + text(type_name) + text("ros2msg") + text(definition)
            channel = struct.pack("<HH", number, number) + text(topic) + text("cdr") + struct.pack("<I", 0)
            self.socket.sendall(record(SCHEMA, schema) + record(CHANNEL, channel))
            self.list("stack", f"schema {type_name}, channel {topic}")
        self.socket.sendall(record(MESSAGE, struct.pack("<HIQQ", self.channels[topic], 0, time, time) + content.bytes()))
        self.list("stack", f"message {topic} at {time / NS:.3f} s")

    def turns(self):
        is_last = False
        while not is_last:
            topic, count = "", 0
            while topic != "/link/turn":
                topic, time, content = self.read()
                count += topic == "/imu/data"
            seconds, nanoseconds, is_last = struct.unpack("<iI?", content[4:13])
            now = seconds * NS + nanoseconds
            self.list("simulator", f"{count} messages /imu/data, message /link/turn at {now / NS:.3f} s" + (", the last one" if is_last else ""))
            command = Cdr().time(now).string("base_footprint")
            for speed in (0.3, 0.0, 0.0, 0.0, 0.0, 0.0):  # linear x, y, z; angular x, y, z
                command.number("d", speed)
            self.send("/cmd_vel", now, command)
            self.send("/link/done", now, Cdr().time(now).time(0).number("?", False))


session = Session()
session.begin()
session.turns()
