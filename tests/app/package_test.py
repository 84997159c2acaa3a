#!/usr/bin/env python3
"""The Debian package: what it needs and contains, and that the program runs from its unpacked tree in any directory.

usage: package_test.py BUILD_DIR
"""
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

BUILD = pathlib.Path(sys.argv[1]).resolve()


def output(*words, **options):
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True, **options)
    if done.returncode != 0:
        raise AssertionError(f"{words}: {done.stdout}{done.stderr}")
    return done.stdout


class Package(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = pathlib.Path(temporary.name)
        output("cpack", "-G", "DEB", "--config", BUILD / "CPackConfig.cmake", "-B", cls.folder / "package")
        packages = list((cls.folder / "package").glob("*.deb"))
        assert len(packages) == 1, packages
        cls.package, cls.root = packages[0], cls.folder / "root"
        output("dpkg-deb", "-x", cls.package, cls.root)

    def field(self, name):
        return output("dpkg-deb", "-f", self.package, name).strip()

    def call(self, *words):
        """Runs the unpacked program in an empty directory, without hints where its data is."""
        elsewhere = self.folder / "elsewhere"
        elsewhere.mkdir(exist_ok=True)
        environment = {key: value for key, value in os.environ.items() if key != "PATROL_DATA"}
        return output(self.root / "usr/bin/patrol", *words, cwd=elsewhere, env=environment, timeout=300)

    def test_its_fields_are_those_of_the_program(self):
        version = self.call("--version").strip()
        self.assertEqual((self.field("Package"), self.field("Version")), ("patrol", version))
        self.assertRegex(self.package.name, re.escape(f"patrol_{version}_") + r"\w+\.deb")
        needed = self.field("Depends")
        for package in ("libc6", "libembree3-3", "libavcodec59", "libosmesa6", "fonts-dejavu-core"):
            self.assertIn(package, needed)
        self.assertNotIn("mujoco", needed)

    def test_it_contains_program_library_data_and_licenses_only(self):
        listed = {str(file.relative_to(self.root)) for file in self.root.rglob("*") if file.is_file()}
        others = [name for name in listed if not re.match(r"usr/(bin/patrol$|lib/patrol/libmujoco\.so\.|share/patrol/(models|worlds)/|share/doc/patrol/|"
                                                           r"share/bash-completion/completions/patrol$|share/zsh/vendor-completions/_patrol$|share/man/man1/patrol\.1$)", name)]
        self.assertEqual(others, [])
        self.assertLessEqual({"usr/share/doc/patrol/copyright", "usr/share/doc/patrol/THIRD_PARTY.md",
                              "usr/share/patrol/worlds/street/scenarios/short.yaml"}, listed)

    def test_a_scenario_by_its_name_runs_in_any_directory_with_results_there(self):
        self.call("run", "street/short", "--out", "short")
        metrics = json.loads((self.folder / "elsewhere/short/metrics.json").read_text())
        self.assertEqual(metrics["mission"]["collisions"], 0)
        self.assertIn("worlds/street/scenarios/short.yaml", self.call("list"))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v"])
