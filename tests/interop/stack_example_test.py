#!/usr/bin/env python3
"""A program outside of the project, built against the installed package, makes of a run's log the map that the run made, but for
single cells: a log holds the angles of a scan in single precision.

usage: stack_example_test.py BUILD_DIR SOURCE_DIR RUN_DIR
"""
import pathlib
import subprocess
import sys
import tempfile
import unittest

BUILD, SOURCE, RUN = (pathlib.Path(argument).resolve() for argument in sys.argv[1:4])


def run(*command):
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True)
    if done.returncode != 0:
        raise AssertionError(f"{command}: exit code {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout


class StackExample(unittest.TestCase):
    def test_makes_the_map_of_the_run_from_its_log(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            for component in ("core", "io", "slam", "localize", "plan", "inspect", "stack"):
                run("cmake", "--install", BUILD, "--prefix", folder / "installed", "--component", component)
            run("cmake", "-S", SOURCE / "tests/interop/stack_example", "-B", folder / "build", "-DCMAKE_BUILD_TYPE=Release",
                f"-DCMAKE_PREFIX_PATH={folder / 'installed'}")
            run("cmake", "--build", folder / "build")
            said = run(folder / "build/stack_example", SOURCE / "models/quadruped/quadruped.urdf", SOURCE / "worlds/street/routes/short.json",
                       RUN / "log.mcap", folder / "map.yaml")
            self.assertIn("messages published", said)
            made, expected = (folder / "map.pgm").read_bytes(), (RUN / "map.pgm").read_bytes()
            self.assertEqual(len(made), len(expected))
            self.assertLess(sum(a != b for a, b in zip(made, expected)), 1e-4 * len(expected))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v"])
