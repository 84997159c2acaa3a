#!/usr/bin/env python3
"""Links and images of every Markdown document lead to files and headings that exist, and comments of the source to
files; the top README stays short.

usage: documents_test.py SOURCE_DIR
"""
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

LINK = re.compile(r"!?\[[^\]]*\]\(([^)\s]+)\)")
MAX_README_LINES = 150
SYSTEM_HEADERS = {"sysexits.h"}


def documents(root):
    """Markdown files that git tracks or would track; all of them outside a checkout."""
    listed = subprocess.run(["git", "-C", str(root), "ls-files", "--cached", "--others", "--exclude-standard", "*.md"],
                            capture_output=True, text=True)
    if listed.returncode == 0:
        return [root / name for name in sorted(set(listed.stdout.splitlines())) if (root / name).exists()]
    return sorted(root.rglob("*.md"))


def without_code(text):
    return re.sub(r"`[^`\n]*`", "", re.sub(r"^```.*?^```", "", text, flags=re.M | re.S))


def anchors(document):
    """The anchors of a document's headings, formed as GitHub does."""
    text = re.sub(r"^```.*?^```", "", document.read_text(), flags=re.M | re.S)
    headings = re.findall(r"^#+ +(.+?) *$", text, re.M)
    plain = [re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading).lower() for heading in headings]
    return {re.sub(r"[^\w\- ]", "", heading).replace(" ", "-") for heading in plain}


def broken_links(root):
    """One line for each link that leads nowhere."""
    broken = []
    for document in documents(root):
        for target in LINK.findall(without_code(document.read_text())):
            if re.match(r"[a-z]+:", target):
                continue
            path, _, anchor = target.partition("#")
            file = (document.parent / path).resolve() if path else document
            if not file.exists():
                broken.append(f"{document.relative_to(root)}: {target}: no such file")
            elif anchor and (file.suffix != ".md" or anchor not in anchors(file)):
                broken.append(f"{document.relative_to(root)}: {target}: no such heading")
    return broken


def broken_references(root):
    """One line for each file of C++ that a comment of the source names and that does not exist."""
    files = [file.relative_to(root).as_posix() for folder in ("src", "tests") for file in (root / folder).rglob("*.*")]
    broken = []
    for name in files:
        if not name.startswith("src/") or not name.endswith((".h", ".cc")):
            continue
        for number, line in enumerate((root / name).read_text().splitlines(), 1):
            comment = re.search(r"//(.*)", line)
            for reference in re.findall(r"\b[\w/]+\.(?:h|cc)\b", comment[1] if comment else ""):
                if reference not in SYSTEM_HEADERS and not any(f"/{file}".endswith(f"/{reference}") for file in files):
                    broken.append(f"{name}:{number}: {reference}: no such file")
    return broken


class Documents(unittest.TestCase):
    def setUp(self):
        self.root = pathlib.Path(SOURCE_DIR).resolve()

    def test_every_link_leads_to_a_file_and_heading(self):
        self.assertEqual(broken_links(self.root), [])

    def test_comments_name_files_that_exist(self):
        self.assertEqual(broken_references(self.root), [])

    def test_documents_were_found(self):
        self.assertGreater(len(documents(self.root)), 8)

    def test_the_readme_has_at_most_150_lines(self):
        self.assertLessEqual(len((self.root / "README.md").read_text().splitlines()), MAX_README_LINES)


class PlantedFaults(unittest.TestCase):
    def broken(self, text):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder).resolve()
            (root / "there.md").write_text("# A heading, with (signs)\n")
            (root / "page.md").write_text(text)
            return broken_links(root)

    def test_good_links_pass(self):
        self.assertEqual(self.broken("[a](there.md) [b](there.md#a-heading-with-signs) `[c](not_a_link)`\n"), [])

    def test_a_missing_file_is_found(self):
        self.assertEqual(self.broken("[a](gone.md)\n"), ["page.md: gone.md: no such file"])

    def test_a_missing_heading_is_found(self):
        self.assertEqual(self.broken("[a](there.md#gone)\n"), ["page.md: there.md#gone: no such heading"])

    def test_a_comment_that_names_a_missing_file_is_found(self):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder).resolve()
            (root / "src/core").mkdir(parents=True)
            (root / "src/core/time.h").write_text("int a = 0;  ///< see core/time.h and core/tide.h\n#include <a.h>\n")
            self.assertEqual(broken_references(root), ["src/core/time.h:1: core/tide.h: no such file"])


if __name__ == "__main__":
    SOURCE_DIR = sys.argv[1]
    unittest.main(argv=[sys.argv[0], "-v"])
