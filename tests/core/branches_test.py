#!/usr/bin/env python3
"""tools/branches: first difference of two logs, the table, and wrong input.

usage: branches_test.py SOURCE_DIR
"""
import importlib.machinery
import importlib.util
import pathlib
import subprocess
import sys
import tempfile
import unittest

from mcap.writer import Writer

SOURCE = pathlib.Path(sys.argv[1]).resolve()
sys.dont_write_bytecode = True
LOADER = importlib.machinery.SourceFileLoader("branches_tool", str(SOURCE / "tools/branches"))
branches = importlib.util.module_from_spec(importlib.util.spec_from_loader(LOADER.name, LOADER))
LOADER.exec_module(branches)


def write_log(path, records):
    """Log of (topic, time in ns, payload)."""
    with open(path, "wb") as file:
        writer = Writer(file)
        writer.start()
        channels = {topic: writer.register_channel(topic, "cdr", 0) for topic in sorted({record[0] for record in records})}
        for topic, stamp, data in records:
            writer.add_message(channels[topic], stamp, data, stamp)
        writer.finish()


RECORDS = [("/imu", 10, b"a"), ("/scan", 20, b"b"), ("/stack/turns", 20, b"1 ms"), ("/imu", 30, b"c")]


class Branches(unittest.TestCase):
    def difference(self, other):
        with tempfile.TemporaryDirectory() as folder:
            one, two = pathlib.Path(folder, "one.mcap"), pathlib.Path(folder, "two.mcap")
            write_log(one, RECORDS)
            write_log(two, other)
            return branches.first_difference(one, two)

    def test_equal_logs_do_not_differ_nor_do_durations_of_turns(self):
        self.assertIsNone(self.difference(RECORDS))
        self.assertIsNone(self.difference([*RECORDS[:2], ("/stack/turns", 20, b"2 ms"), RECORDS[3]]))

    def test_a_payload_a_time_and_a_missing_message_are_named(self):
        self.assertEqual(self.difference([*RECORDS[:3], ("/imu", 30, b"d")]), ("/imu", 30 / 1e9))
        self.assertEqual(self.difference([RECORDS[0], ("/scan", 21, b"b"), *RECORDS[2:]]), ("/scan", 20 / 1e9))
        self.assertEqual(self.difference(RECORDS[:3]), ("/imu", 30 / 1e9))

    def test_the_table_counts_identical_branches(self):
        rows = [{"scenario": "a/b", "duration_s": 50.0, "largest_mb": 2.94, "snapshot_ms": 34.4, "run_s": 4.0,
                 "branches": [{"processor_s": 1.0, "difference": None}, {"processor_s": 3.0, "difference": ["/imu", 1.0]}]}]
        self.assertEqual(branches.branch_table(rows).splitlines()[2], "| a/b | 50 | 2 | 1 | 2.9 | 34 | 0.50 |")

    def test_wrong_input_gives_one_line_and_exit_code_2(self):
        for words, message in ((["a/b", "--patrol", "/nowhere/patrol"], "no such program"), (["a/b", "--instants", "0"], "--instants 0"),
                               (["a/b", "--every", "nan"], "--every nan")):
            done = subprocess.run([SOURCE / "tools/branches", *words], capture_output=True, text=True)
            self.assertEqual((done.returncode, done.stderr.count("\n")), (2, 1), done.stderr)
            self.assertIn(message, done.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
