#!/usr/bin/env python3
"""seeds.json has every scenario, half of them with another seed than 1, and ctest runs every one.

usage: seeds_test.py SOURCE_DIR
"""
import json
import pathlib
import re
import sys
import unittest

SOURCE = pathlib.Path(sys.argv[1])
FOLDER = SOURCE / "tests/scenario"
BY_CLAIM = re.compile(r'(?:assert_as_expected|run_as_in_ci)\("(\w+)"')  # runs of the Python tests with the seed of the table
WORLDS = {"tunnel_test.py": "tunnel", "street_test.py": "street", "substation_test.py": "substation"}
REPORTED = range(2001, 2011)  # kept for published figures


class Seeds(unittest.TestCase):
    def setUp(self):
        self.seeds = json.loads((FOLDER / "seeds.json").read_text())

    def test_every_scenario_has_a_seed(self):
        scenarios = {file.relative_to(SOURCE).as_posix() for file in SOURCE.glob("worlds/*/scenarios/*.yaml")}
        self.assertGreater(len(scenarios), 15)
        self.assertEqual(set(self.seeds), scenarios)

    def test_half_of_them_have_another_seed_than_1(self):
        others = [seed for seed in self.seeds.values() if seed != 1]
        self.assertGreaterEqual(2 * len(others), len(self.seeds))
        self.assertFalse([seed for seed in others if seed in REPORTED])

    def test_ctest_runs_each_once(self):
        listed = re.search(r"set\(scenarios_without_claims ([^)]*)\)", (FOLDER / "CMakeLists.txt").read_text())[1].split()
        claimed = [f"{world}/{scenario}" for file, world in WORLDS.items() for scenario in BY_CLAIM.findall((FOLDER / file).read_text())]
        self.assertEqual(sorted(listed + claimed), sorted(key[7:-5].replace("/scenarios", "") for key in self.seeds))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v"])
