#!/usr/bin/env python3
"""The messages of patrol_client are those of mcap_ros2, another implementation of CDR, in both directions."""
import random
import struct
import unittest

import numpy as np
from mcap_ros2 import _dynamic
from mcap_ros2._vendor.rosidl_adapter import parser

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

    def test_a_type_without_fields_has_one_byte(self):
        for text in ("Empty[] all\nuint8 last\n", "Empty one\nuint8 last\n", "uint8 FIRST=1\n"):
            definition = text + f"{LINE}\nMSG: test_msgs/Empty\nuint8 NONE=0\n"
            kind = cdr.message_type("test_msgs/msg/Outer", definition)
            message = kind(**{"last": 7} if "last" in text else {})
            if "all" in text:
                message.all += [message.element("all"), message.element("all")]
            theirs = _dynamic.generate_dynamic("test_msgs/msg/Outer", definition)["test_msgs/msg/Outer"](message.encode())
            self.assertEqual(getattr(theirs, "last", 7), 7)
            self.assertEqual(kind.decode(message.encode()).encode(), message.encode())
        self.assertEqual(cdr.message_type("std_msgs/msg/Empty", "")().encode(), b"\x00\x01\x00\x00\x00")

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

    def test_defaults_and_constants_are_those_of_the_parser_of_ros_2(self):
        definition = """bool YES=true
bool NO = False
bool ONE=1
byte HEX=0xfF
char LETTER=65
int8 NEGATIVE=-128
uint64 LARGE_CONSTANT=18446744073709551615
int32 LEADING_ZERO=007
float64 EXPONENT=1e-3
float32 WHOLE=2
string QUOTED="a b"
string BARE=a = b
bool valid true
bool invalid False
bool one 1
byte hexadecimal 0x7f
char letter 97
int16 negative -32768
int64 small -9223372036854775808
uint64 large 18446744073709551557
float32 ratio -.5
float64 exponent 1e300
string quoted "it's  "
string single 'say \\'a\\''
string bare two words
wstring wide "\u00e9"
int32[] list [1, -2,0x10]
uint64[2] pair [18446744073709551615, 1]
bool[2] flags [true, 0]
float64[<=3] limited [1.5, 2]
string[] texts ["a, b", 'c', d]
string[] none []
"""
        expected = parser.parse_message_string("test_msgs", "Defaults", definition)
        found = cdr.message_type("test_msgs/msg/Defaults", definition)
        for constant in expected.constants:
            self.assertEqual((constant.name, getattr(found, constant.name)), (constant.name, constant.value))
            self.assertIs(type(getattr(found, constant.name)), type(constant.value), constant.name)
        message = found()
        for field in expected.fields:
            self.assertEqual((field.name, as_plain(getattr(message, field.name))), (field.name, field.default_value))
        self.assertEqual(as_plain(found.decode(message.encode())), as_plain(message))
        message.list[0] = 5
        message.texts.append("e")
        self.assertEqual((found().list[0], len(found().texts)), (1, 3))  # a default is new for each message

    def test_values_of_a_definition_that_do_not_fit_their_type_are_errors(self):
        for line in ("bool a yes", "uint8 a 256", "int8 A=-129", "float64 a one", "int32[2] a [1]", "int32[<=1] a [1, 2]",
                     "int32[] a 1", "string[] a [,]", "test_msgs/Wrong a 1", "float64 x[3]", "byte A='x'"):
            with self.assertRaisesRegex(cdr.CdrError, "test_msgs/msg/Wrong"):
                cdr.message_type("test_msgs/msg/Wrong", line + "\n")

    def test_a_type_without_fields_has_one_byte(self):
        definition = f"std_msgs/Empty first\nuint8 number\nstd_msgs/Empty[] list\nstring text\n{LINE}\nMSG: std_msgs/Empty\n"
        found = cdr.message_type("test_msgs/msg/Empties", definition)
        message = found(number=7, text="a")
        message.list = [message.element("list")] * 3
        self.assertEqual(as_plain(_dynamic.generate_dynamic("test_msgs/msg/Empties", definition)["test_msgs/msg/Empties"](
            message.encode())), as_plain(message))
        self.assertEqual(as_plain(found.decode(message.encode())), as_plain(message))
        empty = cdr.message_type("std_msgs/msg/Empty", "")
        self.assertEqual(empty().encode(), b"\x00\x01\x00\x00\x00")
        with self.assertRaises(cdr.CdrError):
            found.decode(b"\x00\x01\x00\x00\x00\x07\x00\x00\xff\xff\xff\xff")

    def test_wide_strings_are_utf16_units_of_four_bytes(self):
        wide = cdr.message_type("test_msgs/msg/Wide", "uint8 a\nwstring text\nwstring[] more\n")
        message = wide(a=1, text="a\u00e9\U0001f600", more=["", "b"])
        self.assertEqual(message.encode()[4:28], struct.pack("<BxxxI4I", 1, 4, 0x61, 0xe9, 0xd83d, 0xde00))
        self.assertEqual(as_plain(wide.decode(message.encode())), as_plain(message))
        for size in range(len(message.encode())):
            with self.assertRaises(cdr.CdrError):
                wide.decode(message.encode()[:size])

    def test_limits_of_strings_and_sequences(self):
        bounded = cdr.message_type("test_msgs/msg/Bounded", "string<=3 text\nint32[<=2] list\nstring<=1[<=2] texts\n")
        full = bounded(text="abc", list=[1, 2], texts=["a", "b"])
        self.assertEqual(as_plain(bounded.decode(full.encode())), as_plain(full))
        for values in ({"text": "abcd"}, {"list": [1, 2, 3]}, {"texts": ["a"] * 3}, {"texts": ["ab"]}):
            with self.assertRaisesRegex(cdr.CdrError, f"{next(iter(values))}: .* at most"):
                bounded(**values).encode()

    def test_arrays_of_numbers_that_do_not_fit_are_errors(self):
        lists = cdr.message_type("test_msgs/msg/Lists", "int8[] cells\nuint8[] data\nuint64[] large\nfloat32[] ranges\nfloat32 x\n")
        for values in ({"cells": np.array([100, 200])}, {"cells": [300]}, {"cells": np.array([0.5])}, {"large": np.array([-1])},
                       {"cells": np.array([np.nan])}, {"cells": np.zeros((2, 3), np.int8)}, {"ranges": np.zeros((2, 3))},
                       {"ranges": 1.0}, {"ranges": "12"}, {"ranges": ["1"]}, {"large": [2**64]}, {"x": 1e39}):
            with self.assertRaisesRegex(cdr.CdrError, next(iter(values))):
                lists(**values).encode()
        message = lists(cells=np.array([-1.0, 100.0]), data=b"\x01\xff", large=[2**64 - 1, 1], ranges=[1, 2.5])
        self.assertEqual(as_plain(lists.decode(message.encode())), {
            "cells": [-1, 100], "data": [1, 255], "large": [2**64 - 1, 1], "ranges": [1.0, 2.5], "x": 0.0})

    def test_a_message_of_another_type_is_an_error(self):
        message = TYPE()
        for value, name in ((POINT(), "geometry_msgs/Point"), ("", "str"), (None, "NoneType")):
            message.header = value
            with self.assertRaisesRegex(cdr.CdrError, f"header: is a {name}: must be a std_msgs/Header"):
                message.encode()
        with self.assertRaisesRegex(cdr.CdrError, "names: is a string"):
            TYPE(names="ab").encode()

    def test_types_of_the_same_package_and_with_msg_in_their_name(self):
        found = cdr.message_type("my_msgs/msg/Both", f"Point near\nother_msgs/msg/Point far\n{LINE}\nMSG: other_msgs/Point\n"
                                 f"float32 z\n{LINE}\nMSG: my_msgs/Point\nfloat32 x\n")
        self.assertEqual([field.type._type_name for field in found._fields], ["my_msgs/Point", "other_msgs/Point"])

    def test_definitions_that_are_no_types_are_errors(self):
        for definition in ("Wrong[] children\n", "float64 3x\n", "float64 x\nuint8 x=1\n", "missing_msgs/Type x\n"):
            with self.assertRaises(cdr.CdrError):
                cdr.message_type("test_msgs/msg/Wrong", definition)


if __name__ == "__main__":
    unittest.main()
