#!/usr/bin/env python3
"""`patrol verify` finds a run equal to its repetition, and names the place when one number of its log is changed.

usage: verify_test.py PATROL RUN_DIRECTORY
"""
import pathlib
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest

from mcap.reader import make_reader
from mcap.writer import Writer

PATROL, RUN = sys.argv[1], pathlib.Path(sys.argv[2])
CHANGED_SCAN, BEAM, CHANGED_RANGE_M = 40, 417, 1.25  # the scan of 4 s or so


def verify(run):
    return subprocess.run([PATROL, "verify", str(run)], capture_output=True, text=True, timeout=280)


def with_range(cdr, beam, range_m):
    """A LaserScan's CDR bytes with one range changed, and what it was."""
    frame_length = struct.unpack_from("<I", cdr, 12)[0]  # after the encapsulation and the stamp
    ranges = 16 + frame_length
    ranges = 4 + (ranges - 4 + 3) // 4 * 4 + 7 * 4 + 4  # seven float32, the list's length
    at = ranges + 4 * beam
    was = struct.unpack_from("<f", cdr, at)[0]
    return cdr[:at] + struct.pack("<f", range_m) + cdr[at + 4:], was


def copy_with_one_change(source, target):
    """Copies a log with MCAP's own reader and writer, one number changed; gives the message's log time and the number."""
    scan, place = 0, None
    with open(source, "rb") as read, open(target, "wb") as write:
        writer = Writer(write)
        writer.start(profile="ros2", library="verify_test")
        channels = {}
        for schema, channel, message in make_reader(read).iter_messages(log_time_order=False):
            if channel.id not in channels:
                schema_id = writer.register_schema(schema.name, schema.encoding, schema.data)
                channels[channel.id] = writer.register_channel(channel.topic, channel.message_encoding, schema_id)
            data = message.data
            if channel.topic == "/scan":
                scan += 1
                if scan == CHANGED_SCAN:
                    data, was = with_range(data, BEAM, CHANGED_RANGE_M)
                    place = message.log_time, was
            writer.add_message(channels[channel.id], message.log_time, data, message.publish_time, message.sequence)
        writer.finish()
    return place


class Verify(unittest.TestCase):
    def test_the_run_is_its_own_repetition(self):
        done = verify(RUN)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertEqual(done.stdout, "simulator: byte-identical\nstack: byte-identical\n")

    def test_one_changed_number_is_named_by_topic_time_and_field(self):
        with tempfile.TemporaryDirectory() as folder:
            copy = pathlib.Path(folder) / "run"
            copy.mkdir()
            shutil.copy(RUN / "scenario.yaml", copy)
            log_time, was = copy_with_one_change(RUN / "log.mcap", copy / "log.mcap")
            done = verify(copy)
        self.assertEqual(done.returncode, 1, done.stdout + done.stderr)
        self.assertIn(f"simulator: differs: /scan at {log_time // 10**9}.{log_time % 10**9:09} s: ranges[{BEAM}] is ", done.stdout)
        self.assertIn(f", was {CHANGED_RANGE_M}", done.stdout)
        self.assertNotEqual(was, CHANGED_RANGE_M)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v"])
