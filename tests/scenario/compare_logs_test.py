#!/usr/bin/env python3
"""compare_logs.py accepts logs that are equal after the mapping, and names every other difference.

usage: compare_logs_test.py COMPARE_LOGS
"""
import json
import pathlib
import struct
import subprocess
import sys
import tempfile
import unittest

from mcap.writer import Writer

COMPARE = sys.argv[1]


def cdr_string(payload, text):
    payload += b"\0" * (-(len(payload) - 4) % 4)
    return payload + struct.pack("<I", len(text) + 1) + text.encode() + b"\0"


def event(kind, text, value=1.5):
    payload = b"\0\1\0\0" + struct.pack("<iI", 3, 0)
    for field in ("map", kind, "goal_1", text):
        payload = cdr_string(payload, field)
    payload += b"\0" * (-(len(payload) - 4) % 8)
    return payload + struct.pack("<11d", value, *range(10))


def write_log(path, messages):
    """messages: (topic, type, stamp in ns, payload)."""
    with open(path, "wb") as file:
        writer = Writer(file)
        writer.start(profile="ros2", library="compare_logs_test")
        channels = {}
        for topic, type_name, stamp, payload in messages:
            if topic not in channels:
                schema = writer.register_schema(type_name, "ros2msg", b"")
                channels[topic] = writer.register_channel(topic, "cdr", schema)
            writer.add_message(channels[topic], stamp, payload, stamp)
        writer.finish()


class CompareLogs(unittest.TestCase):
    BEFORE = [("/remote", "patrol_msgs/msg/Remote", 1, b"\0\1\0\0abcd"),
              ("/events", "patrol_msgs/msg/Event", 2, event("lost", "The robot stands for 30 s.")),
              ("/scan", "sensor_msgs/msg/LaserScan", 3, b"\0\1\0\0ranges")]
    RENAMES = {"topics": {"/remote": "/teleop"}, "types": {"patrol_msgs/Remote": "patrol_msgs/Teleop"},
               "event_kinds": {"lost": "localization_lost"},
               "event_texts": [[r"The robot stands for (\d+) s\.", r"Stopped for \1 s."]]}
    AFTER = [("/teleop", "patrol_msgs/msg/Teleop", 1, b"\0\1\0\0abcd"),
             ("/events", "patrol_msgs/msg/Event", 2, event("localization_lost", "Stopped for 30 s.")),
             ("/scan", "sensor_msgs/msg/LaserScan", 3, b"\0\1\0\0ranges")]

    def compare(self, after, renames=None):
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            write_log(folder / "a.mcap", self.BEFORE)
            write_log(folder / "b.mcap", after)
            (folder / "renames.json").write_text(json.dumps(renames or {}))
            done = subprocess.run([sys.executable, COMPARE, str(folder / "a.mcap"), str(folder / "b.mcap"),
                                   "--renames", str(folder / "renames.json")], capture_output=True, text=True)
        return done.returncode, done.stdout + done.stderr

    def test_equal_logs_are_identical(self):
        self.assertEqual(self.compare(self.BEFORE), (0, "a.mcap: identical\n"))

    def test_renamed_logs_are_identical_only_with_the_mapping(self):
        self.assertEqual(self.compare(self.AFTER, self.RENAMES)[0], 0)
        status, text = self.compare(self.AFTER)
        self.assertEqual(status, 1)
        self.assertIn("expected /remote", text)

    def test_one_changed_byte_is_found(self):
        changed = [*self.AFTER[:2], (*self.AFTER[2][:3], b"\0\1\0\0rangeS")]
        status, text = self.compare(changed, self.RENAMES)
        self.assertEqual(status, 1)
        self.assertIn("message 2: /scan at 0.000000003 s: payload differs", text)

    def test_a_changed_number_in_an_event_is_found(self):
        changed = [self.AFTER[0], (*self.AFTER[1][:3], event("localization_lost", "Stopped for 30 s.", value=1.6)), self.AFTER[2]]
        self.assertEqual(self.compare(changed, self.RENAMES)[0], 1)

    def test_an_event_kind_without_mapping_is_found(self):
        renames = {**self.RENAMES, "event_kinds": {}}
        self.assertIn("expected ('lost'", self.compare(self.AFTER, renames)[1])

    def test_a_missing_message_is_found(self):
        self.assertIn("only before: /scan", self.compare(self.AFTER[:2], self.RENAMES)[1])

    def test_a_shifted_time_is_found(self):
        changed = [*self.AFTER[:2], (*self.AFTER[2][:2], 4, self.AFTER[2][3])]
        self.assertIn("times", self.compare(changed, self.RENAMES)[1])


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v"])
