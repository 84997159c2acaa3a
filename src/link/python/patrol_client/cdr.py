"""ROS 2 messages: types by their definitions, and their encoding in CDR (little-endian XCDR1 with its four-byte header).

A message is an object of a class made for its type, with one attribute for each field. Arrays of numbers are numpy
arrays, times are messages with the fields `sec` and `nanosec`.
"""

import re
import struct

import numpy

_NUMBERS = {  # type: (format of struct, size)
    "bool": ("?", 1), "byte": ("B", 1), "char": ("B", 1), "int8": ("b", 1), "uint8": ("B", 1), "int16": ("h", 2),
    "uint16": ("H", 2), "int32": ("i", 4), "uint32": ("I", 4), "int64": ("q", 8), "uint64": ("Q", 8),
    "float32": ("f", 4), "float64": ("d", 8)}

_FIELD = re.compile(r"^(?P<type>[\w/]+(?:<=\d+)?)(?P<array>\[(?P<count>(?:<=)?\d*)\])?\s+(?P<name>\w+)(?P<rest>.*)$")
_HEADER = b"\x00\x01\x00\x00"


class CdrError(ValueError):
    """Bytes that are not a message of the expected type, or a message that does not fit its type."""


class _Reader:
    def __init__(self, data):
        if len(data) < 4 or data[1] not in (0, 1):
            raise CdrError("not a CDR message")
        self.order = "<" if data[1] else ">"
        self.data = memoryview(data)[4:]
        self.offset = 0

    def take(self, size, alignment):
        start = -(-self.offset // alignment) * alignment
        if start + size > len(self.data):
            raise CdrError("message ends too early")
        self.offset = start + size
        return start

    def number(self, format, size):
        return struct.unpack_from(self.order + format, self.data, self.take(size, size))[0]

    def text(self):
        size = self.number("I", 4)
        start = self.take(size, 1)
        return str(self.data[start:start + max(size, 1) - 1], "utf-8", "replace")

    def numbers(self, format, size, count):
        if count == 0:
            return numpy.empty(0, numpy.dtype(self.order + format))
        start = self.take(size * count, size)
        return numpy.frombuffer(self.data, numpy.dtype(self.order + format), count, start)


class _Writer:
    def __init__(self):
        self.data = bytearray()

    def align(self, alignment):
        self.data.extend(bytes(-len(self.data) % alignment))

    def number(self, format, size, value):
        self.align(size)
        self.data += struct.pack("<" + format, value)

    def text(self, value):
        encoded = value.encode()
        self.number("I", 4, len(encoded) + 1)
        self.data += encoded + b"\x00"

    def numbers(self, format, size, values):
        array = numpy.ascontiguousarray(values, numpy.dtype("<" + format))
        if array.size:
            self.align(size)
            self.data += array.tobytes()


class _Field:
    """Field of a type: reads, writes and creates its value."""

    def __init__(self, name, type_name, count, types):
        self.name = name
        self.count = count  # None: one value; 0: a sequence; otherwise the length of an array
        self.is_text = type_name.split("<=")[0] in ("string", "wstring")
        self.number = _NUMBERS.get(type_name)
        self.type = None if self.is_text or self.number else types(type_name)

    def _default_one(self):
        if self.is_text:
            return ""
        return (False if self.number[0] == "?" else 0.0 if self.number[0] in "fd" else 0) if self.number else self.type()

    def default(self):
        if self.count is None:
            return self._default_one()
        if self.number:
            return numpy.zeros(self.count, numpy.dtype("<" + self.number[0]))
        return [self._default_one() for _ in range(self.count)]

    def _read_one(self, reader):
        if self.is_text:
            return reader.text()
        return reader.number(*self.number) if self.number else self.type._read(reader)

    def read(self, reader):
        if self.count is None:
            return self._read_one(reader)
        count = self.count or reader.number("I", 4)
        if self.number:
            return reader.numbers(*self.number, count)
        if count > len(reader.data):
            raise CdrError("message ends too early")
        return [self._read_one(reader) for _ in range(count)]

    def _write_one(self, writer, value):
        if self.is_text:
            writer.text(value)
        elif self.number:
            writer.number(*self.number, value)
        else:
            value._write(writer)

    def write(self, writer, value):
        if self.count is None:
            return self._write_one(writer, value)
        if self.count == 0:
            writer.number("I", 4, len(value))
        elif len(value) != self.count:
            raise CdrError(f"{self.name}: {len(value)} values: must be {self.count}")
        if self.number:
            return writer.numbers(*self.number, value)
        for one in value:
            self._write_one(writer, one)


class RosMessage:
    """Message of a type made by `message_type`. Arguments set fields; the others have their defaults."""

    __slots__ = ()
    _type_name = ""
    _fields = ()

    def __init__(self, **values):
        for field in self._fields:
            setattr(self, field.name, values.pop(field.name) if field.name in values else field.default())
        if values:
            raise AttributeError(f"{self._type_name} has no field {next(iter(values))}")

    def __repr__(self):
        return f"{self._type_name}({', '.join(f'{field.name}={getattr(self, field.name)!r}' for field in self._fields)})"

    @classmethod
    def _read(cls, reader):
        message = cls.__new__(cls)
        for field in cls._fields:
            setattr(message, field.name, field.read(reader))
        return message

    def _write(self, writer):
        for field in self._fields:
            try:
                field.write(writer, getattr(self, field.name))
            except (struct.error, TypeError, ValueError, AttributeError) as error:
                raise CdrError(f"{self._type_name}.{field.name}: {error}") from error

    @classmethod
    def element(cls, field):
        """Returns a new message for a list of messages: path.poses.append(path.element("poses")). Raises KeyError if the
        type has no such list."""
        for one in cls._fields:
            if one.name == field and one.count is not None and one.type is not None:
                return one.type()
        raise KeyError(f"{cls._type_name} has no list of messages {field}")

    @classmethod
    def decode(cls, data):
        """Returns the message of encoded bytes. Raises CdrError."""
        return cls._read(_Reader(data))

    def encode(self):
        """Returns the message as bytes. Raises CdrError."""
        writer = _Writer()
        self._write(writer)
        return _HEADER + bytes(writer.data)


def _sections(type_name, definition):
    """Splits a definition into the texts of its types, by name without /msg/."""
    sections = {}
    name, lines = type_name.replace("/msg/", "/"), []
    for line in definition.splitlines() + ["=" * 80]:
        if line.startswith("====="):
            sections[name] = lines
            name, lines = "", []
        elif line.startswith("MSG:"):
            name = line[4:].strip().replace("/msg/", "/")
        else:
            lines.append(line.split("#")[0].strip())
    return sections


def message_type(type_name, definition):
    """Returns the class of a ROS 2 message type. `definition`: fields in the format of a .msg file, followed by those of
    all types that it uses, as in MCAP files. Raises CdrError."""
    sections = _sections(type_name, definition)
    made = {}

    def make(name):
        if name in made:
            return made[name]
        if name not in sections:
            matches = [one for one in sections if one.endswith("/" + name)]
            if len(matches) != 1:
                raise CdrError(f"{type_name}: no definition of {name}")
            return make(matches[0])
        fields, constants = [], {}
        for line in filter(None, sections[name]):
            match = _FIELD.match(line)
            if match is None:
                raise CdrError(f"{type_name}: {line}: not a field")
            rest = match["rest"].strip()
            if rest.startswith("="):
                value = rest[1:].strip()
                constants[match["name"]] = value if match["type"] == "string" else float(value) if "." in value else int(value, 0)
                continue
            count = None if match["array"] is None else int(match["count"] or 0) if match["count"].isdigit() else 0
            field = _Field(match["name"], match["type"], count, make)
            if rest and field.number and count is None:
                default = type(field.default())(float(rest))
                field.default = lambda value=default: value
            fields.append(field)
        made[name] = type(name.split("/")[-1], (RosMessage,), {
            "__slots__": tuple(field.name for field in fields), "_type_name": name, "_fields": tuple(fields), **constants})
        return made[name]

    return make(type_name.replace("/msg/", "/"))
