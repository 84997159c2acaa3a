"""What the tests of sweeps share: a sweep of two variants with two seeds, made on this machine without a break, whose bytes all others must have."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent.parent))
from standing_still import PATROL, SOURCE, standing_still  # noqa: E402

TABLES = ("runs.csv", "comparison.csv", "sweep.sqlite")


class SweepCase(unittest.TestCase):
    vary = ("--vary", "sensors.lidar.range_noise_std_m=0.0,0.05", "--seeds", "2")

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.path = pathlib.Path(cls.folder.name)
        cls.scenario = standing_still(cls.path, "expect:\n  mission.completed: true\n")
        cls.unbroken = cls.path / "unbroken"
        done = cls.sweep(cls.unbroken, *cls.vary)
        assert done.returncode == 0, done.stderr

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    @classmethod
    def command(cls, out, *more):
        return [str(PATROL), "sweep", str(cls.scenario), "--out", str(out), *more]

    @classmethod
    def sweep(cls, out, *more):
        return subprocess.run(cls.command(out, *more), capture_output=True, text=True, timeout=280, cwd=SOURCE)

    @classmethod
    def start(cls, out, *more):
        return subprocess.Popen(cls.command(out, *more), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=SOURCE)

    def assert_same_tables(self, out):
        for name in TABLES:
            self.assertEqual((out / name).read_bytes(), (self.unbroken / name).read_bytes(), name)
        self.assertFalse((out / "INCOMPLETE").exists())
