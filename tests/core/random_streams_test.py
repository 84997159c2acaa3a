#!/usr/bin/env python3
"""Every random stream of a seed has a name of its own: two that share one draw the same numbers.

usage: random_streams_test.py SOURCE_DIR
"""
import collections
import pathlib
import re
import sys
import unittest

SOURCE = pathlib.Path(sys.argv[1]) / "src"
STREAM = re.compile(r'[({]\s*(?:\w+\.)*seed_?\s*,\s*"([^"]+)"')


def shared_names(text_of):
    """{name: places} of the names that occur more than once."""
    places = collections.defaultdict(list)
    for file, text in text_of.items():
        for match in STREAM.finditer(text):
            places[match[1]].append(f"{file}:{text.count(chr(10), 0, match.start()) + 1}")
    return {name: found for name, found in places.items() if len(found) > 1}


class RandomStreams(unittest.TestCase):
    def test_no_name_is_used_twice(self):
        text_of = {file.relative_to(SOURCE).as_posix(): file.read_text() for file in sorted(SOURCE.rglob("*")) if file.suffix in (".h", ".cc")}
        self.assertGreater(sum(len(STREAM.findall(text)) for text in text_of.values()), 40)
        self.assertEqual(shared_names(text_of), {})

    def test_a_shared_name_is_found(self):
        text_of = {"a.cc": 'noise_(seed, "a/noise"),\n loss_{seed, "a/loss"}', "b.cc": '\nRandomStream(context.seed, "a/noise")'}
        self.assertEqual(shared_names(text_of), {"a/noise": ["a.cc:1", "b.cc:2"]})


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v"])
