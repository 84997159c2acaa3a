#!/usr/bin/env python3
"""Every results table of the documentation is that of its record, and names commit, date, seeds and command; tools/results makes,
skips and continues tables as its usage says.

usage: results_test.py SOURCE_DIR
"""
import importlib
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(sys.argv[1]).resolve()
sys.dont_write_bytecode = True
sys.path.insert(0, str(SOURCE / "tools"))
import results_blocks as blocks  # noqa: E402
import results_tables as tables  # noqa: E402

MANIFEST = """
import dataclasses, typing
@dataclasses.dataclass
class Step:
    key: str
    command: list
    good_codes: tuple = (0,)
@dataclasses.dataclass
class Table:
    name: str
    file: str
    seeds: str
    minutes: float
    steps: list
    values: typing.Callable
    text: typing.Callable
    logs: tuple = ()
    targets: tuple = ()
    needs: tuple = ()
def number(folders):
    return int((folders["run"] / "value").read_text())
TABLES = [
    Table("answer", "page.md", "1 to 2", 1, [Step("run", ["sh", "-c", "cat src/number > {out}/value"])], number, lambda value: f"| {value} |"),
    Table("twice", "page.md", "1", 1, [], lambda tables: 2 * tables["answer"], lambda value: f"| {value} |", needs=("answer",)),
]
"""
PAGE = """# Page

<!-- results: answer -->
<!-- end of results: answer -->

Between.

<!-- results: twice -->
<!-- end of results: twice -->
"""


class Tree(unittest.TestCase):
    def test_every_block_is_that_of_its_record(self):
        manifest = importlib.import_module("results_manifest")
        self.assertGreater(len(manifest.TABLES), 15)
        self.assertEqual(blocks.faults_of(SOURCE, manifest.TABLES), [])

    def test_every_scenario_study_and_program_of_the_manifest_exists(self):
        manifest = importlib.import_module("results_manifest")
        words = [word for table in manifest.TABLES for step in table.steps for word in step.command]
        for word in words:
            if word.startswith("worlds/") or word.startswith("tests/"):
                self.assertTrue((SOURCE / word).exists(), word)


class Repository(unittest.TestCase):
    """A small repository with a page of two tables."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name).resolve()
        (self.root / "tools").mkdir()
        (self.root / "src").mkdir()
        for name in ("results", "results_blocks.py", "results_tables.py"):
            shutil.copy(SOURCE / "tools" / name, self.root / "tools")
        (self.root / "tools/results_manifest.py").write_text(MANIFEST)
        (self.root / "page.md").write_text(PAGE)
        (self.root / "src/number").write_text("21\n")
        (self.root / ".gitignore").write_text("/out/\n")
        self.git("init", "--quiet")
        self.commit()

    def git(self, *words):
        identity = ["-c", "user.name=test", "-c", "user.email=test@example.org"]
        subprocess.run(["git", *identity, *words], cwd=self.root, check=True, capture_output=True)

    def commit(self):
        self.git("add", "-A")
        self.git("commit", "--quiet", "-m", "Change")

    def results(self, *words):
        return subprocess.run([sys.executable, "tools/results", *words], cwd=self.root, capture_output=True, text=True)

    def page(self):
        return (self.root / "page.md").read_text()

    def edit(self, file, old, new):
        text = (self.root / file).read_text()
        self.assertIn(old, text)
        (self.root / file).write_text(text.replace(old, new, 1))


class Command(Repository):
    def test_tables_are_made_with_commit_date_seeds_and_command_and_then_skipped(self):
        done = self.results()
        self.assertEqual(done.returncode, 0, done.stderr)
        commit = subprocess.run(["git", "log", "-1", "--abbrev=10", "--format=%h", "--", "src"], cwd=self.root, capture_output=True,
                                text=True).stdout.strip()
        self.assertRegex(self.page(), rf"(?s)<!-- results: answer -->\n\*By `tools/results --only answer` on \d{{4}}-\d\d-\d\d at commit {commit}\. "
                                      r"Seeds: 1 to 2\. Command: `sh -c .*`\.\*\n\n\| 21 \|\n<!-- end of results: answer -->\n\nBetween\.")
        self.assertIn("| 42 |", self.page())
        self.commit()
        again = self.results()
        self.assertEqual(again.returncode, 0, again.stderr)
        self.assertIn("2 of 2 tables are up to date", again.stderr)
        self.assertEqual(self.results("--check").returncode, 0)

    def test_a_new_commit_of_the_sources_makes_them_due_and_one_of_a_page_does_not(self):
        self.results()
        self.edit("page.md", "Between", "Among")
        self.commit()
        self.assertIn("2 of 2 tables are up to date", self.results().stderr)
        (self.root / "src/number").write_text("5\n")
        self.commit()
        self.assertIn("1 relevant commits old", self.results("--list").stdout)
        self.assertEqual(self.results("--only", "answer").returncode, 0)
        self.assertIn("| 5 |", self.page())
        self.assertIn("| 42 |", self.page())  # its table has not been made again

    def test_changed_commands_make_a_table_due(self):
        self.results()
        self.edit("tools/results_manifest.py", "cat src/number", "echo 7")
        self.assertIn("commands have changed", self.results("--list").stdout)
        self.assertIn("1 of 2 tables are up to date", self.results().stderr)
        self.assertIn("| 7 |", self.page())

    def test_uncommitted_sources_are_refused(self):
        (self.root / "src/number").write_text("5\n")
        done = self.results()
        self.assertEqual((done.returncode, len(done.stderr.splitlines())), (2, 1))
        self.assertIn("src/number: uncommitted change", done.stderr)

    def test_a_failed_command_leaves_the_page_and_the_next_table_goes_on(self):
        self.results()
        before = self.page()
        self.edit("tools/results_manifest.py", "cat src/number >", "false >")
        done = self.results()
        self.assertEqual(done.returncode, 3)
        self.assertIn("not made: answer", done.stderr)
        self.assertEqual(self.page(), before)

    def test_wrong_calls_are_2(self):
        for wrong in (["--only", "nothing"], ["--list", "--check"], ["--adopt", "nothing"], ["--nothing"]):
            self.assertEqual(self.results(*wrong).returncode, 2, wrong)

    def test_an_adopted_text_is_named_as_not_made(self):
        self.edit("page.md", "<!-- end of results: answer -->", "| 9 |\n<!-- end of results: answer -->")
        self.assertEqual(self.results("--adopt", "answer").returncode, 0)
        self.assertIn(f"*{blocks.NOT_MADE}. Commit: not recorded.", self.page())
        self.assertIn("| 9 |", self.page())
        done = self.results("--only", "twice")  # has to wait for the other one
        self.assertEqual(done.returncode, 3)
        self.assertIn("needs answer", done.stderr)


class PlantedFaults(Repository):
    def setUp(self):
        super().setUp()
        self.results()

    def assert_found(self, fault):
        done = self.results("--check")
        self.assertEqual(done.returncode, 1, done.stdout)
        self.assertIn(fault, done.stdout)

    def test_an_edited_figure_is_found_and_rendered_anew(self):
        self.edit("page.md", "| 21 |", "| 20 |")
        self.assert_found("page.md: answer: differs from tools/tables/answer.json")
        self.assertEqual(self.results("--render").returncode, 0)
        self.assertEqual(self.results("--check").returncode, 0)

    def test_an_edited_date_is_found(self):
        self.edit("page.md", " on 2", " on 1")
        self.assert_found("page.md: answer: differs")

    def test_an_edited_record_is_found(self):
        self.edit("tools/tables/answer.json", '"values": 21', '"values": 22')
        self.assert_found("page.md: answer: differs")

    def test_a_record_without_a_commit_is_found(self):
        file = self.root / "tools/tables/answer.json"
        file.write_text(json.dumps({**json.loads(file.read_text()), "commit": ""}))
        self.assert_found("answer.json: without commit")

    def test_a_missing_block_and_a_missing_record_are_found(self):
        self.edit("page.md", "<!-- end of results: answer -->", "")
        (self.root / "tools/tables/twice.json").unlink()
        self.assert_found("page.md: answer: must have the lines")
        self.assert_found("tools/tables/twice.json: not found")

    def test_a_block_that_no_table_makes_is_found(self):
        (self.root / "other.md").write_text("<!-- results: answer -->\n<!-- results: gone -->\n")
        self.assert_found("other.md: answer: not a table of this file")
        self.assert_found("other.md: gone: not a table of this file")


class Tables(unittest.TestCase):
    def test_columns_are_seeds_with_mean_and_worst(self):
        runs = [{"seed": seed, "metrics": {"a": value, "d": 10 - value}} for seed, value in ((1, 0.2), (2, 0.4))]
        rows = [tables.Row("a, m", "a", ".1f"), tables.Row("d", "d", ".1f", min), tables.Row("b", "b"),
                tables.Row("both", tables.pair("a", "d"), tables.as_text, None)]
        self.assertEqual(tables.by_seed(runs, rows).splitlines()[2:],
                         ["| a, m | 0.2 | 0.4 | 0.3 | 0.4 |", "| d | 9.8 | 9.6 | 9.7 | 9.6 |", "| b | – | – | – | – |",
                          "| both | 0.2 / 9.8 | 0.4 / 9.6 | – | – |"])

    def test_metrics_of_a_sweep_are_named_as_in_expectations(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            (folder / "runs").mkdir()
            (folder / "sweep.json").write_text(json.dumps({"variants": [{"name": "baseline"}], "runs": [{"variant": 0, "seed": 3, "hash": "f"}]}))
            metrics = {"pose": {"ate_rmse_m": 0.12345678}, "stations": [{"name": "box", "map_error_m": 0.1, "reached": True}], "each": [1.5, None]}
            (folder / "runs/f.json").write_text(json.dumps({"end": "done", "metrics": metrics}))
            self.assertEqual(tables.sweep_values(folder, ("pose.*", "stations.*.map_error_m", "each.*")),
                             [{"variant": "baseline", "seed": 3, "end": "done",
                               "metrics": {"each.0": 1.5, "pose.ate_rmse_m": 0.123457, "stations.box.map_error_m": 0.1}}])

    def test_a_study_is_pivoted(self):
        rows = [{"world": "A", "method": "x", "figure": "f", "published": "0.5", "mean": "0.4", "mean_low": "0.3", "mean_high": "0.5"},
                {"world": "A", "method": "y", "figure": "f", "published": "", "mean": "0.2", "mean_low": "", "mean_high": ""},
                {"world": "B", "method": "z", "figure": "g", "published": "", "mean": "1", "mean_low": "", "mean_high": ""}]
        text = tables.study_table(rows, ["", "paper", "here"], [({"world": "A"}, "f", "published"), ({"world": "A"}, "f", "interval")])
        self.assertEqual(text.splitlines()[2:], ["| x | 0.5 | 0.4 ± 0.1 |", "| y | – | 0.2 |"])


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v"])
