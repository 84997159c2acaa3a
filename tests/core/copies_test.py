#!/usr/bin/env python3
"""Shared parts exist once: finds second implementations of what core has.

usage: copies_test.py SOURCE_DIR
"""
import pathlib
import re
import sys
import unittest

ROOT = pathlib.Path(sys.argv[1])

# What a copy looks like, and the only file that may look so.
PATTERNS = {
    "degree conversion": (r"(?:\bpi\b|\bM_PI\b|\bkPi\b|3\.14159\d+) */ *180\b|\b180\.0 */ *(?:std::numbers::)?(?:pi\b|M_PI)", "src/core/geometry/angles.h"),
    "systematic resampling": (r"(?m)^std::vector<(?!Offspring>)[\w:]+> \w*systematic\w*\([^;{]*\) *\{", "src/core/particle_weights.cc"),
    "convex hull": (r"\b\w*hull\(std::vector<Eigen::Vector2d>[^;{]*\) *\{", "src/core/geometry/convex_polygon.cc"),
    "distance transform": (r"class \w*(?:DistanceTransform|LineTransform|LowerEnvelope)\b|double intersection\(", "src/core/geometry/distance_transform."),
}


def copies(text_of, what):
    """Files, other than the one allowed, in which the pattern occurs."""
    pattern, allowed = PATTERNS[what]
    return [path for path, text in text_of.items() if not path.startswith(allowed) and re.search(pattern, text)]


def sources():
    files = [file for folder in ("src", "tests") for file in (ROOT / folder).rglob("*") if file.suffix in (".h", ".cc")]
    return {file.relative_to(ROOT).as_posix(): file.read_text() for file in sorted(files)}


class Copies(unittest.TestCase):
    def test_shared_parts_exist_once(self):
        text_of = sources()
        self.assertGreater(len(text_of), 100)
        for what in PATTERNS:
            self.assertEqual(copies(text_of, what), [], what)

    def test_the_patterns_match_where_the_parts_are(self):
        text_of = sources()
        for what, (pattern, allowed) in PATTERNS.items():
            self.assertTrue(any(re.search(pattern, text) for path, text in text_of.items() if path.startswith(allowed)), what)

    def test_planted_copies_are_found(self):
        planted = {
            "degree conversion": "constexpr double kDegree = std::numbers::pi / 180.0;",
            "systematic resampling": "std::vector<int> resample_systematic(const std::vector<double>& weights) {",
            "convex hull": "std::vector<Eigen::Vector2d> convex_hull(std::vector<Eigen::Vector2d> points) {",
            "distance transform": "class LineTransform {",
        }
        for what, line in planted.items():
            self.assertEqual(copies({"src/a.cc": line, PATTERNS[what][1] + "x": line}, what), ["src/a.cc"], what)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v"])
