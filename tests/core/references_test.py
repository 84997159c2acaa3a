#!/usr/bin/env python3
"""Every reference key used in src is listed in src/REFERENCES.md, and every listed key is used.

usage: references_test.py SOURCE_DIR
"""
import pathlib
import re
import sys
import unittest

SOURCE = pathlib.Path(sys.argv[1]) / "src"
KEY = re.compile(r"\[([A-Z][A-Za-z]+\d{2}[a-z]?)(?:[,;\]])")
FIRST_CELL = re.compile(r"^\| \[([A-Za-z]+\d{2}[a-z]?)\] \|", re.M)


def keys_used():
    """{key: first file that uses it} over the sources and documents of src."""
    used = {}
    for file in sorted(SOURCE.rglob("*")):
        if file.suffix not in (".h", ".cc", ".md", ".js") or file.name == "REFERENCES.md":
            continue
        for key in KEY.findall(file.read_text()):
            used.setdefault(key, file.relative_to(SOURCE))
    return used


class References(unittest.TestCase):
    def setUp(self):
        self.listed = FIRST_CELL.findall((SOURCE / "REFERENCES.md").read_text())

    def test_every_key_used_is_listed(self):
        missing = {key: str(file) for key, file in keys_used().items() if key not in self.listed}
        self.assertEqual(missing, {})

    def test_every_listed_key_is_used(self):
        self.assertEqual(sorted(set(self.listed) - set(keys_used())), [])

    def test_no_key_is_listed_twice(self):
        self.assertEqual(len(self.listed), len(set(self.listed)))

    def test_papers_are_cited_by_key(self):
        numbered = [str(file.relative_to(SOURCE)) for file in SOURCE.rglob("*")
                    if file.suffix in (".h", ".cc", ".md", ".js") and re.search(r"[Pp]apers? 00\d", file.read_text())]
        self.assertEqual(numbered, [])


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v"])
