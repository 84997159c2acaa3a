#!/usr/bin/env python3
"""Compares the log.mcap files of two versions of the program, after mapping the names that changed between them.

Both logs must contain the same messages in the same order: topic, log time, publish time and payload bytes. The mapping is a JSON file:
  topics          {"/old": "/new"}                          topic of a channel
  types           {"pkg/Old": "pkg/New"}                    schema name
  event_kinds     {"old": "new"}                            field `kind` of patrol_msgs/Event
  event_subjects  [["regex", "replacement"]]                field `subject` of patrol_msgs/Event, whole field
  event_texts     {"module": [["regex", "replacement"]]}    field `text` of patrol_msgs/Event: every match in the text, in order
  geoms           [["regex", "replacement"]]                geoms of patrol_msgs/Collision, whole field
  ignored         ["/topic"]                                topics whose payload is not compared, with the reason beside them in the file
tests/scenario/log_renames.json is the mapping from the last version with the former names. Payloads of other types must be identical byte for
byte. Schema texts are not compared, because comments and field names in them may change.

usage: compare_logs.py BEFORE AFTER [--renames FILE.json]
       BEFORE and AFTER are logs, or folders that hold a run directory for each scenario.
Exit status: 0 identical after mapping, 1 different, 2 usage.
"""
import argparse
import json
import pathlib
import re
import struct
import sys

from mcap.reader import make_reader

NUM_STRINGS = {"patrol_msgs/Event": 3, "patrol_msgs/Collision": 2}  # types with names in their payload: strings after the header


def compiled(pairs):
    return [(re.compile(pattern), replacement) for pattern, replacement in pairs]


def replace_whole(pairs, text):
    """Replacement of the first pattern that matches the whole text; the text itself if none does."""
    for pattern, replacement in pairs:
        if pattern.fullmatch(text):
            return pattern.sub(replacement, text)
    return text


class Renames:
    """Names of the older log, mapped to those of the newer one."""

    def __init__(self, table):
        self.topics = table.get("topics", {})
        self.types = table.get("types", {})
        self.event_kinds = table.get("event_kinds", {})
        self.event_subjects = compiled(table.get("event_subjects", []))
        self.event_texts = [pair for pairs in table.get("event_texts", {}).values() for pair in compiled(pairs)]
        self.geoms = compiled(table.get("geoms", []))
        self.ignored = set(table.get("ignored", []))

    def text(self, text):
        for pattern, replacement in self.event_texts:
            text = pattern.sub(replacement, text)
        return text

    def strings(self, type_name, strings):
        """Mapped strings of a payload of this type."""
        if type_name == "patrol_msgs/Collision":
            return [replace_whole(self.geoms, name) for name in strings]
        kind, subject, text = strings
        return [self.event_kinds.get(kind, kind), replace_whole(self.event_subjects, subject), self.text(text)]


class NamedPayload:
    """CDR payload (little endian) with names: header, strings, and the numbers after them."""

    def __init__(self, type_name, data):
        _, at = self._string(data, 12)  # encapsulation, stamp, then frame_id
        self.header = data[:at]
        self.strings = []
        for _ in range(NUM_STRINGS[type_name]):
            string, at = self._string(data, at)
            self.strings.append(string)
        self.numbers = data[4 + (at - 4 + 7) // 8 * 8:]  # float64 from here on

    @staticmethod
    def _string(data, at):
        at = 4 + (at - 4 + 3) // 4 * 4
        length = struct.unpack_from("<I", data, at)[0]
        return data[at + 4:at + 4 + length - 1].decode(), at + 4 + length


def named_difference(type_name, before, after, renames):
    """Difference of two payloads with names; None if they are equal after the mapping."""
    old, new = NamedPayload(type_name, before), NamedPayload(type_name, after)
    expected = renames.strings(type_name, old.strings)
    if (old.header, old.numbers) != (new.header, new.numbers):
        return f"{new.strings}: header or numbers differ"
    return None if expected == new.strings else f"{new.strings}, expected {expected}"


def messages(log):
    """(topic, type, log time, publish time, payload) of every message in file order."""
    with open(log, "rb") as file:
        for schema, channel, message in make_reader(file).iter_messages(log_time_order=False):
            yield channel.topic, schema.name.replace("/msg/", "/"), message.log_time, message.publish_time, message.data


def first_difference(before, after, renames):
    """One line that names the first difference; None if there is none."""
    old, new = messages(before), messages(after)
    count = 0
    while True:
        a, b = next(old, None), next(new, None)
        if a is None and b is None:
            return None
        if a is None or b is None:
            topic, _, stamp, _, _ = a or b
            return f"message {count}: only {'before' if a else 'after'}: {topic} at {stamp * 1e-9:.9f} s"
        topic, type_name = renames.topics.get(a[0], a[0]), renames.types.get(a[1], a[1])
        place = f"message {count}: {b[0]} at {b[2] * 1e-9:.9f} s"
        if (topic, type_name) != b[:2]:
            return f"{place}: {b[1]}, expected {topic} of type {type_name}"
        if a[2:4] != b[2:4]:
            return f"{place}: times {b[2:4]}, before {a[2:4]}"
        if topic not in renames.ignored and (a[4] != b[4] or type_name in NUM_STRINGS):
            if type_name not in NUM_STRINGS:
                return f"{place}: payload differs ({len(a[4])} and {len(b[4])} bytes)"
            difference = named_difference(type_name, a[4], b[4], renames)
            if difference:
                return f"{place}: {difference}"
        count += 1


def pairs(before, after):
    """Logs of the same scenario; a scenario that only one side has is an error."""
    if before.is_file():
        return [(before.name, before, after)]
    old = {log.parent.name: log for log in before.glob("*/log.mcap")}
    new = {log.parent.name: log for log in after.glob("*/log.mcap")}
    missing = sorted(set(old) - set(new))
    if missing or not old:
        sys.exit(f"compare_logs: {after}: no log of {', '.join(missing) or 'any scenario'}")
    return [(name, old[name], new[name]) for name in sorted(old)]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("before", type=pathlib.Path)
    parser.add_argument("after", type=pathlib.Path)
    parser.add_argument("--renames", type=pathlib.Path)
    arguments = parser.parse_args()
    renames = Renames(json.loads(arguments.renames.read_text()) if arguments.renames else {})
    num_different = 0
    for name, old, new in pairs(arguments.before, arguments.after):
        difference = first_difference(old, new, renames)
        num_different += difference is not None
        print(f"{name}: {difference or 'identical'}", flush=True)
    return 1 if num_different else 0


if __name__ == "__main__":
    sys.exit(main())
