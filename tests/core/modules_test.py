#!/usr/bin/env python3
"""Checks the #include lines of src/: modules include only what the design allows, the robot's software and the
evaluation never include the simulator, the robot's software never includes the ground truth, and no folders include each
other in a cycle. The top level of the repository holds nothing else.

The checks themselves are tested on small source trees with planted violations.

usage: modules_test.py SOURCE_DIR
"""
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(sys.argv[1]) / "src"

MAY_USE = {
    "core": set(),
    "io": {"core"},
    "importer": {"core", "io", "sim"},
    "link": {"core", "io"},
    "sim": {"core"},
    "realism": {"core", "sim"},
    "slam": {"core"},
    "localize": {"core", "slam"},
    "plan": {"core"},
    "inspect": {"core", "slam"},
    "stack": {"core", "slam", "localize", "plan", "inspect"},
    "score": {"core"},
    "render": {"core", "io", "sim"},
    "report": {"core", "io", "score"},
    "monitor": {"core", "io"},
    "studies": {"core", "io", "slam", "localize", "plan", "inspect", "stack", "score", "report"},
    "app": {"core", "io", "importer", "link", "sim", "realism", "slam", "localize", "plan", "inspect", "stack", "score", "render", "report", "monitor", "studies"},
}

STACK = ("slam", "localize", "plan", "inspect", "stack")  # folders of the robot's software
BLIND = STACK + ("score",)  # folders that never include the simulator
SIMULATOR = ("mujoco", "sim/", "render/", "embree")
GROUND_TRUTH = "core/ground_truth.h"

# Folders that still include each other in a cycle. Entries may only shrink; one that holds no cycle any more must go.
KNOWN_CYCLES = ()


def read_includes(source):
    """(file, included path) for every #include line below `source`; files relative to it, with slashes."""
    found = []
    for file in sorted(source.rglob("*")):
        if file.suffix in (".h", ".cc"):
            for match in re.finditer(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]', file.read_text(), re.M):
                found.append((file.relative_to(source).as_posix(), match.group(1)))
    return found


def is_below(file, folders):
    return any(file.startswith(folder + "/") for folder in folders)


def arrow_faults(includes):
    """Includes of a module that the including module may not use."""
    faults = []
    for file, included in includes:
        module, target = file.split("/")[0], included.split("/")[0]
        if target in MAY_USE and target != module and target not in MAY_USE.get(module, set()):
            faults.append(f"{file} includes {included}")
    return faults


def simulator_faults(includes):
    return [f"{file} includes {included}" for file, included in includes
            if is_below(file, BLIND) and included.startswith(SIMULATOR)]


def ground_truth_faults(includes):
    """Files of the robot's software that include the ground truth, themselves or through other headers."""
    headers = {}
    for file, included in includes:
        headers.setdefault(file, []).append(included)

    def reaches(file, seen):
        if file == GROUND_TRUTH:
            return True
        if file in seen:
            return False
        seen.add(file)
        return any(reaches(included, seen) for included in headers.get(file, ()))

    return [f"{file} reaches {GROUND_TRUTH}" for file in headers if is_below(file, STACK) and reaches(file, set())]


def folder_cycles(includes):
    """Sets of two or more folders that all include one another, directly or through others (strongly connected)."""
    def folder_of(path):
        return path.rpartition("/")[0]

    files = {file for file, _ in includes}
    folders = {folder_of(file) for file in files}
    reached = {folder: set() for folder in folders}
    for file, included in includes:
        if folder_of(included) in folders and folder_of(included) != folder_of(file):
            reached[folder_of(file)].add(folder_of(included))
    has_grown = True
    while has_grown:
        has_grown = False
        for folder, targets in reached.items():
            more = set().union(*(reached[target] for target in targets)) - targets
            has_grown |= bool(more)
            targets |= more
    cycles = {frozenset(other for other in folders if other in reached[folder] and folder in reached[other])
              for folder in folders}
    return sorted(sorted(cycle) for cycle in cycles if len(cycle) > 1)


def cycle_faults(includes, known=KNOWN_CYCLES):
    """Cycles that are not within a known one, and known ones that are no more."""
    cycles = folder_cycles(includes)
    faults = [f"{', '.join(cycle)} include each other in a cycle" for cycle in cycles
              if not any(set(cycle) <= allowed for allowed in known)]
    return faults + [f"{', '.join(sorted(allowed))}: no cycle any more: remove from KNOWN_CYCLES" for allowed in known
                     if not any(set(cycle) <= allowed for cycle in cycles)]


class Modules(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.includes = read_includes(SOURCE)

    def test_every_module_is_known(self):
        modules = {path.name for path in SOURCE.iterdir() if path.is_dir()}
        self.assertEqual(modules, set(MAY_USE))

    def test_the_top_level_holds_nothing_else(self):
        if not (SOURCE.parent / ".git").exists():
            self.skipTest("no checkout")
        git = ["git", "-C", SOURCE.parent]
        tracked = {name.partition("/")[0] for name in subprocess.check_output([*git, "ls-files"], text=True).split("\n")}
        self.assertEqual({name for name in tracked if name and not name.startswith(".")},
                         {"CMakeLists.txt", "CMakePresets.json", "README.md", "LICENSE", "CHANGELOG.md", "models", "src",
                          "worlds", "tests", "tools"})

    def test_includes_follow_the_arrows(self):
        self.assertEqual(arrow_faults(self.includes), [])

    def test_stack_and_evaluation_never_include_the_simulator(self):
        self.assertEqual(simulator_faults(self.includes), [])

    def test_stack_never_includes_the_ground_truth(self):
        self.assertEqual(ground_truth_faults(self.includes), [])

    def test_no_other_folders_include_each_other_in_a_cycle(self):
        self.assertEqual(cycle_faults(self.includes), [])

    def test_includes_were_found(self):
        self.assertGreater(len(self.includes), 50)
        for folder in ("slam", "localize", "plan", "inspect"):
            self.assertTrue(any(is_below(file, (folder,)) for file, _ in self.includes), folder)
        self.assertTrue(any(is_below(file, ("stack",)) for file, _ in self.includes))


class PlantedViolations(unittest.TestCase):
    """Each check finds a violation of its kind in a temporary tree, and nothing in a tree without one."""

    CLEAN = {
        "core/ground_truth.h": "#include <vector>\n",
        "core/time.h": "#include <chrono>\n",
        "slam/mapper.h": '#include "core/time.h"\n',
        "localize/filter.cc": '#include "slam/mapper.h"\n',
        "stack/robot_stack.cc": '#include "localize/filter.h"\n#include "plan/navigator.h"\n',
        "app/run/run_loop.cc": '#include "sim/simulator.h"\n#include "core/ground_truth.h"\n',
        "sim/simulator.h": '#include <mujoco/mujoco.h>\n#include "core/ground_truth.h"\n',
        "score/pose_error.h": '#include "core/ground_truth.h"\n',
    }

    def includes_with(self, planted):
        with tempfile.TemporaryDirectory() as folder:
            source = pathlib.Path(folder)
            for name, text in (self.CLEAN | planted).items():
                (source / name).parent.mkdir(parents=True, exist_ok=True)
                (source / name).write_text(text)
            return read_includes(source)

    def faults(self, planted):
        includes = self.includes_with(planted)
        return {"arrow": arrow_faults(includes), "simulator": simulator_faults(includes),
                "ground truth": ground_truth_faults(includes), "cycle": cycle_faults(includes, known=())}

    def assert_caught(self, kinds, file, text):
        for kind, faults in self.faults({file: text}).items():
            self.assertEqual(bool(faults), kind in kinds, f"{kind}: {faults}")
            for fault in faults:
                self.assertIn(file.rpartition("/")[0] if kind == "cycle" else file, fault)

    def test_a_clean_tree_has_no_faults(self):
        self.assert_caught((), "core/time.h", "#include <chrono>\n")

    def test_a_module_arrow(self):
        self.assert_caught(("arrow",), "core/frames.h", '#include "slam/submaps/ndt.h"\n')
        self.assert_caught(("arrow",), "slam/grid.cc", '# include "plan/costs.h"\n')
        self.assert_caught(("arrow",), "inspect/grid.cc", '#include "stack/robot_stack.h"\n')
        self.assert_caught(("arrow",), "stack/tour.cc", '#include "app/scenario/scenario.h"\n')

    def test_the_simulator_in_the_robots_software_and_the_evaluation(self):
        for folder in BLIND:
            for header in ("mujoco/mujoco.h", "embree3/rtcore.h"):
                self.assert_caught(("simulator",), f"{folder}/planted.h", f"  #include <{header}>\n")
            for header in ("sim/sensors/lidar.h", "render/picture.h"):
                self.assert_caught(("simulator", "arrow"), f"{folder}/deep/planted.cc", f'#include "{header}"\n')

    def test_the_ground_truth_in_the_robots_software(self):
        for folder in STACK:
            self.assert_caught(("ground truth",), f"{folder}/planted.cc", '#include "core/ground_truth.h"\n')

    def test_the_ground_truth_through_another_header(self):
        planted = {"core/sample.h": '#include "core/ground_truth.h"\n',
                   "stack/planted.cc": '#include "core/sample.h"\n'}
        self.assertEqual(self.faults(planted)["ground truth"], ["stack/planted.cc reaches core/ground_truth.h"])

    def test_a_cycle_of_two_folders_of_three_and_of_a_folder_with_a_subfolder(self):
        two = {"app/run/a.h": '#include "app/scoring/b.h"\n', "app/scoring/b.h": '#include "app/run/run_loop.h"\n'}
        three = {"app/x/a.h": '#include "app/y/a.h"\n', "app/y/a.h": '#include "app/z/a.h"\n',
                 "app/z/a.h": '#include "app/x/b.h"\n'}
        parent = {"slam/grid.cc": '#include "slam/graph/pyramid.h"\n',
                  "slam/graph/pyramid.h": '#include "slam/mapper.h"\n'}
        for planted, cycle in ((two, ["app/run", "app/scoring"]), (three, ["app/x", "app/y", "app/z"]),
                               (parent, ["slam", "slam/graph"])):
            includes = self.includes_with(planted)
            self.assertEqual(folder_cycles(includes), [cycle])
            self.assertEqual(len(cycle_faults(includes, known=())), 1)
            self.assertEqual(cycle_faults(includes, known=(set(cycle) | {"app/other"},)), [])

    def test_a_known_cycle_that_is_no_more(self):
        faults = cycle_faults(self.includes_with({}), known=({"app", "app/run"},))
        self.assertEqual(faults, ["app, app/run: no cycle any more: remove from KNOWN_CYCLES"])


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v"])
