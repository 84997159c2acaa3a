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
    files: tuple = ()
    needs: tuple = ()
def number(folders):
    return int((folders["run"] / "value").read_text())
TABLES = [
    Table("answer", "page.md", "1 to 2", 1, [Step("run", ["sh", "-c", "cat src/number > {out}/value"])], number, lambda value: f"| {value} |",
          files=("tests",)),
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

    def test_a_commit_of_the_files_of_one_table_makes_only_that_one_due(self):
        self.results()
        self.commit()
        (self.root / "tests").mkdir()
        (self.root / "tests/one_test.cc").write_text("// a test that prints figures\n")
        done = self.results()
        self.assertEqual(done.returncode, 2)
        self.assertIn("uncommitted change", done.stderr)
        self.assertEqual(self.results("--only", "twice").returncode, 0)
        self.commit()
        listed = self.results("--list").stdout.splitlines()
        self.assertIn("1 relevant commits old", listed[0])
        self.assertIn("up to date", listed[1])

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

    def test_a_table_of_results_outside_of_a_block_is_found_and_other_tables_are_not(self):
        for header in ("| metric | S = 2001 | mean |", "| ten bodies | result |", "| method | worst |"):
            (self.root / "other.md").write_text(f"# Other\n\n{header}\n{'| --- ' * (header.count('|') - 1)}|\n| a | 1 | 2 |\n")
            self.assert_found(f"other.md: {header}: a table of results outside of a block")
        (self.root / "other.md").write_text("| key | mean of the values |\n| --- | --- |\n| a | b |\n\n```\n| mean |\n| --- |\n```\n\n| mean | not a table\n")
        self.assertEqual(self.results("--check").returncode, 0)
        self.edit("page.md", "| 21 |", "| mean |\n| --- |\n| 21 |")
        self.assertNotIn("outside", self.results("--check").stdout)

    def test_a_block_that_no_table_makes_is_found(self):
        (self.root / "other.md").write_text("<!-- results: answer -->\n<!-- results: gone -->\n")
        self.assert_found("other.md: answer: not a table of this file")
        self.assert_found("other.md: gone: not a table of this file")


class Tables(unittest.TestCase):
    def test_columns_are_seeds_with_mean_and_worst(self):
        runs = [{"seed": seed, "end": end, "metrics": {"a": value, "d": 10 - value}}
                for seed, value, end in ((1, 0.2, "done"), (2, 0.4, "expectation missed"))]
        rows = [tables.Row("a, m", "a", ".1f"), tables.Row("d", "d", ".1f", min), tables.Row("b", "b"),
                tables.Row("both", tables.pair("a", "d"), tables.as_text, None), tables.Row("verdict", "end", tables.met_or_missed, None)]
        self.assertEqual(tables.by_seed(runs, rows).splitlines()[2:],
                         ["| a, m | 0.2 | 0.4 | 0.3 | 0.4 |", "| d | 9.8 | 9.6 | 9.7 | 9.6 |", "| b | – | – | – | – |",
                          "| both | 0.2 / 9.8 | 0.4 / 9.6 | – | – |", "| verdict | met | missed | – | – |"])

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

    def test_runs_without_a_metric_are_counted(self):
        runs = [{"metrics": {"a": 0.2}}, {"metrics": {}}, {"metrics": {"a": 0.1}}]
        self.assertEqual(tables.span(runs, "a", ".1f", " m"), "0.1 to 0.2 m (2 of 3 runs)")
        self.assertEqual(tables.span(runs[:1], "a", ".1f"), "0.2 to 0.2")
        self.assertEqual(tables.span(runs, "b", ".1f"), "–")

    def test_missed_expectations_are_those_of_the_junit_report(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            self.assertIsNone(tables.missed_expectations(folder))
            (folder / "junit.xml").write_text("""<?xml version="1.0" encoding="UTF-8"?>
<testsuites name="patrol" tests="4" failures="2" errors="0" skipped="1" time="1.0">
  <testsuite name="short" tests="4" failures="2" errors="0" skipped="1" time="1.0">
    <properties><property name="seed" value="1"/></properties>
    <testcase classname="short" name="run" time="1.0"/>
    <testcase classname="short" name="map.coverage &gt;= 0.65" time="0.000"/>
    <testcase classname="short" name="pose.ate_rmse_m &lt;= 0.001" time="0.000">
      <failure message="pose.ate_rmse_m is 0.02959, expected &lt;= 0.001"/>
    </testcase>
    <testcase classname="short" name="goals.goal_1.position_error_m.mean 0.1 ... 0.2" time="0.000">
      <failure message="is not measured"/>
    </testcase>
    <testcase classname="short" name="imu: dropout" time="0.000"><skipped message="not triggered"/></testcase>
  </testsuite>
</testsuites>
""")
            self.assertEqual(tables.missed_expectations(folder), ["pose.ate_rmse_m", "goals.goal_1.position_error_m.mean"])
            (folder / "junit.xml").write_text('<testsuites><testsuite><testcase name="run"><error message="crash: no end"/></testcase></testsuite>'
                                              "</testsuites>")
            self.assertEqual(tables.missed_expectations(folder), ["run: crash: no end"])


class Studies(unittest.TestCase):
    def test_a_study_is_pivoted(self):
        rows = [{"world": "A", "method": "x", "figure": "f", "published": "0.5", "mean": "0.4", "mean_low": "0.3", "mean_high": "0.5"},
                {"world": "A", "method": "y", "figure": "f", "published": "", "mean": "0.2", "mean_low": "", "mean_high": ""},
                {"world": "B", "method": "z", "figure": "g", "published": "", "mean": "1", "mean_low": "", "mean_high": ""}]
        text = tables.study_table(rows, ["", "paper", "here"], [({"world": "A"}, "f", "published"), ({"world": "A"}, "f", "interval")])
        self.assertEqual(text.splitlines()[2:], ["| x | 0.5 | 0.4 ± 0.1 |", "| y | – | 0.2 |"])

    def planners(self):
        """Results as `patrol study` writes them: Q-learning finds no path in one world, and the dual swarm finds 28 of 30."""
        head = ("world,method,particles,figure,unit,published,seeds,mean,mean_low,mean_high,difference,difference_low,difference_high,verdict,failed,"
                "pairs,adjusted_p_value,adjusted_failure_p_value")
        length, count = "longer than A*", "iterations to 1 % of its final value"
        rows = [f"tunnel,improved ant colony (this work),0,{length},%,,30,0.1,0.05,0.15,,,,,0,30,,",
                f"tunnel,improved ant colony (this work),0,{count},,,30,3,2,4,,,,,,30,,",
                f"tunnel,dual swarm,0,{length},%,,28,2.5,2.4,2.6,2.4,2.3,2.5,higher,2,28,0.00012345678,1",
                f"tunnel,dual swarm,0,{count},,,28,20,18,22,17,15,19,higher,,28,0.0004,",
                f"tunnel,Q-learning,0,{length},%,,0,,,,,,,,30,0,,1.8626e-07"]
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            (folder / "results.csv").write_text("\r\n".join([head, *rows]) + "\r\n")
            (folder / "performance.csv").write_text("world,method,particles,figure,unit,mean\r\ntunnel,Q-learning,0,time,ms,1941.2\r\n"
                                                    "tunnel,A*,0,time,ms,0.9\r\n")
            return tables.study_values(folder)

    def test_failures_pairs_and_adjusted_p_values_are_kept(self):
        found = self.planners()
        self.assertEqual(found[2], {"world": "tunnel", "method": "dual swarm", "particles": "0", "figure": "longer than A*", "published": "",
                                    "seeds": "28", "mean": "2.5", "mean_low": "2.4", "mean_high": "2.6", "failed": "2", "pairs": "28",
                                    "adjusted_p_value": "0.000123457", "adjusted_failure_p_value": "1"})
        self.assertEqual(found[4]["adjusted_failure_p_value"], "1.8626e-07")

    def test_the_table_of_the_planners_shows_them(self):
        studies = importlib.import_module("results_manifest.studies")
        lines = [line for line in studies.planners_text(self.planners()).splitlines() if line.startswith("| tunnel")]
        self.assertEqual(lines, ["| tunnel | 0.1 ± 0.05 | – | – | 2.5 ± 0.1 [0.00012]; 2 failed [1]; 28 pairs | –; 30 failed [1.9e-07]; 0 pairs | – |",
                                 "| tunnel | 3 ± 1 | – | – | 20 ± 2 [0.0004]; 28 pairs | – |",
                                 "| tunnel | – | – | – | – | 1,940 | 0.9 | – |"])


class Summary(unittest.TestCase):
    def test_a_run_that_did_not_dock_is_counted(self):
        readme = importlib.import_module("results_manifest.readme")
        runs = [{"metrics": {"docking.position_error_m.max": 0.004}}, {"metrics": {}}, {"metrics": {"docking.position_error_m.max": 0.0056}}]
        self.assertEqual(readme.worst_docking(runs), "at most 5.6 mm (2 of 3 runs)")
        self.assertEqual(readme.worst_docking(runs[:1]), "at most 4.0 mm")
        self.assertEqual(readme.worst_docking(runs[1:2]), "–")

    def test_it_is_made_of_the_records(self):
        readme = importlib.import_module("results_manifest.readme")
        patrol = [{"metrics": {"pose.site.ate_rmse_m": value}} for value in (0.02, 0.04)]
        goals = [{"metrics": {f"goals.goal_{i}.position_error_m.mean": 0.01 * i for i in (1, 2, 3)}}]
        values = readme.summary_values({
            "street_patrol": {"patrol": patrol}, "tunnel_navigation": {"navigation": goals},
            "tunnel_scenarios": {"docking": [{"metrics": {}}, {"metrics": {"docking.position_error_m.max": 0.004}}]},
            "tunnel_inspection": {"inspection": [{"metrics": {"inspection.lining.max_error_mm": 0.5}}, {"metrics": {}}]},
            "slam_logs": [{"log": "intel", "method": "graph", "error": "0.0143 m, 0.221°"}],
            "study_substation": [{"figure": "map to nearest surface", "method": "pose graph (graph)", "mean": "0.0276"}]})
        text = readme.summary_text(values)
        for cell in ("| 0.020 to 0.040 m | 2 |", "| at most 4.0 mm (1 of 2 runs) | 2 |", "| 0.50 to 0.50 mm (1 of 2 runs) | 2 |", "| 0.028 m | 5 |"):
            self.assertIn(cell, text)


class Tunnel(unittest.TestCase):
    WATER = """Note: Google Test filter = WaterAhead.OfTenSpheroidsInRealGround*
[ RUN      ] WaterAhead.OfTenSpheroidsInRealGround
seed 201: found yes, error 1.23 m, distance 15.0 m in [12.1, 17.9] yes, radius 5.0 m in [4.0, 6.0] no
seed 202: found yes, error 2.50 m, distance 18.2 m in [14.0, 21.5] no, radius 6.1 m in [5.2, 7.4] yes
seed 203: found no, error 0.00 m, distance 0.0 m in [0.0, 0.0] no, radius 0.0 m in [0.0, 0.0] no
[       OK ] WaterAhead.OfTenSpheroidsInRealGround (1000 ms)
"""

    def setUp(self):
        self.tunnel = importlib.import_module("results_manifest.tunnel")

    def test_lines_of_the_test_of_water_ahead_are_read(self):
        runs = self.tunnel.water_runs(self.WATER)
        self.assertEqual(runs[0], {"seed": 201, "found": True, "error_m": 1.23,
                                   "distance": {"m": 15.0, "low": 12.1, "high": 17.9, "holds": True},
                                   "radius": {"m": 5.0, "low": 4.0, "high": 6.0, "holds": False}})
        self.assertEqual(runs[2], {"seed": 203, "found": False})
        self.assertEqual(self.tunnel.water_text(runs).splitlines()[2:], [
            "| 201 | yes | 1.23 | 15.0 [12.1, 17.9] | yes | 5.0 [4.0, 6.0] | no |",
            "| 202 | yes | 2.50 | 18.2 [14.0, 21.5] | no | 6.1 [5.2, 7.4] | yes |",
            "| 203 | no | – | – | – | – | – |",
            "| all | 2 of 3 | mean 1.86, worst 2.50; below 3.5 m: 2 of 3 |  | 1 of 2 |  | 1 of 2 |"])

    def test_other_lines_of_a_seed_and_none_are_refused(self):
        for text in (self.WATER.replace("error 1.23 m", "error 1.23"), self.WATER.replace(", error 1.23 m, distance 15.0 m in [12.1, 17.9] yes", ""),
                     "seed 201: found yes\n", "[  PASSED  ] 1 test.\n"):
            with self.assertRaises(blocks.ResultsError):
                self.tunnel.water_runs(text)

    def test_rounds_show_their_verdict_and_the_dash_where_it_is_not_recorded(self):
        metrics = {"mission.completed": True, "mission.collisions": 0, "inspection.lining.max_error_mm": 0.5}
        rows = [{"map": 1, "seed": "2", "metrics": metrics}, {"map": 1, "seed": "3", "metrics": metrics, "missed": []},
                {"map": 1, "seed": "4", "metrics": {}, "missed": ["goals.goal_1.position_error_m.mean", "docking.arrivals"]}]
        cells = [line.split(" | ")[-1] for line in self.tunnel.rounds_text(rows).splitlines()]
        self.assertEqual(cells[2:], ["– |", "all met |", "2 missed: `goals.goal_1.position_error_m.mean`, `docking.arrivals` |"])


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v"])
