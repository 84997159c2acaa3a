#!/usr/bin/env python3
"""tools/profile: stacks, tables and flame graph of recorded samples, and wrong input.

usage: profile_test.py SOURCE_DIR
"""
import importlib.machinery
import importlib.util
import pathlib
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree as xml

SOURCE = pathlib.Path(sys.argv[1]).resolve()
sys.dont_write_bytecode = True
LOADER = importlib.machinery.SourceFileLoader("profile_tool", str(SOURCE / "tools/profile"))
profile = importlib.util.module_from_spec(importlib.util.spec_from_loader(LOADER.name, LOADER))
LOADER.exec_module(profile)

# Three samples: two in step called by main, one in cast called by step.
SCRIPT = """patrol
\t    5b1 patrol::sim::(anonymous namespace)::step(int, double)
\t    5a0 main

patrol
\t    5b1 patrol::sim::(anonymous namespace)::step(int, double)
\t    5a0 main

patrol
\t    6c3 std::function<void (int)>::cast(std::vector<int> const&) const
\t    5b1 patrol::sim::(anonymous namespace)::step(int, double)
\t    5a0 main
"""


class Profile(unittest.TestCase):
    def setUp(self):
        self.stacks = profile.folded_stacks(SCRIPT.splitlines(keepends=True))

    def test_stacks_are_counted_from_the_outermost_function(self):
        self.assertEqual(dict(self.stacks), {("main", "patrol::sim::step"): 2, ("main", "patrol::sim::step", "std::function::cast"): 1})

    def test_shares_of_a_function_and_of_its_calls(self):
        rows = {function: (own, total) for function, own, total in profile.by_function(self.stacks)}
        self.assertEqual(set(rows), {"patrol::sim::step", "std::function::cast"})
        self.assertAlmostEqual(rows["patrol::sim::step"][0], 2 / 3)
        self.assertAlmostEqual(rows["patrol::sim::step"][1], 1.0)

    def test_a_box_of_the_flame_graph_is_as_wide_as_its_share(self):
        graph = profile.FlameGraph(self.stacks, "a < b")
        root = xml.fromstring(graph.svg())
        widths = {group[0].text: float(group[1].get("width")) for group in root.findall("{http://www.w3.org/2000/svg}g")}
        self.assertAlmostEqual(widths["main: 100.0 %"], 1200.0)
        self.assertAlmostEqual(widths["std::function::cast: 33.3 %"], 400.0)

    def test_parts_are_listed_by_time_with_calls(self):
        lines = profile.part_table({"real_time_factor": 20.0, "wall_s": 5.0, "cpu_s": 4.0, "parts_s": {"lidar": 1.0, "physics": 2.0},
                                    "parts_calls": {"physics": 1000}})
        self.assertEqual(lines[2], "| physics | 2.00 | 40.0 % | 50 | 1000 | 2000.0 |")
        self.assertEqual(lines[3], "| lidar | 1.00 | 20.0 % | 100 | – | – |")
        self.assertIn("25.0", lines[4])

    def test_counters_that_the_machine_lacks_are_left_out(self):
        text = "1000,,cycles,1,100.00,,\n3000,,instructions:u,1,100.00,,\n<not supported>,,cache-misses,0,100.00,,\n"
        self.assertEqual(profile.counted(text), {"cycles": 1000, "instructions": 3000})
        self.assertIn("per cycle: 3.00", profile.counter_lines(profile.counted(text))[0])
        self.assertIn("not available", profile.counter_lines({})[0])

    def test_wrong_input_gives_one_line_and_exit_code_2(self):
        with tempfile.TemporaryDirectory() as folder:
            for words, message in ((["a/b", "--patrol", "/nowhere/patrol"], "no such program"), (["a/b", "--frequency", "0"], "--frequency 0")):
                done = subprocess.run([SOURCE / "tools/profile", *words, "--out", f"{folder}/out"], capture_output=True, text=True)
                self.assertEqual((done.returncode, done.stderr.count("\n")), (2, 1), done.stderr)
                self.assertIn(message, done.stderr)
                self.assertFalse(pathlib.Path(folder, "out").exists())


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
