#!/usr/bin/env python3
"""The reference pages are those of the program, and they list every key of scenario.yaml with a meaning.

usage: reference_test.py PATROL SOURCE_DIR RUN_DIR
"""
import importlib.machinery
import importlib.util
import json
import pathlib
import re
import subprocess
import sys
import unittest

import yaml

PATROL, SOURCE, RUN = (pathlib.Path(argument).resolve() for argument in sys.argv[1:4])
# Words that begin a clause or refer to a neighbor, but not a noun phrase.
NO_NOUN = {"above", "after", "and", "as", "at", "before", "below", "by", "default", "false", "for", "from", "if", "in", "is", "likewise", "of", "on", "only",
           "or", "over", "same", "see", "true", "under", "until", "when", "with"}


def reference_tool():
    loader = importlib.machinery.SourceFileLoader("reference_tool", str(SOURCE / "tools/reference"))
    tool = importlib.util.module_from_spec(importlib.util.spec_from_loader("reference_tool", loader))
    sys.dont_write_bytecode = True
    loader.exec_module(tool)
    return tool


def keys_of(value, path=""):
    """Paths of a YAML document; entries of a list are []."""
    if isinstance(value, dict):
        return {found for key, child in value.items() for found in keys_of(child, f"{path}.{key}" if path else key)} | ({path} - {""})
    if isinstance(value, list):
        return {found for child in value if isinstance(child, dict) for found in keys_of(child, path + "[]")} - {path + "[]"} | {path}
    return {path}


class Reference(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        printed = subprocess.run([PATROL, "print", "reference"], check=True, capture_output=True, text=True).stdout
        cls.reference = json.loads(printed)
        cls.tool = reference_tool()

    def test_the_pages_are_those_of_the_program(self):
        done = subprocess.run([SOURCE / "tools/reference", "--check", "--program", PATROL], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_every_key_of_a_scenario_is_listed(self):
        scenario = yaml.safe_load((RUN / "scenario.yaml").read_text())
        expected = {key for key in keys_of(scenario) if not key.startswith("expect.")}
        listed = {setting["path"] for setting in self.reference["settings"]}
        self.assertGreater(len(expected), 800)
        self.assertEqual(sorted(expected - listed), [])

    def test_no_section_has_an_empty_description(self):
        pages = self.tool.settings_pages(self.reference["settings"], self.tool.Comments())
        bare = [part.splitlines()[0] for text in pages.values() for part in text.split("\n## ")[1:] if "\n.\n" in part]
        self.assertEqual(bare, [])

    def test_units_by_the_end_of_a_name(self):
        units = {key: self.tool.unit_of(key) for key in ("rate_g_s", "start_s")}
        self.assertEqual(units, {"rate_g_s": "g/s", "start_s": "s"})

    def test_every_key_has_a_meaning_that_is_a_noun_phrase(self):
        comments = self.tool.Comments()
        bad = []
        for setting in self.reference["settings"]:
            meaning = comments.of(setting["owner"], setting["path"].rpartition(".")[2])
            is_section = setting["type"] == "section" or (setting["type"] == "list" and not setting["default"])
            if is_section and not meaning:
                continue  # the documentation of the struct
            words = re.findall(r"[\w'-]+", meaning)
            if len(words) < 2 or words[0].lower() in NO_NOUN or meaning[0].isdigit():
                bad.append(f"{setting['path']}: {meaning}")
        self.assertEqual(bad, [])

    def test_every_key_stands_on_a_page(self):
        text = "".join(file.read_text() for file in (SOURCE / "src/app/reference").glob("settings_*.md"))
        headings = set(re.findall(r"^## (.*)$", text, re.M))
        for setting in self.reference["settings"]:
            section, _, key = setting["path"].rpartition(".")
            self.assertIn(section or "A scenario", headings)
            self.assertRegex(text, rf"\| \[?`{re.escape(key)}`")

    def test_units_are_those_of_the_names(self):
        for key, unit in {"range_noise_std_m": "m", "rate_hz": "Hz", "gyro_bias_std_radps": "rad/s", "odometry_std_rad_per_m": "rad/m", "column_ppm_m": "ppm m",
                          "position_random_walk_m_per_sqrt_m": "m/√m", "beams": ""}.items():
            self.assertEqual(self.tool.unit_of(key), unit, key)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v"])
