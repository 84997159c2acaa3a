#!/usr/bin/env python3
"""No sentence of a document has more than 30 words, and no document has a retired word.

usage: readability_test.py SOURCE_DIR           tests
       readability_test.py SOURCE_DIR --list    prints the findings
"""
import pathlib
import re
import sys
import unittest

import retired_words_test
from documents_test import documents
from retired_words_test import IN_TEXT

MAX_WORDS = 30
RETIRED = {word: IN_TEXT[word] for word, row in retired_words_test.RETIRED.items() if "texts" in row[1]}


def blocks(text):
    """Paragraphs, list items, headings and table cells, without code and comments."""
    text = re.sub(r"^(`{3,})[^\n]*\n.*?^\1", "\n", text, flags=re.M | re.S)
    text = re.sub(r"^<!-- results: .*?^<!-- end of results: [^\n]*$", "\n", text, flags=re.M | re.S)  # what commands printed
    text = re.sub(r"<!--.*?-->", "\n", text, flags=re.S)
    for block in re.split(r"\n\s*\n|\n(?=\s*(?:[-*]|\d+\.) )|\n(?=[|#])", text):
        if re.match(r"\s*\| \[\w+\d\d\w?\] \|", block):
            continue  # authors and title of a source
        if block.lstrip().startswith("|"):
            yield from re.split(r"(?<!\\)\|", block)
        else:
            yield block


def plain(block):
    block = re.sub(r"`[^`]*`", "CODE", block)
    block = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", block)
    block = re.sub(r"\[[A-Z]\w+\d\d[^\]]*\]", "", block)  # a reference: [Liu21, table 2]
    return re.sub(r"\s+", " ", re.sub(r"^\s*(?:[-*#>]+|\d+\.)\s", "", block)).strip()


def sentences(block):
    return re.split(r"(?<=[.!?])[)*\"]*\s+(?=[A-Z0-9`\"(*])", plain(block))


def words(sentence):
    return [word for word in sentence.split() if re.search(r"\w", word)]


def findings(text):
    """One line for each sentence that is too long and each retired word."""
    found = []
    for block in blocks(text):
        for sentence in sentences(block):
            if len(words(sentence)) > MAX_WORDS:
                found.append(f"{len(words(sentence))} words: {sentence}")
            found += [f"retired word '{word}': {sentence}" for word, pattern in RETIRED.items() if pattern.search(sentence.lower())]
    return found


class Readability(unittest.TestCase):
    def test_sentences_are_short_and_words_are_the_fields(self):
        found = [f"{document.relative_to(ROOT)}: {line}" for document in documents(ROOT) for line in findings(document.read_text())]
        self.assertEqual(found, [])


class PlantedFaults(unittest.TestCase):
    def test_a_long_sentence_is_found_in_a_paragraph_and_in_a_table(self):
        long = " ".join(["word"] * 31) + "."
        self.assertEqual(len(findings(long)), 1)
        self.assertEqual(len(findings(f"| a | b |\n| --- | --- |\n| {long} | short |\n")), 1)
        self.assertEqual(findings(" ".join(["word"] * 30) + ". Then " + " ".join(["word"] * 29) + "."), [])

    def test_code_and_addresses_do_not_count(self):
        self.assertEqual(findings("```sh\n" + "word " * 40 + "\n```\n"), [])
        self.assertEqual(findings("`" + "word " * 40 + "` [text](a/b/c/d)"), [])

    def test_a_retired_word_is_found(self):
        self.assertEqual(len(findings("The judge sees it.")), 1)


if __name__ == "__main__":
    ROOT = pathlib.Path(sys.argv[1]).resolve()
    if "--list" in sys.argv:
        for document in documents(ROOT):
            for line in findings(document.read_text()):
                print(f"{document.relative_to(ROOT)}: {line}")
    else:
        unittest.main(argv=[sys.argv[0], "-v"])
