#!/usr/bin/env python3
"""Twenty robots of two worlds report at once while the platform is killed with -9 and started again, twice: every result is there exactly
once, as it was sent.

usage: twenty_robots_test.py PATROL REPORTING_ROBOT [SECONDS]
"""
import json
import pathlib
import sqlite3
import subprocess
import sys
import tempfile
import time
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from monitoring import Platform  # noqa: E402

PATROL, ROBOT = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
SECONDS = float(sys.argv[3]) if len(sys.argv) > 3 else 8.0
ROBOTS, RATE_HZ, DOWN_S = 20, 5.0, 1.0


class TwentyRobots(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = pathlib.Path(folder.name)

    def test_every_result_is_there_exactly_once_though_the_platform_is_killed_twice(self):
        platform = Platform(PATROL, self.path / "data")
        self.addCleanup(lambda: platform.kill())
        robots = []
        for i in range(ROBOTS):
            world = "tunnel" if i % 2 else "street"
            robots.append(subprocess.Popen([ROBOT, platform.url, platform.token_file, self.path / f"run_{i}", f"{world}-{i}", world, str(SECONDS), str(RATE_HZ)],
                                           stdout=subprocess.PIPE, text=True))
        for _ in range(2):
            time.sleep(SECONDS / 3)
            platform.kill()
            time.sleep(DOWN_S)
            platform.start()
        said = [robot.communicate(timeout=SECONDS + 120)[0] for robot in robots]
        self.assertEqual([robot.returncode for robot in robots], [0] * ROBOTS, said)

        sent = {}
        for outbox in self.path.glob("run_*/outbox.jsonl"):
            for line in outbox.read_text().splitlines():
                result = json.loads(line)
                self.assertNotIn(result["id"], sent)
                sent[result["id"]] = result
        platform.stop()
        with sqlite3.connect(self.path / "data/results.sqlite") as database:
            rows = database.execute("SELECT id, robot, run, world, sequence, time_s, kind, data FROM results").fetchall()
            poses = database.execute("SELECT count(*) FROM poses").fetchone()[0]
            findings = database.execute("SELECT count(*) FROM findings").fetchone()[0]
        kept = {row[0]: row[1:] for row in rows}
        self.assertEqual(len(rows), len(kept))
        self.assertEqual(set(kept), set(sent))
        for name, result in sent.items():
            robot, run, world, sequence, time_s, kind, data = kept[name]
            self.assertEqual((robot, run, world, sequence, time_s, kind, json.loads(data)), tuple(result[key] for key in ("robot", "run", "world", "sequence", "time_s", "kind", "data")))
        kinds = [result["kind"] for result in sent.values()]
        self.assertEqual(poses, kinds.count("pose"))
        self.assertEqual(set(kinds), {"status", "pose", "map", "event", "lining", "water"})
        alarms = sum(result["kind"] == "event" and result["data"]["kind"] == "gas_alarm" for result in sent.values())
        found = sum(len(result["data"]["findings"]) for result in sent.values() if result["kind"] == "lining") + kinds.count("water")
        self.assertEqual(findings, alarms + found)
        print(f"{len(sent)} results of {ROBOTS} robots in {SECONDS:.0f} s, the platform killed twice: {len(kept)} kept")


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v"])
