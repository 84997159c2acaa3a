#!/usr/bin/env python3
"""`patrol plan`: routes, tours and files of problems on maps that the test draws, beside a Dijkstra of its own, and on the tunnel's map; bad input gets one line.

usage: plan_test.py PATROL SOURCE_DIR
"""
import csv
import heapq
import itertools
import json
import math
import pathlib
import random
import subprocess
import sys
import tempfile
import unittest

PATROL, SOURCE = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
TUNNEL = SOURCE / "worlds/tunnel/map/map.yaml"
PLANNERS = ["astar", "dijkstra", "theta_star", "visibility_graph", "ant_system", "ant_colony_li22", "dual_swarm_pso", "q_learning"]


def octile_lengths(rows, start):
    """From `start` (x, y from the upper left) to every cell that can be reached; no corner of a blocked cell is cut."""
    lengths, heap = {}, [(0.0, start)]
    is_free = lambda x, y: 0 <= y < len(rows) and 0 <= x < len(rows[0]) and rows[y][x] == "."
    while heap:
        length, (x, y) = heapq.heappop(heap)
        if (x, y) in lengths:
            continue
        lengths[x, y] = length
        for dx in (-1, 0, 1):
            for dy in (-1, 0, 1):
                if (dx or dy) and is_free(x + dx, y + dy) and is_free(x + dx, y) and is_free(x, y + dy):
                    heapq.heappush(heap, (length + math.hypot(dx, dy), (x + dx, y + dy)))
    return lengths


class Plan(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.path = pathlib.Path(self.folder.name)
        self.out = self.path / "out"

    def tearDown(self):
        self.folder.cleanup()

    def write(self, name, text):
        file = self.path / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)
        return file

    def write_map(self, name, rows):
        return self.write(name, f"type octile\nheight {len(rows)}\nwidth {len(rows[0])}\nmap\n" + "\n".join(rows) + "\n")

    def patrol(self, *arguments):
        return subprocess.run([PATROL, "plan", *map(str, arguments)], capture_output=True, text=True, timeout=120, cwd=SOURCE)

    def plan(self, *arguments, code=0):
        """Runs it with --out, and gives plan.json."""
        done = self.patrol(*arguments, "--out", self.out)
        self.assertEqual(done.returncode, code, done.stderr + done.stdout)
        self.assertEqual(done.stderr, "")
        self.assertFalse((self.out / "INCOMPLETE").exists())
        self.printed = done.stdout
        return json.loads((self.out / "plan.json").read_text())

    def rows(self, name):
        with open(self.out / name, newline="") as file:
            return list(csv.DictReader(file))

    def refuse(self, *arguments, says):
        done = self.patrol(*arguments, "--out", self.out)
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertEqual(len(done.stderr.strip().splitlines()), 1, done.stderr)
        self.assertEqual(done.stdout, "")
        for part in says:
            self.assertIn(part, done.stderr)
        self.assertFalse(self.out.exists(), "something was left")

    # MovingAI

    def drawn_problems(self, named="drawn.map", count=60):
        """A map of 40 x 30 cells, a third of them trees, and problems with the lengths of the test's own Dijkstra."""
        chance = random.Random(5)
        rows = ["".join("T" if chance.random() < 0.3 else "." for _ in range(40)) for _ in range(30)]
        lines = ["version 1"]
        free = [(x, y) for y in range(30) for x in range(40) if rows[y][x] == "."]
        while len(lines) <= count:
            lengths = octile_lengths(rows, chance.choice(free))
            start, goal = min(lengths, key=lengths.get), chance.choice(sorted(lengths))
            lines.append(f"{int(lengths[goal] / 4)}\t{named}\t40\t30\t{start[0]}\t{start[1]}\t{goal[0]}\t{goal[1]}\t{lengths[goal]:.8f}")
        self.write_map("drawn.map", rows)
        return rows, self.write("drawn.map.scen", "\n".join(lines) + "\n")

    def test_a_star_and_dijkstra_have_the_published_length_of_every_problem(self):
        _, file = self.drawn_problems()
        for planner in ("astar", "dijkstra"):
            plan = self.plan(file, "--planner", planner)
            self.assertEqual((plan["num_problems"], plan["num_agree"], plan["num_failed"]), (60, 60, 0))
            self.assertLess(plan["worst_difference_cells"], 1e-4)
            self.assertEqual(len(self.rows("problems.csv")), 60)

    def test_any_angle_routes_are_never_longer_and_others_never_shorter_than_the_any_angle_optimum(self):
        _, file = self.drawn_problems()
        first = self.write("first.map.scen", "\n".join(file.read_text().splitlines()[:21]) + "\n")  # ants take long
        lengths = {}
        for planner in PLANNERS[:6]:
            self.assertEqual(self.plan(first if planner.startswith("ant") else file, "--planner", planner)["num_failed"], 0, planner)
            lengths[planner] = [float(row["length_cells"]) for row in self.rows("problems.csv")]
        for planner, values in lengths.items():
            for value, best, octile in zip(values, lengths["visibility_graph"], lengths["astar"]):
                self.assertGreaterEqual(value, best - 1e-6, planner)
                if planner == "theta_star":
                    self.assertLessEqual(value, octile + 1e-6)
        self.assertLess(sum(lengths["theta_star"]), 0.99 * sum(lengths["astar"]))

    def test_a_map_is_found_beside_the_file_by_the_last_part_of_its_name(self):
        _, file = self.drawn_problems(named="maps/dao/drawn.map")
        self.assertEqual(self.plan(file, "--planner", "astar")["num_agree"], 60)

    def test_a_wrong_length_is_1_and_named_by_its_line(self):
        _, file = self.drawn_problems()
        lines = file.read_text().splitlines()
        lines[7] = lines[7].rsplit("\t", 1)[0] + "\t999.0"
        file.write_text("\n".join(lines))
        plan = self.plan(file, "--planner", "astar", code=1)
        self.assertEqual((plan["num_agree"], plan["num_failed"]), (59, 1))
        self.assertIn("drawn.map.scen:8: ", self.printed)

    def test_six_printed_digits_agree_and_a_length_off_by_a_thousandth_of_a_cell_does_not(self):
        """Many .scen files print six significant digits: above 100 cells a correct length is off by up to 0.0005."""
        size, longest = 101, 100 * math.sqrt(2)  # along the diagonal: 141.421356 cells
        self.write_map("open.map", ["." * size] * size)
        printed = "version 1\n" + "".join(f"0\topen.map\t{size}\t{size}\t{k}\t{k}\t100\t100\t{math.sqrt(2) * (100 - k):.6g}\n" for k in range(0, 25, 4))
        plan = self.plan(self.write("open.scen", printed), "--planner", "astar")
        self.assertEqual((plan["num_agree"], plan["num_failed"]), (7, 0))
        self.assertGreater(plan["worst_difference_cells"], 1e-4, "the rounding is larger than the tolerance of exact lengths")
        for wrong in (longest + 0.001, longest - 0.001):
            bad = printed.replace(f"\t{longest:.6g}\n", f"\t{wrong:.6g}\n")
            self.assertNotEqual(bad, printed)
            self.assertEqual(self.plan(self.write("bad.scen", bad), "--planner", "astar", code=1)["num_failed"], 1)
            self.assertIn("bad.scen:2: ", self.printed)

    def test_every_planner_finds_a_way_on_a_drawn_map_that_is_no_shorter_than_the_optimum(self):
        rows = ["........", ".@@@@@@.", "......@.", ".@@@@.@.", "....@...", ".@@.@.@.", "........"]
        file = self.write_map("rooms.map", rows)
        octile = octile_lengths(rows, (0, 0))[4, 2]
        for planner in PLANNERS:
            plan = self.plan(file, "--from", "0,0", "--to", "4,2", "--planner", planner)
            self.assertEqual(plan["status"], "found")
            self.assertAlmostEqual(plan["references"]["octile_length_cells"], octile, places=6)
            self.assertGreaterEqual(plan["route"]["length_cells"], plan["references"]["any_angle_length_cells"] - 1e-9)
            points = [(float(row["x_cells"]), float(row["y_cells"])) for row in self.rows("route.csv")]
            self.assertEqual((points[0], points[-1]), ((0.0, 0.0), (4.0, 2.0)))
            self.assertAlmostEqual(sum(map(math.dist, points, points[1:])), plan["route"]["length_cells"], places=5)

    def test_no_way_is_1_and_so_is_a_blocked_end_with_the_nearest_free_cell(self):
        file = self.write_map("wall.map", ["...@...", "...@@..", "...@..."])
        self.assertEqual(self.plan(file, "--from", "0,0", "--to", "6,2", code=1)["status"], "no route")
        self.assertFalse((self.out / "route.csv").exists())
        self.assertEqual(self.plan(file, "--from", "0,0", "--to", "4,1", code=1)["status"], "goal blocked")
        self.assertIn("--to: 4, 1 is occupied; the nearest free cell is at", self.printed)
        self.assertIn(", 1.00 cells away", self.printed)
        self.assertEqual(self.plan(file, "--from", "3,0", "--to", "0,0", code=1)["status"], "start blocked")
        self.assertIn("--from: 3, 0 is occupied", self.printed)

    def test_the_start_is_a_way_to_itself(self):
        plan = self.plan(self.write_map("one.map", ["."]), "--from", "0,0", "--to", "0,0")
        self.assertEqual((plan["status"], plan["route"]["length_cells"], plan["route"]["points"]), ("found", 0.0, 1))

    def test_the_same_seed_gives_the_same_files(self):
        _, file = self.drawn_problems(count=10)
        kept = []
        for seed in (4, 4, 5):
            plan = self.plan(file, "--planner", "ant_system", "--seed", seed)
            del plan["performance"]
            kept.append((plan, (self.out / "problems.csv").read_bytes()))
        self.assertEqual(kept[0], kept[1])
        self.assertNotEqual(kept[0][1], kept[2][1])

    # map_server

    def farthest_mark(self):
        goals = json.loads((TUNNEL.parent / "nav.json").read_text())
        return max((goal["position"][:2] for goal in goals), key=lambda p: math.hypot(*p))

    def test_the_tracked_robot_finds_its_way_from_the_post_to_the_tunnels_farthest_mark(self):
        goal = self.farthest_mark()
        straight_m = math.hypot(*goal)
        plan = self.plan(TUNNEL, "--from", "0,0", "--to", f"{goal[0]},{goal[1]}", "--robot", "tracked")
        route, best = plan["route"], plan["references"]
        self.assertGreater(straight_m, 100.0)
        self.assertTrue(straight_m - 0.2 < best["any_angle_length_m"] <= route["length_m"] <= best["octile_length_m"] < 1.05 * straight_m, plan)
        self.assertLessEqual(route["cost_m"], best["octile_cost_m"])
        points = [(float(row["x_m"]), float(row["y_m"])) for row in self.rows("route.csv")]
        self.assertLess(math.dist(points[0], (0.0, 0.0)), 0.08)  # within its cell of 0.1 m
        self.assertLess(math.dist(points[-1], goal), 0.08)
        self.assertAlmostEqual(sum(map(math.dist, points, points[1:])), route["length_m"], places=4)
        self.assertEqual((self.out / "route.png").read_bytes()[:8], b"\x89PNG\r\n\x1a\n")

    def test_the_robot_keeps_its_half_width_and_margins_from_every_occupied_cell(self):
        goal = self.farthest_mark()
        self.plan(TUNNEL, "--from", "0,0", "--to", f"{goal[0]},{goal[1]}", "--robot", "tracked")
        points = [(float(row["x_m"]), float(row["y_m"])) for row in self.rows("route.csv")]
        image = (TUNNEL.parent / "map.pgm").read_bytes()
        magic, size, depth, pixels = image.split(b"\n", 3)
        width, height = map(int, size.split())
        least = math.inf
        for a, b in zip(points, points[1:]):
            steps = max(1, int(math.dist(a, b) / 0.1))
            for i in range(steps + 1):
                x, y = a[0] + (b[0] - a[0]) * i / steps, a[1] + (b[1] - a[1]) * i / steps
                col, row = int((x + 136.05) / 0.05), int((y + 11.75) / 0.05)
                for r in range(max(0, row - 16), min(height, row + 17)):
                    for c in range(max(0, col - 16), min(width, col + 17)):
                        if pixels[(height - 1 - r) * width + c] == 0:
                            least = min(least, math.hypot(-136.05 + 0.05 * (c + 0.5) - x, -11.75 + 0.05 * (r + 0.5) - y))
        self.assertGreater(least, 0.45)  # the tracked robot is more than 0.8 m wide

    def test_a_wider_disc_has_no_more_room_and_at_last_none(self):
        passable = []
        for radius_m in (0.1, 0.4, 1.0):
            plan = self.plan(TUNNEL, "--from", "-40,0", "--to", "-60,0", "--radius-m", radius_m)
            passable.append(plan["grid"]["passable_cells"])
        self.assertTrue(passable[0] > passable[1] > passable[2] > 0, passable)
        plan = self.plan(TUNNEL, "--from", "-40,0", "--to", "-60,0", "--radius-m", 9, code=1)
        self.assertEqual((plan["grid"]["passable_cells"], plan["status"]), (0, "start blocked"))
        self.assertIn("the map has no free cell", self.printed)

    def test_unknown_ground_is_crossed_only_if_it_is_allowed(self):
        self.write("m.pgm", "P2\n5 1\n255\n254 254 205 254 254\n")
        file = self.write("m.yaml", "image: m.pgm\nresolution: 0.1\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n")
        ends = ("--from", "0.05,0.05", "--to", "0.45,0.05")
        self.assertEqual(self.plan(file, *ends, code=1)["status"], "no route")
        plan = self.plan(file, *ends, "--set", "allow_unknown=true")
        self.assertAlmostEqual(plan["route"]["length_m"], 0.4)

    # tours

    STATIONS = "name,x,y,service_s,latest_s\nfar,-109.3,-5.7,30,\nnear,-31.5,-0.2,10,\n\"ring, 7\",-60,1,,400\n"

    def test_a_tour_is_the_best_of_all_orders(self):
        rows = ["." * 30 for _ in range(20)]
        places = [(0, 0), (29, 19), (3, 15), (20, 2), (11, 11)]
        file = self.write_map("open.map", rows)
        stations = self.write("s.csv", "name,x,y\n" + "".join(f"s{i},{x},{y}\n" for i, (x, y) in enumerate(places[1:])))
        best = min(sum(map(math.dist, tour, tour[1:])) for order in itertools.permutations(places[1:]) for tour in [[places[0], *order, places[0]]])
        tour = self.plan(file, "--from", "0,0", "--stations", stations)["tour"]
        self.assertTrue(tour["is_exact"])
        self.assertAlmostEqual(tour["length_cells"], best, places=6)
        self.assertAlmostEqual(tour["completion_s"], best, places=6)  # at a cell a second

    def test_a_tour_of_the_tunnel_has_its_times_and_ends_where_it_is_told(self):
        stations = self.write("s.csv", self.STATIONS)
        plan = self.plan(TUNNEL, "--from", "0,0", "--to", "-90,0", "--stations", stations, "--robot", "tracked", "--speed-mps", "0.5")
        visits = self.rows("tour.csv")
        self.assertEqual([visit["name"] for visit in visits][0::4], ["start", "end"])
        self.assertEqual({visit["name"] for visit in visits[1:4]}, {"far", "near", "ring, 7"})
        self.assertAlmostEqual(plan["tour"]["completion_s"], plan["tour"]["length_m"] / 0.5 + 40.0, places=6)
        self.assertAlmostEqual(float(visits[-1]["arrives_s"]), plan["tour"]["completion_s"], places=6)
        self.assertTrue((self.out / "route.png").exists())

    def test_an_unreachable_station_and_a_missed_window_are_1_and_named(self):
        stations = self.write("s.csv", self.STATIONS + "in the wall,-50,3.4,,\n")
        plan = self.plan(TUNNEL, "--from", "0,0", "--stations", stations, "--robot", "tracked", code=1)
        self.assertEqual(plan["tour"]["unreachable"], ["in the wall"])
        self.assertEqual(len(plan["visits"]), 5)
        self.assertIn("UNREACHABLE  in the wall", self.printed)
        self.assertIn("in the wall: -50.00, 3.40 is unknown in the map; the nearest free cell is at", self.printed)
        plan = self.plan(TUNNEL, "--from", "0,0", "--stations", self.write("late.csv", "name,x,y,latest_s\nfar,-100,-2,5\n"), code=1)
        self.assertGreater(plan["tour"]["lateness_s"], 90.0)
        self.assertIn("1 window missed", self.printed)

    # bad input

    def test_bad_input_is_one_line_and_leaves_nothing(self):
        there = ("--from", "0,0", "--to", "-20,0")
        stations = self.write("s.csv", "name,x,y\na,-10,0\nb,one,2\n")
        outside = self.write("far.csv", "name,x,y\na,-10,0\nb,900,0\n")
        rows, problems = self.drawn_problems()
        self.write("broken.map", "type octile\nheight 2\nwidth 3\nmap\n...\n..\n")
        lost = self.write("lost.scen", "version 1\n0\tgone/lost.map\t3\t3\t0\t0\t1\t1\t1.4\n")
        for arguments, says in [
            ((self.path / "gone.yaml", *there), ["gone.yaml"]),
            ((self.path / "gone.map", *there), ["gone.map"]),
            ((self.path / "gone.scen",), ["gone.scen"]),
            ((SOURCE / "README.md", *there), ["README.md", ".yaml", ".map", ".scen"]),
            ((self.path / "broken.map", "--from", "0,0", "--to", "1,1"), ["broken.map:6", "row 1"]),
            ((TUNNEL,), ["--from"]),
            ((TUNNEL, "--from", "0,0"), ["--to", "--stations"]),
            ((TUNNEL, "--from", "400,3", "--to", "0,0"), ["--from: 400, 3 is outside the map, which spans x -136.65 ... 21.80 m, y -11.70 ... 3.45 m"]),
            ((TUNNEL, "--from", "0,0", "--to", "nan,3"), ["--to: nan,3"]),
            ((TUNNEL, "--from", "0", "--to", "1,3"), ["--from: 0:"]),
            ((TUNNEL, *there, "--planner", "crow"), ["crow", "theta_star"]),
            ((TUNNEL, *there, "--robot", "hovering"), ["robot = hovering", "cart, quadruped, tracked, wheeled"]),
            ((TUNNEL, *there, "--radius-m", "-1"), ["--radius-m"]),
            ((TUNNEL, *there, "--robot", "tracked", "--radius-m", "1"), ["--robot and --radius-m"]),
            ((TUNNEL, *there, "--set", "routes.ant_colony.antz=3"), ["routes.ant_colony.antz", "ants"]),
            ((TUNNEL, *there, "--set", "seed=many"), ["seed"]),
            ((TUNNEL, "--from", "0,0", "--stations", stations), ["s.csv:3", "x: one"]),
            ((TUNNEL, "--from", "0,0", "--stations", outside), ["far.csv:3", "b", "outside the map"]),
            ((TUNNEL, "--from", "0,0", "--stations", self.path / "gone.csv"), ["gone.csv"]),
            ((self.path / "drawn.map", "--from", "0,0", "--to", "40,0"), ["--to: 40, 0 is outside the map, which spans x 0 ... 39, y 0 ... 29 (cells)"]),
            ((self.path / "drawn.map", "--from", "0.5,0", "--to", "1,0"), ["--from", "integers"]),
            ((self.path / "drawn.map", "--from", "0,0", "--to", "1,0", "--robot", "tracked"), ["drawn.map", "--robot"]),
            ((problems, "--from", "0,0"), ["--from"]),
            ((lost,), ["lost.scen:2", "gone/lost.map"]),
        ]:
            with self.subTest(arguments=arguments):
                self.refuse(*arguments, says=says)

    def test_a_directory_that_holds_something_else_is_left_alone(self):
        self.write("out/letter.txt", "dear")
        done = self.patrol(self.write_map("one.map", ["."]), "--from", "0,0", "--to", "0,0", "--out", self.out)
        self.assertEqual(done.returncode, 2)
        self.assertIn("letter.txt", done.stderr)
        self.assertEqual([file.name for file in self.out.iterdir()], ["letter.txt"])


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v"])
