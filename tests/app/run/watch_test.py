#!/usr/bin/env python3
"""`patrol run --watch` on a terminal of its own: it draws, gives the screen back, and leaves the run that it would leave unwatched.

usage: watch_test.py PATROL SOURCE_DIR
"""
import os
import pathlib
import pty
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent))
from standing_still import HOME, PATROL, SOURCE, standing_still  # noqa: E402


class Watch(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = pathlib.Path(folder.name)
        # Long enough for several frames, at ten a second of wall time.
        self.scenario = standing_still(self.path, "stack: {gas_mission: {init_wait_s: 20}}\n", station={**HOME, "position": [1.0, 3.0, 0.0]})

    def test_it_draws_and_the_run_is_the_same(self):
        terminal, shown = pty.openpty()
        process = subprocess.Popen([PATROL, "run", self.scenario, "--watch", "--out", self.path / "watched"], stdout=shown, stderr=shown, cwd=SOURCE)
        os.close(shown)
        screen = b""
        try:
            while block := os.read(terminal, 65536):
                screen += block
        except OSError:  # the other end is closed
            pass
        self.assertEqual(process.wait(timeout=120), 0, screen[-2000:])
        text = screen.decode(errors="replace")
        self.assertGreater(text.count("\x1b[H"), 2)
        self.assertIn("x real time", text)
        self.assertLess(text.index("\x1b[?1049h"), text.index("\x1b[?1049l"))
        summary = text[text.index("\x1b[?1049l"):]
        self.assertIn("all with option --all", summary)
        self.assertIn("\x1b[32m", summary)  # colors on a terminal
        subprocess.run([PATROL, "run", self.scenario, "--out", self.path / "alone"], check=True, capture_output=True, cwd=SOURCE)
        for name in ("estimate.tum", "truth.tum", "map.pgm"):
            self.assertEqual((self.path / "watched" / name).read_bytes(), (self.path / "alone" / name).read_bytes(), name)

    def test_without_a_terminal_it_is_refused_before_anything_is_written(self):
        done = subprocess.run([PATROL, "run", self.scenario, "--watch", "--out", self.path / "none"], capture_output=True, text=True, cwd=SOURCE)
        self.assertEqual((done.returncode, done.stderr.count("\n")), (2, 1), done.stderr)
        self.assertFalse((self.path / "none").exists())


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v"])
