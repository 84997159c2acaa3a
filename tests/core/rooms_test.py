#!/usr/bin/env python3
"""Holds the #include lines of src/ to the arrows of the design: what each room may use, and that the stack cannot name the
simulator nor the ground truth.

usage: rooms_test.py SOURCE_DIR
"""
import pathlib
import re
import sys
import unittest

SOURCE = pathlib.Path(sys.argv[1]) / "src"

MAY_USE = {
    "core": set(),
    "io": {"core"},
    "sim": {"core"},
    "slam": {"core"},
    "localize": {"core", "slam"},
    "plan": {"core"},
    "inspect": {"core", "slam"},
    "stack": {"core", "slam", "localize", "plan", "inspect"},
    "score": {"core"},
    "render": {"core", "io", "sim"},
    "monitor": {"core", "io"},
    "app": {"core", "io", "sim", "slam", "localize", "plan", "inspect", "stack", "score", "render", "monitor"},
}
STACK = ("slam", "localize", "plan", "inspect", "stack")
BLIND = STACK + ("score",)  # rooms that never see MuJoCo


def includes():
    """(room, file, included path) for every #include line."""
    for file in sorted(SOURCE.rglob("*")):
        if file.suffix not in (".h", ".cc"):
            continue
        room = file.relative_to(SOURCE).parts[0]
        for match in re.finditer(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]', file.read_text(), re.M):
            yield room, file.relative_to(SOURCE), match.group(1)


class Rooms(unittest.TestCase):
    def test_every_room_is_known(self):
        rooms = {path.name for path in SOURCE.iterdir() if path.is_dir()}
        self.assertEqual(rooms, set(MAY_USE))

    def test_includes_follow_the_arrows(self):
        for room, file, included in includes():
            target = included.split("/")[0]
            if target in MAY_USE and target != room:
                self.assertIn(target, MAY_USE[room], f"{file} includes {included}")

    def test_stack_and_judge_never_include_the_simulator(self):
        for room, file, included in includes():
            if room in BLIND:
                self.assertFalse(included.startswith(("mujoco", "sim/", "render/", "embree")), f"{file} includes {included}")

    def test_stack_never_includes_the_ground_truth(self):
        for room, file, included in includes():
            if room in STACK:
                self.assertNotEqual(included, "core/ground_truth.h", str(file))

    def test_includes_were_found(self):
        self.assertGreater(sum(1 for _ in includes()), 50)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v"])
