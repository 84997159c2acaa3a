"""Connection to the simulator, its turns, and `run` for software that is called once for each turn."""

import json
import os
import socket
from dataclasses import dataclass, field

import mcap.exceptions
from mcap import data_stream, opcode, records

from patrol_client import cdr

PROTOCOL_VERSION = 1
SOCKET_VARIABLE = "PATROL_STACK_SOCKET"
_MAGIC = b"\x89MCAP0\r\n"

_TIME = "=" * 80 + "\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n"
_DURATION = "=" * 80 + "\nMSG: builtin_interfaces/Duration\nint32 sec\nuint32 nanosec\n"
_CONTROL = {  # messages of the protocol that a stack sends: type and definition by topic
    "/link/hello_reply": ("patrol_msgs/msg/LinkHelloReply", "uint32 protocol\nstring stack\nstring[] topics\n"
                          "builtin_interfaces/Duration turn_period\n" + _DURATION),
    "/link/done": ("patrol_msgs/msg/LinkDone", "builtin_interfaces/Time now\nbuiltin_interfaces/Time next_turn\n"
                   "bool mission_is_over\n" + _TIME),
    "/link/failure": ("patrol_msgs/msg/LinkFailure", "string text\n")}


class LinkError(RuntimeError):
    """Connection that ended before its time."""


def _nanoseconds(time):
    return time.sec * 10**9 + time.nanosec


@dataclass
class VelocityLimits:
    """Limits of the robot's base in its level frame, m/s and rad/s. Faster commands are limited."""

    forward: float
    backward: float
    sideways: float  #: 0: the base does not move sideways
    yaw_rate: float


@dataclass
class Hello:
    """The run, and the documents of the robot and the site."""

    program: str        #: name and version of the simulator
    scenario: str       #: name of the scenario
    seed: int
    tick: float         #: physics tick, s; turns are at multiples of it
    limits: "VelocityLimits"
    robot: str          #: URDF; empty: the robot of a recorded log is not described
    site: dict          #: survey of the site and stations of the mission; empty for a recorded log
    goals: list         #: saved goals in map; empty: none are given
    registration: dict  #: pose of a known map in site; empty: the origin of the map is the surveyed start
    documents: str      #: settings that a stack may know, YAML with the keys of a scenario, or of patrol slam --set for a
                        #: recorded log


class Message:
    """Message from the simulator."""

    __slots__ = ("topic", "log_time_ns", "data", "_type", "_content")

    def __init__(self, topic, log_time_ns, data, message_type):  # message_type: function that returns the class
        self.topic = topic
        self.log_time_ns = log_time_ns  #: time of delivery, ns
        self.data = data                #: encoded content
        self._type = message_type
        self._content = None

    @property
    def log_time(self):
        """Time of delivery, s."""
        return self.log_time_ns / 1e9

    @property
    def content(self):
        """The message with its fields, decoded when it is first used."""
        if self._content is None:
            self._content = self._type().decode(self.data)
        return self._content


@dataclass
class Turn:
    """Turn of the software, with the messages that were delivered since the last one."""

    client: "Client"
    now_ns: int
    is_last: bool  #: the run ends: publish final results
    messages: list = field(default_factory=list)
    next_turn_ns: int = 0            #: time of the next turn, ns; 0: by the turn period
    mission_is_over: bool = False    #: set it to end the run

    @property
    def now(self):
        """Simulated time, s."""
        return self.now_ns / 1e9

    def latest(self, topic):
        """Content of the newest message on a topic in this turn; None if there is none."""
        for message in reversed(self.messages):
            if message.topic == topic:
                return message.content
        return None

    def new(self, topic):
        """Returns a message of the type of a topic, stamped with the time of the turn if it has a header."""
        message = self.client.type_of(topic)()
        if hasattr(message, "header"):
            message.header.stamp.sec, message.header.stamp.nanosec = divmod(self.now_ns, 10**9)
        return message

    def publish(self, topic, message):
        """Publishes a message. A topic that Patrol does not know must have been declared (Client.declare)."""
        self.client.publish(topic, self.now_ns, message)

    def publish_velocity(self, vx, vy=0.0, yaw_rate=0.0):
        """Commands the velocity of the robot in its level frame: forward and left, m/s, and counterclockwise, rad/s. The
        robot stops half a second after the last command."""
        command = self.new("/cmd_vel")
        command.twist.linear.x, command.twist.linear.y, command.twist.angular.z = float(vx), float(vy), float(yaw_rate)
        self.publish("/cmd_vel", command)


class Client:
    """Connection to the simulator. Use: create; begin; then for each turn next_turn, publish, done.

    `address`: "unix:PATH" or "tcp:HOST:PORT" of the simulator; None: the simulator that has started this process.
    """

    def __init__(self, address=None):
        self._socket = _connect(address)
        self._file = self._socket.makefile("rb")
        self._stream = data_stream.ReadDataStream(self._file)
        self._unsent = data_stream.RecordBuilder()
        self._unsent.write(_MAGIC)
        records.Header(profile="ros2", library="patrol_client").write(self._unsent)
        self._schemas = {}       # sent, id by type and definition
        self._sent_channels = {}  # id by topic
        self._received_schemas, self._received_channels = {}, {}
        self._definitions = {topic: definition for topic, definition in _CONTROL.items()}
        self._types = {}         # class by type and definition
        self.documents = []  #: messages before the first turn: /tf_static and, for a known map, /site_map
        try:
            if self._read_bytes(len(_MAGIC)) != _MAGIC:
                raise LinkError("not a simulator of Patrol")
            self.hello = self._read_hello()
        except BaseException:
            self.close()
            raise

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        """Closes the connection. Before the last turn, the run fails."""
        self._file.close()
        self._socket.close()

    def type_of(self, topic):
        """Returns the class of the messages on a topic. Raises KeyError if the topic is not known."""
        if topic not in self._definitions:
            raise KeyError(f"{topic}: unknown topic: must be one of Patrol or declared (Client.declare)")
        return self._class_of(self._definitions[topic])

    def declare(self, topic, type_name, definition):
        """Declares a topic of the software's own, with a ROS 2 message definition (cdr.message_type). Raises ValueError if
        a message of another type or definition has been published on it."""
        if topic in self._sent_channels and self._definitions[topic] != (type_name, definition):
            raise ValueError(f"{topic}: has messages of another type")
        self._definitions[topic] = (type_name, definition)

    def _class_of(self, definition):
        """Class of a type by its name and definition."""
        if definition not in self._types:
            self._types[definition] = cdr.message_type(*definition)
        return self._types[definition]

    def begin(self, stack, topics=(), turn_period=0.0):
        """Answers the hello. `stack`: name; `topics`: to receive, all if empty; `turn_period`: time between turns, s, where
        a turn does not set the next one; 0: one tick. Raises TypeError if `topics` is one string."""
        if isinstance(topics, str):
            raise TypeError(f"topics: must be a list of names, not {topics!r}")
        period_ns = round(turn_period * 1e9)
        reply = self.type_of("/link/hello_reply")(protocol=PROTOCOL_VERSION, stack=stack, topics=list(topics))
        reply.turn_period.sec, reply.turn_period.nanosec = divmod(period_ns, 10**9)
        self.publish("/link/hello_reply", 0, reply)
        self._flush()

    def next_turn(self):
        """Waits for the turn after the last `done`. Raises LinkError if the simulator ends the connection."""
        messages = []
        while True:
            message = self._read_message()
            if message.topic == "/link/turn":
                content = message.content
                return Turn(self, _nanoseconds(content.now), content.is_last, messages)
            messages.append(message)

    def publish(self, topic, now_ns, message):
        """Publishes a message of the present turn, at `now_ns`. Raises cdr.CdrError if it has not the type of the topic or
        does not fit its type, and KeyError if the topic is not known."""
        expected, found = self.type_of(topic)._type_name, cdr.name_of_type(message)
        if found != expected:
            raise cdr.CdrError(f"{topic}: message is a {found}: must be a {expected}")
        if topic not in self._sent_channels:
            self._send_channel(topic)
        records.Message(channel_id=self._sent_channels[topic], sequence=0, log_time=now_ns, publish_time=now_ns,
                        data=message.encode()).write(self._unsent)

    def done(self, turn):
        """Ends a turn. Raises LinkError if the simulator has ended the connection."""
        done = self.type_of("/link/done")(mission_is_over=turn.mission_is_over)
        done.now.sec, done.now.nanosec = divmod(turn.now_ns, 10**9)
        done.next_turn.sec, done.next_turn.nanosec = divmod(turn.next_turn_ns, 10**9)
        self.publish("/link/done", turn.now_ns, done)
        self._flush()

    def fail(self, text):
        """Tells the simulator why the software fails; the connection ends."""
        try:
            self.publish("/link/failure", 0, self.type_of("/link/failure")(text=text))
            self._flush()
        except LinkError:
            pass  # the simulator is gone

    def _send_channel(self, topic):
        definition = self._definitions[topic]
        if definition not in self._schemas:
            self._schemas[definition] = len(self._schemas) + 1
            records.Schema(id=self._schemas[definition], name=definition[0], encoding="ros2msg",
                           data=definition[1].encode()).write(self._unsent)
        self._sent_channels[topic] = len(self._sent_channels) + 1
        records.Channel(id=self._sent_channels[topic], topic=topic, message_encoding="cdr", metadata={},
                        schema_id=self._schemas[definition]).write(self._unsent)

    def _flush(self):
        try:
            self._socket.sendall(self._unsent.end())
        except OSError as error:
            while True:  # until the reason that the simulator gave, or the end of the connection: LinkError
                try:
                    self._read_message()
                except LinkError as reason:
                    raise reason from error

    def _read_bytes(self, size):
        try:
            data = self._stream.read(size)
        except (mcap.exceptions.EndOfFile, OSError) as error:
            raise LinkError("the simulator closed the connection") from error
        if len(data) < size:
            raise LinkError("the simulator closed the connection")
        return data

    def _read_message(self):
        while True:
            head = self._read_bytes(9)
            size = int.from_bytes(head[1:], "little")
            content = data_stream.ReadDataStream(_Bytes(self._read_bytes(size) if size else b""))
            if head[0] == opcode.Opcode.SCHEMA:
                schema = records.Schema.read(content)
                self._received_schemas[schema.id] = schema
            elif head[0] == opcode.Opcode.CHANNEL:
                channel = records.Channel.read(content)
                schema = self._received_schemas[channel.schema_id]
                definition = (schema.name, schema.data.decode())
                self._received_channels[channel.id] = (channel.topic, definition)
                self._definitions.setdefault(channel.topic, definition)
            elif head[0] == opcode.Opcode.MESSAGE:
                record = records.Message.read(content, size)
                topic, definition = self._received_channels[record.channel_id]
                message = Message(topic, record.log_time, record.data, lambda: self._class_of(definition))
                if topic == "/link/failure":
                    raise LinkError(message.content.text)
                return message

    def _read_hello(self):
        while True:
            message = self._read_message()
            if message.topic != "/link/hello":
                self.documents.append(message)
                continue
            hello = message.content
            if hello.protocol != PROTOCOL_VERSION:
                raise LinkError(f"version {hello.protocol} of the protocol: must be {PROTOCOL_VERSION}")
            return Hello(program=hello.program, scenario=hello.scenario, seed=hello.seed,
                         tick=_nanoseconds(hello.tick) / 1e9,
                         limits=VelocityLimits(hello.forward_mps, hello.backward_mps, hello.sideways_mps, hello.yaw_rate_radps),
                         robot=hello.robot, site=json.loads(hello.site or "{}"),
                         goals=json.loads(hello.goals or "[]"), registration=json.loads(hello.registration or "{}"),
                         documents=hello.documents)


class _Bytes:
    """Bytes as a stream, without the copies of io.BytesIO."""

    def __init__(self, data):
        self._data, self._offset = data, 0

    def read(self, size):
        start, self._offset = self._offset, self._offset + size
        return self._data[start:self._offset]


def _connect(address):
    if address is None:
        path = os.environ.get(SOCKET_VARIABLE)
        if not path:
            raise LinkError(f"{SOCKET_VARIABLE} is not set: start this program with patrol run --stack, or give an address")
        address = "unix:" + path
    kind, _, rest = address.partition(":")
    host, _, port = rest.rpartition(":")
    if kind == "tcp" and host and port.isdecimal():
        connection = socket.create_connection((host, int(port)))
        connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        return connection
    if kind != "unix":
        raise LinkError(f"{address}: must be unix:PATH or tcp:HOST:PORT")
    connection = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
    try:
        connection.connect(rest)
    except BaseException:
        connection.close()
        raise
    return connection


def run(on_turn, topics=(), turn_period=0.05, stack="patrol_client", address=None, on_start=None):
    """Calls `on_turn(turn)` for each turn until the run ends, the last time with `turn.is_last`.

    `topics`: to receive, all if empty. `turn_period`: s. `on_start(client)`: called once, with the documents in
    `client.hello`. An exception ends the run with its text as the reason.
    """
    with Client(address) as client:
        try:
            if on_start is not None:
                on_start(client)
            client.begin(stack, topics, turn_period)
            while True:
                turn = client.next_turn()
                on_turn(turn)
                client.done(turn)
                if turn.is_last:
                    return
        except LinkError:
            raise
        except Exception as error:
            client.fail(f"{type(error).__name__}: {error}")
            raise
