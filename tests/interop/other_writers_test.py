#!/usr/bin/env python3
"""`patrol score` reads logs that the official MCAP writer has packed, however it packs them, and comes to the same figures.

usage: other_writers_test.py PATROL RUN_DIRECTORY
"""
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

from mcap.reader import make_reader
from mcap.writer import CompressionType, IndexType, Writer

PATROL, RUN = sys.argv[1], pathlib.Path(sys.argv[2])


def repack(source, target, **packing):
    with open(source, "rb") as read, open(target, "wb") as write:
        writer = Writer(write, **packing)
        writer.start(profile="ros2", library="other_writers_test")
        channels = {}
        for schema, channel, message in make_reader(read).iter_messages(log_time_order=False):
            if channel.id not in channels:
                schema_id = writer.register_schema(schema.name, schema.encoding, schema.data)
                channels[channel.id] = writer.register_channel(channel.topic, channel.message_encoding, schema_id)
            writer.add_message(channels[channel.id], message.log_time, message.data, message.publish_time, message.sequence)
        writer.finish()


class OtherWriters(unittest.TestCase):
    def check(self, **packing):
        with tempfile.TemporaryDirectory() as folder:
            copy = pathlib.Path(folder) / "run"
            shutil.copytree(RUN, copy, ignore=shutil.ignore_patterns("log.mcap", "metrics.json"))
            repack(RUN / "log.mcap", copy / "log.mcap", **packing)
            done = subprocess.run([PATROL, "score", str(copy)], capture_output=True, text=True, timeout=120)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            ours, again = (json.loads((run / "metrics.json").read_text()) for run in (RUN, copy))
        for part in ("mission", "pose", "odometry", "map", "stations", "inspection"):
            self.assertEqual(again[part], ours[part], part)

    def test_lz4(self):
        self.check(compression=CompressionType.LZ4)

    def test_zstd_in_small_chunks(self):
        self.check(compression=CompressionType.ZSTD, chunk_size=20_000)

    def test_not_compressed_without_checksums(self):
        self.check(compression=CompressionType.NONE, enable_crcs=False)

    def test_without_chunks(self):
        self.check(use_chunking=False)

    def test_channels_and_schemas_only_within_the_chunks(self):
        self.check(repeat_channels=False, repeat_schemas=False)

    def test_without_indexes_and_summary(self):
        self.check(index_types=IndexType.NONE, repeat_channels=False, repeat_schemas=False, use_statistics=False, use_summary_offsets=False)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v"])
