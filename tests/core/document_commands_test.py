#!/usr/bin/env python3
"""The commands of the documents run, and their YAML is valid.

usage: document_commands_test.py PATROL SOURCE_DIR [DOCUMENT]...    tests; documents relative to SOURCE_DIR, default all
       document_commands_test.py PATROL SOURCE_DIR --run-long FILE  runs the long commands; writes documents, exit codes and minutes as JSON

Code fences of a document:
  sh         runs from top to bottom in one shell with `set -e`, in a copy of the source tree
  sh long    takes a minute or more: its options are checked; --run-long runs the long fences of each document from top to bottom
  sh manual  needs what the test does not have (nothing built yet, a cluster, the whole machine): its options are checked
  yaml       part of a scenario: loads without an error
  yaml ROBOT part of models/ROBOT/ROBOT.yaml: the robot loads with these values in place of its own
  yml        a file of another program: parses
"""
import json
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import time
import unittest

import yaml

from documents_test import documents

FENCE = re.compile(r"^```([^\n]*)\n(.*?)^```", re.M | re.S)
ROBOTS = ("wheeled",)  # whose files the documents show
KNOWN = {"sh", "sh long", "sh manual", "yaml", *(f"yaml {robot}" for robot in ROBOTS), "yml", "cpp", "python", "xml", "json", "cmake", ""}


def fences(document):
    """(info, text) of the code fences."""
    return [(match[1].strip(), match[2]) for match in FENCE.finditer(document.read_text())]


def commands(text):
    """Commands of a shell text: lines joined at a backslash, without comments and without the content of a here-document."""
    text = re.sub(r"<<'END'\n.*?^END$", "", text, flags=re.M | re.S).replace("\\\n", " ")
    return [line for line in (re.sub(r"(^|\s)#.*", "", line).strip() for line in text.splitlines()) if line]


def patrol_calls(text):
    """Words of every call of the program."""
    calls = []
    for line in commands(text):
        words = shlex.split(line)
        for at, word in enumerate(words):
            if word in ("patrol", "build/patrol") and at + 1 < len(words):
                end = next((i for i in range(at, len(words)) if words[i] in ("|", "||", "&&", ";") or words[i].endswith(";")), len(words))
                calls.append(words[at + 1:end])
    return calls


def unknown_options(text, reference):
    """Options and commands that the program does not have."""
    known = {name: {option["name"] for option in command["options"]} for command in reference["commands"]
             for name in [command["name"], *command["aliases"]]}
    found = []
    for command, *words in patrol_calls(text):
        if command not in known:
            found.append(f"patrol {command}: no such command")
        else:
            found += [f"patrol {command} {word}: no such option" for word in words
                      if word.startswith("--") and word.split("=")[0] not in known[command] | {"--help"}]
    return found


def copy_of(source, folder):
    """Working folder with links to what the commands read; what they write stays in it."""
    for name in ("build", "src", "tests", "tools", ".deps", "CMakeLists.txt", "CMakePresets.json"):
        if (source / name).exists():
            (folder / name).symlink_to(source / name)
    shutil.copytree(source / "models", folder / "models")  # a command trains a model
    (folder / "worlds").mkdir()  # a command imports sites
    for entry in (source / "worlds").iterdir():
        (folder / "worlds" / entry.name).symlink_to(entry)
    return folder


def merged(base, changes):
    """The mapping with the values of another; sections are merged key by key."""
    if not isinstance(base, dict) or not isinstance(changes, dict):
        return changes
    return base | {key: merged(base.get(key), value) for key, value in changes.items()}


def run_shell(text, folder):
    """Exit code and end of the output of a shell text."""
    # python3 is that of the tests, and finds the client of the turn protocol.
    environment = dict(os.environ, PATH=f"{pathlib.Path(sys.executable).parent}:{os.environ['PATH']}",
                       PYTHONPATH=str(SOURCE / "src/link/python"))
    done = subprocess.run(["bash", "-euo", "pipefail", "-c", text], cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, env=environment)
    return done.returncode, done.stdout[-2000:]


def run_long(file):
    """Runs all fences of every document with long ones, from top to bottom."""
    rows = []
    for document in DOCUMENTS:
        if not any(info == "sh long" for info, _ in fences(document)):
            continue
        text = "\n".join(text for info, text in fences(document) if info in ("sh", "sh long"))
        with tempfile.TemporaryDirectory() as folder:
            begin = time.monotonic()
            code, said = run_shell(text, copy_of(SOURCE, pathlib.Path(folder)))
            rows.append({"document": str(document.relative_to(SOURCE)), "code": code, "minutes": (time.monotonic() - begin) / 60})
            print(f"{rows[-1]['document']}: exit code {code}, {rows[-1]['minutes']:.1f} min", *([said] if code else []), sep="\n", flush=True)
    pathlib.Path(file).write_text(json.dumps(rows, indent=1))


class Commands(unittest.TestCase):
    def test_every_fence_has_a_known_language(self):
        for document in DOCUMENTS:
            for info, _ in fences(document):
                self.assertIn(info, KNOWN, document)

    def test_every_option_exists(self):
        found = [f"{document.relative_to(SOURCE)}: {line}" for document in DOCUMENTS for info, text in fences(document)
                 if info.startswith("sh") for line in unknown_options(text, REFERENCE)]
        self.assertEqual(found, [])

    def test_commands_run(self):
        for document in DOCUMENTS:
            text = "\n".join(text for info, text in fences(document) if info == "sh")
            if not text:
                continue
            with self.subTest(document=str(document.relative_to(SOURCE))), tempfile.TemporaryDirectory() as folder:
                code, said = run_shell(text, copy_of(SOURCE, pathlib.Path(folder)))
                self.assertEqual(code, 0, said)

    def test_yaml_of_scenarios_is_valid(self):
        for document in DOCUMENTS:
            for info, text in fences(document):
                if info != "yaml":
                    continue
                with self.subTest(document=str(document.relative_to(SOURCE))), tempfile.TemporaryDirectory() as folder:
                    scenario = copy_of(SOURCE, pathlib.Path(folder)) / "part.yaml"
                    for key, value in (("version", "2"), ("world", "street"), ("mission", "routes/short.json")):
                        if not re.search(rf"^({key}|tour):", text, re.M):
                            text = f"{key}: {value}\n{text}"
                    scenario.write_text(text)
                    done = subprocess.run([PATROL, "run", scenario, "--set", "time_limit_s=0.2", "--out", "out"], cwd=folder, capture_output=True, text=True)
                    self.assertNotIn(done.returncode, (2, 3), done.stderr)

    def test_yaml_of_robots_is_valid(self):
        for document in DOCUMENTS:
            for info, text in fences(document):
                for robot in ROBOTS:
                    if info != f"yaml {robot}":
                        continue
                    with self.subTest(document=str(document.relative_to(SOURCE))), tempfile.TemporaryDirectory() as folder:
                        file = copy_of(SOURCE, pathlib.Path(folder)) / f"models/{robot}/{robot}.yaml"
                        file.write_text(yaml.safe_dump(merged(yaml.safe_load(file.read_text()), yaml.safe_load(text))))
                        command = [PATROL, "run", "substation/patrol", "--robot", robot, "--set", "time_limit_s=0.2", "--out", "out"]
                        done = subprocess.run(command, cwd=folder, env=dict(os.environ, PATROL_DATA=folder), capture_output=True, text=True)
                        self.assertNotIn(done.returncode, (2, 3), done.stderr)

    def test_yaml_of_other_programs_parses(self):
        for document in DOCUMENTS:
            for info, text in fences(document):
                if info == "yml":
                    self.assertIsInstance(yaml.safe_load(text), dict, document)


class PlantedFaults(unittest.TestCase):
    def test_an_unknown_option_is_found(self):
        self.assertEqual(unknown_options("patrol run street/short --sedd 1 | cat --all", REFERENCE), ["patrol run --sedd: no such option"])
        self.assertEqual(unknown_options("build/patrol runn street/short", REFERENCE), ["patrol runn: no such command"])
        self.assertEqual(unknown_options("patrol run street/short --seed 1 \\\n  --out out  # comment --bad", REFERENCE), [])


def main():
    global PATROL, SOURCE, DOCUMENTS, REFERENCE
    PATROL, SOURCE = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    DOCUMENTS = documents(SOURCE)
    if sys.argv[3:4] == ["--run-long"]:
        run_long(sys.argv[4])
        return
    if sys.argv[3:]:
        DOCUMENTS = [SOURCE / name for name in sys.argv[3:]]
    REFERENCE = json.loads(subprocess.run([PATROL, "print", "reference"], check=True, capture_output=True, text=True).stdout)
    unittest.main(argv=[sys.argv[0], "-v"])


if __name__ == "__main__":
    main()
