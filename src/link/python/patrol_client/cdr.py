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

_FIELD = re.compile(r"^(?P<type>[\w/]+)(?:<=(?P<bound>\d+))?(?P<array>\[(?P<limit><=)?(?P<count>\d*)\])?"
                    r"\s+(?P<name>\w+)(?P<rest>.*)$")
_ELEMENT = re.compile(r"""\s*("(?:\\.|[^"\\])*"|'(?:\\.|[^'\\])*'|[^,"'\s][^,]*?)\s*(?:,|$)""")  # of the default of an array
_HEADER = b"\x00\x01\x00\x00"


class CdrError(ValueError):
    """Bytes that are not a message of the expected type, or a message that does not fit its type."""


class _Reader:
    def __init__(self, data):
        if len(data) < 4 or data[0] != 0 or data[1] not in (0, 1):
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

    def wide_text(self):
        """Reads a wstring: UTF-16 units as 32-bit numbers, without a final zero, as ROS 2 writes them."""
        units = self.numbers("I", 4, self.number("I", 4))
        return units.astype("<u2").tobytes().decode("utf-16-le", "replace")

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

    def text(self, encoded):
        self.number("I", 4, len(encoded) + 1)
        self.data += encoded + b"\x00"

    def numbers(self, size, array):
        if array.size:
            self.align(size)
            self.data += array.tobytes()


def _parse_text(text):
    """Returns a text of a definition without its quotation marks."""
    if len(text) >= 2 and text[0] == text[-1] and text[0] in "\"'":
        return text[1:-1].replace("\\" + text[0], text[0])
    return text


def _parse_value(type_name, text):
    """Returns the value of a constant or a default, by the rules of ROS 2 for its type. Raises ValueError."""
    if type_name in ("string", "wstring"):
        return _parse_text(text)
    if type_name not in _NUMBERS:
        raise ValueError(f"{text}: only numbers and strings have a value")
    if type_name == "bool":
        if text.lower() not in ("true", "1", "false", "0"):
            raise ValueError(f"{text}: must be true or false")
        return text.lower() in ("true", "1")
    if type_name in ("float32", "float64"):
        return float(text)
    try:
        value = int(text)
    except ValueError:
        value = int(text, 0)
    try:
        struct.pack("<" + _NUMBERS[type_name][0], value)
    except struct.error as error:
        raise ValueError(f"{text}: out of range of {type_name}") from error
    return value


def _parse_elements(text):
    """Returns the elements of the default of an array, such as [1, 2] or ["a, b", 'c']. Raises ValueError."""
    if not (text.startswith("[") and text.endswith("]")):
        raise ValueError(f"{text}: must be [VALUE, ...]")
    text, elements, offset = text[1:-1].strip(), [], 0
    while offset < len(text):
        match = _ELEMENT.match(text, offset)
        if match is None:
            raise ValueError(f"{text}: not a list of values")
        elements.append(match[1])
        offset = match.end()
    return elements


class _Field:
    """Field of a type: reads, writes and creates its value."""

    def __init__(self, name, type_name, count, types, limit=None, text_limit=None):
        self.name = name
        self.count = count  # None: one value; 0: a sequence; otherwise the length of an array
        self.limit = limit  # largest length of a sequence, None if unlimited
        self.text_limit = text_limit  # largest length of a string in bytes, of a wstring in UTF-16 units
        self.is_wide = type_name == "wstring"
        self.is_text = type_name in ("string", "wstring")
        self.number = _NUMBERS.get(type_name)
        self.type = None if self.is_text or self.number else types(type_name)
        self._type_name = type_name
        self._default = None

    def set_default(self, text):
        """Sets the default from its text in a definition. Raises ValueError."""
        if self.count is None:
            self._default = _parse_value(self._type_name, text)
            return
        values = [_parse_value(self._type_name, element) for element in _parse_elements(text)]
        self._check_length(len(values))
        self._default = numpy.array(values, numpy.dtype("<" + self.number[0])) if self.number else values

    def _default_one(self):
        if self.is_text:
            return ""
        return (False if self.number[0] == "?" else 0.0 if self.number[0] in "fd" else 0) if self.number else self.type()

    def default(self):
        if self._default is not None:
            return self._default if self.count is None else self._default.copy()
        if self.count is None:
            return self._default_one()
        if self.number:
            return numpy.zeros(self.count, numpy.dtype("<" + self.number[0]))
        return [self._default_one() for _ in range(self.count)]

    def _check_length(self, length):
        if self.count and length != self.count:
            raise ValueError(f"{length} values: must be {self.count}")
        if self.limit is not None and length > self.limit:
            raise ValueError(f"{length} values: must be at most {self.limit}")

    def _read_one(self, reader):
        if self.is_text:
            return reader.wide_text() if self.is_wide else reader.text()
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

    def _write_text(self, writer, value):
        encoded = value.encode("utf-16-le") if self.is_wide else value.encode()
        length = len(encoded) // 2 if self.is_wide else len(encoded)
        if self.text_limit is not None and length > self.text_limit:
            raise ValueError(f"text of length {length}: must be at most {self.text_limit}")
        if self.is_wide:
            writer.number("I", 4, length)
            writer.numbers(4, numpy.frombuffer(encoded, "<u2").astype("<u4"))
        else:
            writer.text(encoded)

    def _write_one(self, writer, value):
        if self.is_text:
            self._write_text(writer, value)
        elif self.number:
            writer.number(*self.number, value)
        elif name_of_type(value) != self.type._type_name:
            raise ValueError(f"is a {name_of_type(value)}: must be a {self.type._type_name}")
        else:
            value._write(writer)

    def _numbers(self, value):
        """Returns the numbers of an array or sequence in the type of the field. Raises ValueError if one does not fit it."""
        target = numpy.dtype("<" + self.number[0])
        source = numpy.frombuffer(value, numpy.uint8) if isinstance(value, bytes) else numpy.asarray(value)
        if target.kind in "iu" and source.dtype.kind == "f" and not isinstance(value, numpy.ndarray):
            source = numpy.asarray(value, object)  # a list with integers above 2**63 would be rounded
        if source.ndim != 1:
            raise ValueError(f"array of {source.ndim} dimensions: must have one")
        if source.dtype.kind not in "biufO":
            raise ValueError("not an array of numbers")
        with numpy.errstate(invalid="ignore"):
            array = source.astype(target, copy=False)
        if target.kind in "iu" and not numpy.can_cast(source.dtype, target) and not numpy.array_equal(array, source):
            raise ValueError("contains a number that is not in the range of its type")
        return array

    def write(self, writer, value):
        if self.count is None:
            return self._write_one(writer, value)
        if isinstance(value, str):
            raise ValueError("is a string: must be a list")
        if self.number:
            value = self._numbers(value)
        self._check_length(len(value))
        if self.count == 0:
            writer.number("I", 4, len(value))
        if self.number:
            return writer.numbers(self.number[1], value)
        for one in value:
            self._write_one(writer, one)


def name_of_type(value):
    """Returns the name of the type of a message, package/Type, or of the class of another value."""
    return value._type_name if isinstance(value, RosMessage) else type(value).__name__


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
        if not cls._fields:
            reader.take(1, 1)  # ROS 2 gives a type without fields one byte
        for field in cls._fields:
            setattr(message, field.name, field.read(reader))
        return message

    def _write(self, writer):
        if not self._fields:
            writer.number("B", 1, 0)
        for field in self._fields:
            try:
                field.write(writer, getattr(self, field.name))
            except (struct.error, TypeError, ValueError, AttributeError, OverflowError) as error:
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


def _short_name(type_name):
    """Removes the middle of pkg/msg/Type, which definitions leave out."""
    return type_name.replace("/msg/", "/")


def _sections(type_name, definition):
    """Splits a definition into the texts of its types, by name without /msg/."""
    sections = {}
    name, lines = _short_name(type_name), []
    for line in definition.split("\n") + ["=" * 80]:
        if line.startswith("==="):
            sections[name] = lines
            name, lines = "", []
        elif line.startswith("MSG:"):
            name = _short_name(line[4:].strip())
        else:
            lines.append(line.split("#")[0].strip())
    return sections


def _parse_field(line, types):
    """Returns the field of a line of a definition, or name and value of its constant. Raises ValueError."""
    match = _FIELD.match(line)
    if match is None:
        raise ValueError("not a field")
    rest = match["rest"].strip()
    if rest.startswith("="):
        return match["name"], _parse_value(match["type"], rest[1:].strip())
    number = int(match["count"] or 0)
    count = None if match["array"] is None else 0 if match["limit"] else number
    field = _Field(match["name"], match["type"], count, types, number if match["limit"] else None,
                   int(match["bound"]) if match["bound"] else None)
    if rest:
        field.set_default(rest)
    return field


def message_type(type_name, definition):
    """Returns the class of a ROS 2 message type. `definition`: fields in the format of a .msg file, followed by those of
    all types that it uses, as in MCAP files. Constants are attributes of the class. Raises CdrError."""
    sections = _sections(type_name, definition)
    made = {}

    def find(name, package):
        """Full name of a type that a type of a package uses."""
        name = _short_name(name)
        if f"{package}/{name}" in sections:
            return f"{package}/{name}"
        matches = [name] if name in sections else [one for one in sections if one.endswith("/" + name)]
        if len(matches) != 1:
            raise CdrError(f"{type_name}: no definition of {name}")
        return matches[0]

    def make(name):
        if name in made:
            if made[name] is None:
                raise CdrError(f"{type_name}: {name} contains itself")
            return made[name]
        made[name] = None  # until it is complete
        fields, constants = [], {}
        for line in filter(None, sections[name]):
            try:
                field = _parse_field(line, lambda used: make(find(used, name.rpartition("/")[0])))
            except CdrError:
                raise
            except ValueError as error:
                raise CdrError(f"{type_name}: {line}: {error}") from error
            if isinstance(field, _Field):
                fields.append(field)
            else:
                constant, value = field
                constants[constant] = value
        attributes = {"__slots__": tuple(field.name for field in fields), "_type_name": name, "_fields": tuple(fields)}
        try:
            made[name] = type(name.split("/")[-1], (RosMessage,), {**constants, **attributes})
        except (TypeError, ValueError) as error:  # a name that is not allowed or has two meanings
            raise CdrError(f"{type_name}: {error}") from error
        return made[name]

    return make(_short_name(type_name))
