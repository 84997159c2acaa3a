#!/usr/bin/env python3
"""The stack's and the judge's libraries name nothing of the simulator: what they cannot link they cannot see.

usage: links_test.py LIBRARY...
"""
import re
import subprocess
import sys
import unittest

LIBRARIES = sys.argv[1:]
SIMULATOR = re.compile(r"^(mj[a-z]*_|mjs_|rtc[A-Z]|OSMesa|_ZNK?6patrol3sim|_ZNK?6patrol6render)")


def undefined_symbols(library):
    listing = subprocess.run(["nm", "--undefined-only", "--format=just-symbols", library], capture_output=True, text=True, check=True)
    return [line.strip() for line in listing.stdout.splitlines() if line.strip() and not line.endswith(":")]


class Links(unittest.TestCase):
    def test_no_library_of_the_stack_names_the_simulator(self):
        for library in LIBRARIES:
            with self.subTest(library):
                symbols = undefined_symbols(library)
                self.assertGreater(len(symbols), 10, "nm has read nothing")
                self.assertEqual([symbol for symbol in symbols if SIMULATOR.match(symbol)], [])


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v"])
