#!/usr/bin/env python3
"""The messages of patrol_client are those of mcap_ros2, another implementation of CDR, in both directions."""
import random
import struct
import unittest

import numpy as np
from mcap_ros2 import _dynamic

from patrol_client import cdr

LINE = "=" * 80
DEFINITION = f"""# a message with every kind of field
uint8 NONE=0
string NAME=beam
std_msgs/Header header
string[] fields
bool flag
int8 small
uint16 number
float64[3] fixed
float32[] ranges
string[] names
geometry_msgs/Point[] points
geometry_msgs/Point[2] ends
uint64 large
string<=20 bounded
float64 w 1.5
{LINE}
MSG: geometry_msgs/Point
float64 x
float64 y
{LINE}
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
{LINE}
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
"""
TYPE = cdr.message_type("test_msgs/msg/All", DEFINITION)
POINT = cdr.message_type("geometry_msgs/msg/Point", "float64 x\nfloat64 y\n")


def random_message(draw):
    text = lambda: "".join(draw.choice("aé_0 ") for _ in range(draw.randrange(6)))
    point = lambda: TYPE._fields[9].type(x=draw.gauss(0, 1), y=draw.gauss(0, 1))
    message = TYPE(fields=[text()], flag=draw.random() < 0.5, small=draw.randrange(-128, 128), number=draw.randrange(2**16),
                   fixed=np.array([draw.gauss(0, 1) for _ in range(3)]),
                   ranges=np.array([draw.random() for _ in range(draw.randrange(5))], np.float32),
                   names=[text() for _ in range(draw.randrange(4))], points=[point() for _ in range(draw.randrange(3))],
                   ends=[point(), point()], large=draw.randrange(2**64), bounded=text(), w=draw.gauss(0, 1))
    message.header.frame_id = text()
    message.header.stamp.sec, message.header.stamp.nanosec = draw.randrange(-2**31, 2**31), draw.randrange(10**9)
    return message


def as_plain(message):
    """Fields of a message of either implementation as lists, numbers and texts."""
    if isinstance(message, (np.ndarray, list, tuple)):
        return [as_plain(one) for one in message]
    if isinstance(message, np.generic):
        return message.item()
    if isinstance(message, (str, int, float, bool)):
        return message
    return {name: as_plain(getattr(message, name)) for name in message.__slots__}


class Cdr(unittest.TestCase):
    def setUp(self):
        definition = DEFINITION.replace("string<=20 bounded", "string bounded").replace("float64 w 1.5", "float64 w")
        self.decode = _dynamic.generate_dynamic("test_msgs/msg/All", definition)["test_msgs/msg/All"]

    def test_the_other_implementation_reads_a_thousand_random_messages(self):
        draw = random.Random(1)
        for _ in range(1000):
            message = random_message(draw)
            self.assertEqual(as_plain(self.decode(message.encode())), as_plain(message))

    def test_decoding_is_the_inverse_of_encoding(self):
        draw = random.Random(2)
        for _ in range(1000):
            message = random_message(draw)
            again = TYPE.decode(message.encode())
            self.assertEqual(as_plain(again), as_plain(message))
            self.assertEqual(again.encode(), message.encode())

    def test_defaults_are_zero_or_those_of_the_definition(self):
        message = TYPE()
        self.assertEqual((message.flag, message.small, message.w, message.bounded), (False, 0, 1.5, ""))
        self.assertEqual(list(message.fixed), [0.0, 0.0, 0.0])
        self.assertEqual((TYPE.NONE, TYPE.NAME), (0, "beam"))
        self.assertEqual(len(message.ends), 2)

    def test_an_element_of_a_list_of_messages_is_new_each_time(self):
        message = TYPE()
        message.points.append(message.element("points"))
        message.points.append(message.element("points"))
        message.points[0].x = 2.5
        self.assertEqual([point.x for point in TYPE.decode(message.encode()).points], [2.5, 0.0])
        for field in ("names", "ranges", "header", "nothing"):
            with self.assertRaisesRegex(KeyError, f"no list of messages {field}"):
                message.element(field)

    def test_types_are_found_without_their_package(self):
        names = [field.type._type_name for field in cdr.message_type(
            "test_msgs/msg/Short", f"Point p\nHeader h\n{LINE}\n" + DEFINITION.split(f"{LINE}\n", 1)[1])._fields]
        self.assertEqual(names, ["geometry_msgs/Point", "std_msgs/Header"])

    def test_big_endian_messages_are_read(self):
        data = b"\x00\x00\x00\x00" + struct.pack(">dd", 1.5, -2.0)
        self.assertEqual(as_plain(POINT.decode(data)), {"x": 1.5, "y": -2.0})

    def test_every_truncation_is_an_error(self):
        data = random_message(random.Random(3)).encode()
        for size in range(len(data)):
            with self.assertRaises(cdr.CdrError):
                TYPE.decode(data[:size])

    def test_a_sequence_that_claims_four_billion_elements_is_an_error(self):
        names = cdr.message_type("test_msgs/msg/Names", "string[] names\nfloat32[] values\n")
        for data in (b"\xff\xff\xff\xff", b"\x00\x00\x00\x00\xff\xff\xff\xff"):
            with self.assertRaises(cdr.CdrError):
                names.decode(b"\x00\x01\x00\x00" + data)

    def test_wrong_values_name_the_field(self):
        for values, text in (({"small": 300}, "small"), ({"fixed": [1.0]}, "fixed"), ({"bounded": 3}, "bounded")):
            with self.assertRaisesRegex(cdr.CdrError, text):
                TYPE(**values).encode()
        with self.assertRaisesRegex(AttributeError, "no field speed"):
            TYPE(speed=1.0)


if __name__ == "__main__":
    unittest.main()
