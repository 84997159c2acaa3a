#!/usr/bin/env python3
"""What the tunnel's runs are given: bad files are refused with one line, and goals that cannot be reached are said to be so.

usage: tunnel_input_test.py PATROL SOURCE_DIR [TEST...]
The tests of class NoRoute read the log, with the Python packages that tools/setup installs.
"""
import json
import math
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

PATROL, SOURCE = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
TUNNEL = SOURCE / "worlds/tunnel"
HEADER = "time_s,vx_mps,yaw_rate_radps,mark,hand_over\n"


class TunnelRun(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.out = self.folder / "run"

    def write(self, name, content):
        """A file in a folder of its own; text, bytes, or what is to be JSON."""
        file = self.folder / name
        if isinstance(content, (list, dict)):
            content = json.dumps(content, indent=1)
        file.write_bytes(content.encode() if isinstance(content, str) else content)
        return file

    def run_patrol(self, scenario, *settings, timeout=60):
        command = [PATROL, "run", TUNNEL / f"scenarios/{scenario}.yaml", "--out", self.out]
        for setting in settings:
            command += ["--set", setting]
        return subprocess.run(command, capture_output=True, text=True, timeout=timeout, cwd=SOURCE)


class BadInput(TunnelRun):
    """A case is a name, the bad content, and what the one line must say beside the file's name."""

    def refuse(self, says, scenario, *settings):
        done = self.run_patrol(scenario, "time_limit_s=0.1", *settings)
        self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
        for part in says:
            self.assertIn(part, done.stderr)
        self.assertFalse(self.out.exists(), "something was left in the run directory")

    def refuse_goals(self, name, content, *says):
        with self.subTest(name):
            self.refuse(["nav.json", *says], "navigate", f"goals={self.write('nav.json', content)}")

    def refuse_map(self, name, *says, yaml=None, image=None):
        with self.subTest(name):
            self.write("map.pgm", (TUNNEL / "map/map.pgm").read_bytes() if image is None else image)
            file = self.write("map.yaml", (TUNNEL / "map/map.yaml").read_text() if yaml is None else yaml)
            self.refuse(says, "navigate", f"map={file}")

    def refuse_recorded(self, name, rows, *says):
        with self.subTest(name):
            self.refuse(["teleop.csv", *says], "mapping", f"teleop={{recorded: {self.write('teleop.csv', rows)}}}")

    def refuse_drive(self, name, content, *says):
        with self.subTest(name):
            self.refuse(["drive.json", *says], "mapping", f"teleop={{route: {self.write('drive.json', content)}}}")

    def goals(self):
        return json.loads((TUNNEL / "map/nav.json").read_text())

    def goals_with(self, key, value):
        goals = self.goals()
        goals[1][key] = value
        return goals

    def test_goals_lack_a_field(self):
        for key in ["number", "position", "orientation", "type", "accuracy"]:
            goals = self.goals()
            del goals[1][key]
            self.refuse_goals(f"no {key}", goals, "[1]", f"{key} is missing")

    def test_goals_of_the_wrong_type(self):
        wrong = {"number": ["2", 1.5, True, None, 2**64 - 1, -2**63, 2**70],
                 "position": ["here", 1, [1, 2], [1, 2, 3, 4], [1, 2, "3"], {"x": 1}, None],
                 "orientation": ["north", [0, 0, 1], [0, 0, 0, "1"], None],
                 "type": [7, "", "X", "NV", "N\nV", "N\0", None],
                 "accuracy": ["0.1", [0.1], True, None]}
        for key, values in wrong.items():
            for value in values:
                self.refuse_goals(f"{key} = {value!r}", self.goals_with(key, value), "[1]", key)

    def test_goals_with_numbers_that_mean_nothing(self):
        self.refuse_goals("NaN", self.goals_with("accuracy", math.nan), ":19:", "not JSON")
        self.refuse_goals("Infinity", self.goals_with("accuracy", math.inf), ":19:", "not JSON")
        huge = json.dumps(self.goals(), indent=1).replace('"accuracy": 0.1', '"accuracy": 1e400', 1)
        self.refuse_goals("1e400", huge, ":3:", "1e400")
        self.refuse_goals("quaternion of norm 0", self.goals_with("orientation", [0, 0, 0, 0]), "[1]", "orientation")
        self.refuse_goals("quaternion of norm 2", self.goals_with("orientation", [0, 0, 0, 2]), "[1]", "orientation")
        self.refuse_goals("quaternion with w first", self.goals_with("orientation", [1, 0, 0, 0]), "[1]", "orientation")
        self.refuse_goals("no accuracy at all", self.goals_with("accuracy", 0), "[1]", "accuracy must be positive")

    def test_goals_off_the_map(self):
        for x in [-500, -1e6, 1e300]:
            self.refuse_goals(f"x = {x}", self.goals_with("position", [x, 0, 0]), "goal 2", "position", "outside the map")

    def test_goals_twice_none_and_too_many(self):
        self.refuse_goals("one number twice", self.goals_with("number", 1), "[1]", "number 1: duplicate")
        text = json.dumps(self.goals(), indent=1).replace('"accuracy": 0.1', '"accuracy": 0.1, "accuracy": 5', 1)
        self.refuse_goals("one key twice", text, "[0]", "accuracy: duplicate key")
        self.refuse_goals("misspelt", self.goals_with("acuracy", 1), "[1]", "acuracy", "accuracy")
        self.refuse_goals("none", [], "at least one goal")
        self.refuse_goals("an object", {"goals": self.goals()}, "list")
        goal = json.dumps(self.goals()[0])
        self.refuse_goals("a million", "[" + ",\n".join([goal] * 1000000) + "]", "more than 1000")

    def test_goals_that_are_no_json(self):
        self.refuse_goals("empty", "", ":1:", "ends too early")
        self.refuse_goals("cut off", json.dumps(self.goals(), indent=1)[:-40], ":45:", "ends too early")
        self.refuse_goals("YAML", "- number: 1\n", ":1:", "not JSON")
        self.refuse_goals("bytes", bytes(range(256)), ":1:", "not JSON")
        self.refuse_goals("a million brackets", "[" * 1000000, "nested levels")
        with self.subTest("no such file"):
            self.refuse(["goals", "absent.json"], "navigate", f"goals={self.folder}/absent.json")
        with self.subTest("a folder"):
            self.refuse(["goals", "folder"], "navigate", f"goals={self.folder}")

    def test_map_yaml(self):
        good = (TUNNEL / "map/map.yaml").read_text()
        lines = good.splitlines()
        for key in ["image", "resolution", "origin"]:
            self.refuse_map(f"no {key}", "map.yaml", f"{key}: is missing",
                            yaml="\n".join(line for line in lines if not line.startswith(key)))
        wrong = {"image": ["absent.pgm", "[a]", "''", "."],
                 "mode": ["binary", "1"],
                 "resolution": ["0", "-1", ".nan", ".inf", "1e-9", "1e9", "fine", "[1]"],
                 "origin": ["0", "[0]", "[a, b, 0]", "[.nan, 0, 0]", "[0, 0, 1]", "[1e300, 0, 0]"],
                 "negate": ["2", "perhaps"],
                 "occupied_thresh": ["2", "-1", "x"],
                 "free_thresh": ["0.9", "-1"]}
        for key, values in wrong.items():
            number, = [i for i, line in enumerate(lines) if line.startswith(key + ":")]
            for value in values:
                changed = lines[:number] + [f"{key}: {value}"] + lines[number + 1:]
                self.refuse_map(f"{key}: {value}", f"map.yaml:{number + 1}: {key}", yaml="\n".join(changed))
        self.refuse_map("one key twice", "map.yaml:8: resolution", yaml=good + "resolution: 0.1\n")
        self.refuse_map("no YAML", "map.yaml:1:", yaml="a: [1")
        self.refuse_map("empty file", "map.yaml", yaml="")

    def test_map_image(self):
        good = (TUNNEL / "map/map.pgm").read_bytes()
        width, height = map(int, good.split(maxsplit=3)[1:3])
        self.assertTrue(good.startswith(b"P5\n%d %d\n255\n" % (width, height)))
        pixels = good[-width * height:]

        def image(columns, rows, content):
            return b"P5\n%d %d\n255\n" % (columns, rows) + content

        self.refuse_map("truncated", "map.pgm", "ends too early", image=good[:1000])
        self.refuse_map("a row too few", "map.pgm", "ends too early", image=good[:-width])
        self.refuse_map("a row too many", "map.pgm", "has data after", image=good + bytes(width))
        self.refuse_map("another width", "map.pgm", "has data after", image=image(width - 1, height, pixels))
        self.refuse_map("rows for columns", "map.yaml", "start", "outside the map", image=image(height, width, pixels))
        self.refuse_map("no pixel", "map.pgm", "0 x 0", image=image(0, 0, b""))
        self.refuse_map("more pixels than fit anywhere", "map.pgm", "ends too early", image=image(2000000000, 2000000000, b"\0"))
        self.refuse_map("another format", "map.pgm", "neither a PGM (P5 or P2) nor a PNG", image=b"GIF89a")
        self.refuse_map("broken PNG", "map.pgm", "is not a valid PNG: ends too early", image=b"\x89PNG\r\n\x1a\n")
        self.refuse_map("empty file", "map.pgm", "PGM", image=b"")
        self.refuse_map("all unknown", "map.yaml", "no free cell", image=image(width, height, b"\xcd" * (width * height)))
        self.refuse_map("all free", "map.yaml", "no occupied cell", image=image(width, height, b"\xfe" * (width * height)))

    def test_map_of_another_place(self):
        elsewhere = re.sub(r"origin: \[[^,]+,", "origin: [100.0,", (TUNNEL / "map/map.yaml").read_text())
        self.refuse_map("does not hold the start", "map.yaml", "start", "outside the map", yaml=elsewhere)

    def test_recorded_commands(self):
        self.refuse_recorded("no header", "0,1,0,0,0\n", ":1:", "vx_mps")
        self.refuse_recorded("no command", HEADER, "no command")
        for name, row, key in [("too few", "0,1,0,0", "5 numbers"), ("too many", "0,1,0,0,0,0", "5 numbers"),
                               ("empty line", "", "5 numbers"), ("a word", "0,fast,0,0,0", "vx_mps"), ("NaN", "0,0,nan,0,0", "yaw_rate_radps"),
                               ("too large", "0,1e400,0,0,0", "vx_mps"), ("too fast", "0,1e300,0,0,0", "vx_mps"),
                               ("before the start", "-1,0,0,0,0", "time_s"), ("never", "1e300,0,0,0,0", "time_s"),
                               ("half a mark", "0,0,0,0.5,0", "mark"), ("two hands over", "0,0,0,0,2", "hand_over")]:
            self.refuse_recorded(name, f"{HEADER}{row}\n", ":2:", key)
        self.refuse_recorded("back in time", HEADER + "1,0,0,0,0\n0.5,0,0,0,0\n", ":3:", "time_s")

    def test_drive(self):
        def drive():
            return json.loads((TUNNEL / "drive.json").read_text())

        for key in ["version", "frame", "waypoints"]:
            lacking = drive()
            del lacking[key]
            self.refuse_drive(f"no {key}", lacking, f"{key} is missing")
        for key, value in [("version", 2), ("frame", "map"), ("waypoints", {}), ("waypoints", []), ("waypoints", [3, 4])]:
            self.refuse_drive(f"{key} = {value}", drive() | {key: value}, key)
        for key, value in [("position", None), ("position", [1]), ("position", [1, "2"]), ("position", [1e300, 0]), ("reverse", "yes"),
                           ("mark_heading_deg", "90"), ("mark_heading_deg", 1e308), ("revers", True)]:
            wrong = drive()
            wrong["waypoints"][1][key] = value
            self.refuse_drive(f"{key} = {value}", wrong, "waypoints[1]", key)

    def test_reference_scans(self):
        good = [{"station": "goal_1", "position": [-32.0, 0.0, 0.8], "orientation": [0, 0, 1, 0]}]
        ply = "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n"
        for name, index, cloud, *says in [("no folder", None, None, "scans.json"), ("no cloud", good, None, "goal_1.ply"),
                                          ("truncated", good, ply, "goal_1.ply"), ("not a number", good, ply + "0 nan 0\n", "goal_1.ply"),
                                          ("twice", good + good, ply + "0 0 0\n", "scans.json", "duplicate"),
                                          ("out of its folder", [good[0] | {"station": "../goal_1"}], None, "station"),
                                          ("upside down", [good[0] | {"orientation": [1, 0, 0, 0]}], None, "orientation")]:
            with self.subTest(name):
                for file, content in [("scans.json", index), ("goal_1.ply", cloud)]:
                    (self.folder / file).unlink(missing_ok=True)
                    if content is not None:
                        self.write(file, content)
                self.refuse(says, "inspection_round", f"references={self.folder}")

    def test_a_map_and_a_drive_that_makes_one(self):
        self.refuse(["map", "teleop"], "mapping", "map=map/map.yaml")


    def test_a_robot_whose_profile_names_no_tunnel_mission(self):
        self.refuse(["navigate.yaml: stack.mission_type = gas (robot wheeled): mission site.json has no stations: must have at least one",
                     "stack.mission_type=tunnel"], "navigate", "robot=wheeled")
        done = self.run_patrol("navigate", "time_limit_s=0.1", "robot=wheeled", "stack.mission_type=tunnel")
        self.assertEqual(done.returncode, 4, done.stderr)  # it runs to its time limit


class NoRoute(TunnelRun):
    """The first goal cannot be reached, the second can: the robot says why, goes on to the second, and collides with nothing."""

    def goal(self, number, x, y):
        return {"number": number, "position": [x, y, 0.0], "orientation": [0.0, 0.0, 1.0, 0.0], "type": "N", "accuracy": 0.2}

    def drive_to(self, x, y, map_file="map/map.yaml"):
        goals = self.write("nav.json", [self.goal(1, x, y), self.goal(2, -8.0, -2.0)])
        return self.run_patrol("navigate", f"map={map_file}", f"goals={goals}", "actors=[]", "time_limit_s=60",
                               "stack.navigation.no_path_timeout_s=3", "stack.tunnel_mission.dock_after_run=false",
                               "expect={mission.completed: true, mission.collisions: 0}", timeout=300)

    def events(self):
        from mcap.reader import make_reader
        from mcap_ros2.decoder import DecoderFactory
        with open(self.out / "log.mcap", "rb") as file:
            messages = make_reader(file, decoder_factories=[DecoderFactory()]).iter_decoded_messages(topics=["/events"])
            return [event for _, _, _, event in messages]

    def assert_given_up(self, done, reason):
        self.assertEqual(done.returncode, 1, done.stdout + done.stderr)  # an expectation, mission.completed, is missed
        shown = subprocess.run([PATROL, "score", self.out, "--all"], capture_output=True, text=True, cwd=SOURCE).stdout
        self.assertIn("goal_1   not reached 1 of 1 times", shown)
        metrics = json.loads((self.out / "metrics.json").read_text())
        self.assertFalse(metrics["mission"]["completed"])
        self.assertEqual(metrics["mission"]["collisions"], 0)
        self.assertEqual([(goal["arrivals"], goal["failed"]) for goal in metrics["goals"]], [(0, 1), (1, 0)])
        events = self.events()
        said = [event.text for event in events if event.kind == "navigation"]
        self.assertEqual(said[:2], [reason, f"Navigation aborted: {reason}"])
        told = [(event.kind, event.subject) for event in events if event.kind.startswith(("goal_", "mission_"))]
        self.assertEqual(told, [("goal_failed", "goal_1"), ("goal_reached", "goal_2"), ("mission_failed", "")])

    def test_a_goal_inside_the_wall(self):
        self.assert_given_up(self.drive_to(-12.0, 2.87), "Goal pose is blocked: obstacle, keep-out line or unknown space.")

    def test_a_goal_outside_the_tunnel(self):
        """The map, complete as it is, knows nothing there; the portal is open, and outside is no way to it."""
        self.assert_given_up(self.drive_to(-12.0, 3.3), "Goal pose is blocked: obstacle, keep-out line or unknown space.")

    def test_a_goal_behind_a_wall_that_the_map_shows(self):
        """From side to side of the tunnel, 20 m in. Round its outside, where the map knows nothing, there is no way either."""
        image, yaml = (TUNNEL / "map/map.pgm").read_bytes(), (TUNNEL / "map/map.yaml").read_text()
        width, height = map(int, image.split(maxsplit=3)[1:3])
        origin_x = float(yaml.split("origin: [")[1].split(",")[0])
        pixels = bytearray(image)
        column = round((-20.0 - origin_x) / 0.05)
        for row in range(height):
            first = len(image) - width * height + row * width + column
            pixels[first:first + 6] = bytes(6)
        self.write("map.pgm", bytes(pixels))
        self.assert_given_up(self.drive_to(-30.0, -0.2, self.write("map.yaml", yaml)), "No path to the goal exists.")


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v", *sys.argv[3:]])
