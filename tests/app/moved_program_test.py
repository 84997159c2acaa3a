#!/usr/bin/env python3
"""The program starts and finds its data where an installation puts them, without the source tree that it was built from.

usage: moved_program_test.py PATROL SOURCE_DIR
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

PATROL, SOURCE = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])


def install(folder):
    """bin/patrol and lib/patrol/libmujoco.so, with every path of the source tree in the program's bytes made one that does not exist."""
    for name in ("bin", "lib/patrol", "elsewhere"):
        (folder / name).mkdir(parents=True)
    source = str(SOURCE.resolve()).encode()
    nowhere = (b"/nowhere" + b"_" * len(source))[:len(source)]
    program = folder / "bin/patrol"
    path = re.compile(rb"(?<![\w.])" + re.escape(source) + rb"(?=[/:\0])")  # not in $ORIGIN/../lib/patrol
    program.write_bytes(path.sub(nowhere, PATROL.read_bytes()))
    program.chmod(0o755)
    for line in subprocess.run(["ldd", PATROL], capture_output=True, text=True, check=True).stdout.splitlines():
        found = re.match(r"\s*(libmujoco\S*) => (\S+)", line)
        if found:
            shutil.copy(found[2], folder / "lib/patrol" / found[1])
    return program


class MovedProgram(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = pathlib.Path(temporary.name) / "opt"
        cls.program = install(cls.folder)

    def tearDown(self):
        shutil.rmtree(self.folder / "share", ignore_errors=True)

    def call(self, *arguments, data=""):
        return subprocess.run([self.program, *map(str, arguments)], capture_output=True, text=True, timeout=120, cwd=self.folder / "elsewhere",
                              env={**os.environ, "PATROL_DATA": str(data)})

    def test_help_list_and_slam_need_no_data(self):
        self.assertEqual(self.call("--help").returncode, 0)
        done = self.call("list")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("no scenarios, worlds and robots: folders worlds and models not found", done.stderr)
        self.assertIn("global planners", done.stdout)
        log = self.folder / "elsewhere/log.log"
        ranges = " ".join(["2.0"] * 181)
        log.write_text("".join(f"FLASER 181 {ranges} 0 0 0 0 0 0 {i}.0 host {i}.0\n" for i in range(3)))
        done = self.call("slam", log, "--out", self.folder / "elsewhere/slam")
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_a_run_without_data_is_refused(self):
        (self.folder / "elsewhere/my.yaml").write_text("world: street\n")
        done = self.call("run", "my.yaml")
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn("PATROL_DATA", done.stderr)

    def test_data_in_share_and_of_the_environment(self):
        shutil.copytree(SOURCE / "models", self.folder / "share/patrol/models")
        shutil.copytree(SOURCE / "worlds/street", self.folder / "share/patrol/worlds/street")
        done = self.call("list")
        self.assertIn("worlds/street/scenarios/short.yaml", done.stdout)
        self.assertNotIn("worlds/tunnel", done.stdout)
        done = self.call("run", self.folder / "share/patrol/worlds/street/scenarios/short.yaml", "--set", "time_limit_s=0.1", "--out", "run")
        self.assertEqual(done.returncode, 4, done.stderr)
        self.assertIn("worlds/tunnel", self.call("list", data=SOURCE).stdout)
        done = self.call("run", "my.yaml", data=self.folder / "elsewhere")
        self.assertEqual(done.returncode, 2)
        self.assertIn("PATROL_DATA = ", done.stderr)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v"])
