"""The installed package: another project configures, builds and runs against a fresh prefix, and a missing component is refused.

Usage: package_test.py CMAKE BUILD CONSUMER
"""

import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

CMAKE, BUILD, CONSUMER = sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3])


def run(*words):
    return subprocess.run([str(word) for word in words], capture_output=True, text=True)


class Package(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.root = pathlib.Path(cls.folder.name)
        for component in ("core", "slam"):
            done = run(CMAKE, "--install", BUILD, "--prefix", cls.root / "prefix", "--component", component)
            assert done.returncode == 0, done.stderr

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def configure(self, source, build):
        return run(CMAKE, "-G", "Ninja", "-S", source, "-B", build, f"-DCMAKE_PREFIX_PATH={self.root / 'prefix'}")

    def test_a_program_links_to_the_slam_component(self):
        build = self.root / "build"
        configured = self.configure(CONSUMER, build)
        self.assertEqual(configured.returncode, 0, configured.stderr)
        built = run(CMAKE, "--build", build)
        self.assertEqual(built.returncode, 0, built.stdout)
        self.assertEqual(run(build / "consumer").stdout, "known\n")

    def test_a_component_that_is_not_installed_is_refused_by_name(self):
        source = self.root / "missing"
        source.mkdir()
        source.joinpath("CMakeLists.txt").write_text(
            "cmake_minimum_required(VERSION 3.25)\nproject(missing LANGUAGES CXX)\n"
            "find_package(patrol REQUIRED COMPONENTS localize)\n"
        )
        configured = self.configure(source, self.root / "missing_build")
        self.assertNotEqual(configured.returncode, 0)
        self.assertIn("localize", configured.stderr)

    def test_the_prefix_names_nothing_of_the_source_tree(self):
        source = re.compile(r"(?<![\w.}])" + re.escape(str(CONSUMER.parents[2])))  # not in lib/cmake/patrol
        for file in (self.root / "prefix").rglob("*.cmake"):
            self.assertNotRegex(file.read_text(), source, file)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
