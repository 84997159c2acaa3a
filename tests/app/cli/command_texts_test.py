#!/usr/bin/env python3
"""`patrol print`: completion scripts that shells accept, and a manual page without warnings; all commands are in each.

usage: command_texts_test.py PATROL
"""
import functools
import re
import shutil
import subprocess
import sys
import unittest

PATROL = sys.argv[1]


@functools.cache
def printed(text):
    return subprocess.run([PATROL, "print", text], capture_output=True, text=True, check=True).stdout


@functools.cache
def commands():
    """{command or alias: its options} by --help."""
    listed = subprocess.run([PATROL, "--help"], capture_output=True, text=True, check=True).stdout.split("Subcommands:")[1]
    names = [name for line in re.findall(r"^  ([a-z-]+(?:, [a-z-]+)*)", listed, re.MULTILINE) for name in line.split(", ")]
    helps = {name: subprocess.run([PATROL, name, "--help"], capture_output=True, text=True, check=True).stdout for name in names}
    return {name: set(re.findall(r"(?<![\w-])(--[a-z0-9-]+)", "".join(line[:30] for line in text.splitlines(True)))) for name, text in helps.items()}


class Texts(unittest.TestCase):
    def completed(self, *words):
        """What bash offers after these words."""
        script = (printed("bash-completion") + f"COMP_WORDS=({' '.join(repr(word) for word in words)}); COMP_CWORD={len(words) - 1}; _patrol; "
                  "printf '%s\\n' \"${COMPREPLY[@]}\"")
        done = subprocess.run(["bash", "-euc", script], capture_output=True, text=True)
        self.assertEqual(done.stderr, "")
        return set(done.stdout.split())

    def test_bash_completes_every_command_and_its_options(self):
        self.assertEqual(self.completed("patrol", ""), set(commands()) | {"--help", "--version"})
        self.assertEqual(self.completed("patrol", "sl"), {"slam"})
        for command, options in commands().items():
            self.assertEqual(self.completed("patrol", command, "--"), options, command)

    def test_bash_completes_values_of_a_list(self):
        self.assertEqual(self.completed("patrol", "import", ""), {"robot", "site"})
        self.assertEqual(self.completed("patrol", "import", "robot", "--drive", "m"), {"mecanum"})
        self.assertEqual(self.completed("patrol", "import", "robot", "--forward", "-"), {"-x", "-y"})

    def test_zsh_accepts_its_script_and_it_names_every_option(self):
        script = printed("zsh-completion")
        for command, options in commands().items():
            self.assertIn(f"'{command}:", script)
            for option in options:
                self.assertIn(f"{option}[", script)
        self.assertIn(":value:(differential ackermann mecanum legs)'", script)
        self.assertIn("'1:value:(robot site)'", script)
        if shutil.which("zsh"):
            self.assertEqual(subprocess.run(["zsh", "-n"], input=script, capture_output=True, text=True).stderr, "")

    def test_the_manual_page_has_every_command_and_option_and_no_warning(self):
        page = printed("man-page")
        for command, options in commands().items():
            name = command.replace("-", "\\-")
            self.assertTrue(f".SS patrol {name}" in page or f" Alias: {name}." in page, command)
            for option in options:
                self.assertIn(option.replace("-", "\\-"), page)
        if shutil.which("groff"):
            done = subprocess.run(["groff", "-man", "-Tutf8", "-ww", "-z"], input=page, capture_output=True, text=True)
            self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_another_text_is_refused(self):
        done = subprocess.run([PATROL, "print", "poem"], capture_output=True, text=True)
        self.assertEqual((done.returncode, len(done.stderr.splitlines())), (2, 1))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v"])
