#!/usr/bin/env python3
"""A run that reports: the same bytes as one that does not, and nothing lost when the platform is away.

usage: reported_run_test.py PATROL SOURCE_DIR
"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parent))
sys.path.insert(0, str(pathlib.Path(__file__).parent.parent))
from monitoring import Platform  # noqa: E402
from standing_still import PATROL, SOURCE, standing_still  # noqa: E402

AWAY = "http://127.0.0.1:1"
ENVIRONMENT = {**{name: value for name, value in os.environ.items() if name != "PATROL_TOKEN"}, "PATROL_TOKEN": "0123456789abcdef"}


class ReportedRun(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = pathlib.Path(folder.name)
        self.scenario = standing_still(self.path)

    def patrol(self, *arguments, code=0, environment=ENVIRONMENT):
        done = subprocess.run([PATROL, *map(str, arguments)], capture_output=True, text=True, timeout=120, cwd=SOURCE, env=environment)
        self.assertEqual(done.returncode, code, done.stderr)
        return done

    def kinds(self, run):
        return [json.loads(line)["kind"] for line in (run / "outbox.jsonl").read_text().splitlines()]

    def test_a_run_is_the_same_whether_it_reports_or_not(self):
        self.patrol("run", self.scenario, "--out", self.path / "silent")
        platform = Platform(PATROL, self.path / "data")
        self.addCleanup(lambda: platform.kill())
        done = self.patrol("run", self.scenario, "--out", self.path / "told", "--monitor-url", platform.url, "--monitor-token-file", platform.token_file, "--robot-name", "Rex")
        self.assertEqual((self.path / "told/log.mcap").read_bytes(), (self.path / "silent/log.mcap").read_bytes())
        kinds = self.kinds(self.path / "told")
        self.assertIn(f"{platform.url} received all {len(kinds)} results", done.stderr)
        self.assertEqual((kinds[0], kinds[-1]), ("status", "status"))
        self.assertTrue({"pose", "event", "map"} <= set(kinds), kinds)
        robot = platform.get("/api/robots")["robots"][0]
        self.assertEqual((robot["robot"], robot["world"], robot["state"], robot["at"]), ("Rex", "yard", "finished", "home"))

    def test_results_wait_while_the_platform_is_away_and_are_sent_later(self):
        run = self.path / "run"
        done = self.patrol("run", self.scenario, "--out", run, "--monitor-url", AWAY)
        count = len(self.kinds(run))
        self.assertIn(f"{count} results not delivered, kept in {run}/outbox.jsonl (Connection refused); upload with: patrol upload {run} --monitor-url {AWAY}", done.stderr)
        self.assertIn(f"contains {count} undelivered results of an earlier run", self.patrol("run", self.scenario, "--out", run, code=2).stderr)
        self.patrol("upload", run, "--monitor-url", AWAY, "--timeout-s", "1", code=3)

        platform = Platform(PATROL, self.path / "data")
        self.addCleanup(lambda: platform.kill())
        self.assertIn("401", self.patrol("upload", run, "--monitor-url", platform.url, code=2).stderr)
        self.assertEqual(self.patrol("upload", run, "--monitor-url", platform.url, "--token-file", platform.token_file).stdout, f"uploaded: {count} results to {platform.url}\n")
        self.assertEqual(self.patrol("upload", run, "--monitor-url", platform.url, "--token-file", platform.token_file).stdout, f"uploaded: 0 results to {platform.url}\n")
        self.assertEqual(platform.get("/api/robots")["robots"][0]["robot"], "quadruped-1")
        self.patrol("run", self.scenario, "--out", run)
        self.assertFalse((run / "outbox.jsonl").exists())

    def test_what_is_wrong_is_said_before_anything_runs(self):
        out = self.path / "run"
        nobody = {name: value for name, value in ENVIRONMENT.items() if name != "PATROL_TOKEN"}
        self.assertIn("access token required", self.patrol("run", self.scenario, "--out", out, "--monitor-url", AWAY, code=2, environment=nobody).stderr)
        self.assertIn("must be a URL such as", self.patrol("run", self.scenario, "--out", out, "--monitor-url", "platform:8080", code=2).stderr)
        self.assertIn("no results to upload", self.patrol("upload", self.path, "--monitor-url", AWAY, code=2).stderr)
        self.assertIn("at least 16 characters", self.patrol("monitor", "--port", "0", "--data-dir", out, code=2, environment={**nobody, "PATROL_TOKEN": "short"}).stderr)
        self.assertFalse((out / "log.mcap").exists())


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v"])
