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


def strings(*fields):
    payload = b"\0\1\0\0" + struct.pack("<iI", 3, 0)
    for field in fields:
        payload = cdr_string(payload, field)
    return payload


def event(kind, text, value=1.5, subject="goal_1"):
    payload = strings("map", kind, subject, text)
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
               "event_texts": {"mission": [[r"The robot stands for (\d+) s\.", r"Stopped for \1 s."]]}}
    AFTER = [("/teleop", "patrol_msgs/msg/Teleop", 1, b"\0\1\0\0abcd"),
             ("/events", "patrol_msgs/msg/Event", 2, event("localization_lost", "Stopped for 30 s.")),
             ("/scan", "sensor_msgs/msg/LaserScan", 3, b"\0\1\0\0ranges")]

    def compare(self, after, renames=None, before=None):
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            write_log(folder / "a.mcap", before or self.BEFORE)
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
        self.assertIn("expected ['lost'", self.compare(self.AFTER, renames)[1])

    def test_every_match_in_a_text_is_replaced(self):
        before = [("/events", "patrol_msgs/msg/Event", 2, event("navigation", "Given up. There is no route."))]
        after = [("/events", "patrol_msgs/msg/Event", 2, event("navigation", "Aborted: no path."))]
        texts = {"plan": [[r"^Given up\. ", "Aborted: "], [r"There is no route\.$", "no path."]]}
        self.assertEqual(self.compare(after, {"event_texts": texts}, before)[0], 0)

    def test_a_renamed_subject_is_mapped_only_as_a_whole(self):
        def log(subject):
            return [("/events", "patrol_msgs/msg/Event", 2, event("sensor_fault", "Timeout.", subject=subject))]
        renames = {"event_subjects": [["remote", "teleop"]]}
        self.assertEqual(self.compare(log("teleop"), renames, log("remote"))[0], 0)
        self.assertEqual(self.compare(log("teleop_2"), renames, log("remote_2"))[0], 1)

    def test_renamed_geoms_of_a_collision_are_mapped(self):
        def log(geom):
            return [("/ground_truth/collisions", "patrol_msgs/msg/Collision", 2, strings("world", "trunk", geom))]
        renames = {"geoms": [[r"prop_(\d+)", r"static_obstacle_\1"]]}
        self.assertEqual(self.compare(log("static_obstacle_3"), renames, log("prop_3"))[0], 0)
        self.assertIn("expected ['trunk', 'static_obstacle_3']", self.compare(log("static_obstacle_4"), renames, log("prop_3"))[1])

    def test_the_mapping_of_the_repository_names_what_the_sources_have(self):
        root = pathlib.Path(__file__).resolve().parents[2]
        renames = json.loads((root / "tests/scenario/log_renames.json").read_text())
        sources = "\n".join(file.read_text() for folder in ("src/core", "src/io") for file in (root / folder).rglob("*.h"))
        kinds = (root / "src/core/event.h").read_text()
        types = [new.replace("/", "/msg/") for new in renames["types"].values()]
        missing = [new for new in [*renames["topics"].values(), *types] if f'"{new}"' not in sources]
        missing += [new for new in renames["event_kinds"].values() if f'"{new}"' not in kinds]
        self.assertEqual(missing, [])
        self.assertEqual([old for old in renames["event_kinds"] if f'"{old}"' in kinds], [])
        self.assertEqual([old for old in renames["topics"] if f'"{old}"' in sources], [])

    def test_a_missing_message_is_found(self):
        self.assertIn("only before: /scan", self.compare(self.AFTER[:2], self.RENAMES)[1])

    def test_a_shifted_time_is_found(self):
        changed = [*self.AFTER[:2], (*self.AFTER[2][:2], 4, self.AFTER[2][3])]
        self.assertIn("times", self.compare(changed, self.RENAMES)[1])


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v"])
