#!/usr/bin/env python3
"""Every kind of bad input gets one clear line, exit code 2, and nothing half-written.

usage: bad_input_test.py PATROL SOURCE_DIR
"""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time
import unittest

PATROL, SOURCE = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
SHORT = SOURCE / "worlds/street/scenarios/short.yaml"


class BadInput(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.out = pathlib.Path(self.folder.name) / "run"

    def tearDown(self):
        self.folder.cleanup()

    def scenario(self, text):
        file = pathlib.Path(self.folder.name) / "scenario.yaml"
        file.write_text(text)
        return file

    def refuse(self, *arguments, says):
        """Runs patrol, which must refuse with one line that holds every part of `says`."""
        done = subprocess.run([PATROL, *map(str, arguments)], capture_output=True, text=True, timeout=60, cwd=SOURCE)
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertEqual(len(done.stderr.strip().splitlines()), 1, done.stderr)
        for part in says:
            self.assertIn(part, done.stderr)
        self.assertFalse(self.out.exists(), "something was left in the run directory")

    def refuse_run(self, scenario, *more, says):
        self.refuse("run", scenario, "--out", self.out, *more, says=says)

    def test_unknown_key_names_file_line_and_nearest_spelling(self):
        file = self.scenario("world: street\nsensors:\n  lidar: {range_noise_st_m: 0.03}\n")
        self.refuse_run(file, says=["scenario.yaml:3", "sensors.lidar.range_noise_st_m", "did you mean range_noise_std_m?"])

    def test_renamed_key_names_the_new_one(self):
        file = self.scenario("world: tunnel\nremote: {drive: drive.json}\n")
        self.refuse_run(file, says=["scenario.yaml:2", "remote: renamed to teleop"])
        file = self.scenario("sensors:\n  uwb: {blocked_loss: 0.1}\n")
        self.refuse_run(file, says=["scenario.yaml:2", "sensors.uwb.blocked_loss: renamed to sensors.uwb.nlos_loss_probability"])

    def test_an_override_is_named_instead_of_the_file(self):
        self.refuse_run(SHORT, "--set", "time_limit_s=nan", says=["patrol: --set time_limit_s=nan: must be a number, not nan"])
        self.refuse_variants("sweep", "--vary", "time_limit_s=1,nan", says=["patrol: --vary time_limit_s=nan: must be a number, not nan"])

    def test_a_varied_seed_is_refused_before_anything_is_written(self):
        self.refuse_variants("sweep", "--vary", "seed=1,2", says=["--vary seed=1,2: seeds are varied with --seeds"])

    def test_an_unknown_metric_is_refused_with_the_nearest(self):
        self.refuse_variants("sweep", "--metric", "foo.bar", says=["--metric foo.bar: unknown metric"])
        self.refuse_run(SHORT, "--set", "expect.mission.colisions=0",
                        says=["--set expect.mission.colisions=0: unknown metric; did you mean mission.collisions?"])
        file = self.scenario("world: street\nexpect:\n  mission.colisions: 0\n")
        self.refuse_run(file, says=["scenario.yaml:3: expect.mission.colisions: unknown metric"])

    def test_numbers_of_options_that_are_none(self):
        self.refuse_run(SHORT, "--snapshot-every", "nan", says=["--snapshot-every", "nan: must be a number in [-1e9, 1e9]"])
        self.refuse_run(SHORT, "--snapshot-every", "0", says=["--snapshot-every", "0: must be above 0"])
        self.refuse("run", "--from", "base@1e300", "--out", self.out, says=["--from base@1e300: must be RUN@SECONDS"])
        self.refuse("trace", "base", "--to-s", "nan", says=["--to-s", "nan"])
        self.refuse("trace", "base", "--to-s", "-1", says=["--to-s", "-1: must be at least 0"])
        self.refuse("score", "--estimate", "a", "--reference", "b", "--max-dt-s", "-1", says=["--max-dt-s: Value -1 not in range"])

    def test_a_snapshot_period_below_one_tick(self):
        for period_s in ("1e-09", "0.0019"):
            self.refuse_run(SHORT, "--snapshot-every", period_s, says=[f"patrol: --snapshot-every {period_s}: must be at least 0.002 s, one tick"])

    def test_names_of_options_that_are_none(self):
        self.refuse("replay", "base", "--camera", "side", says=["patrol: --camera side: must be one of chase, top, onboard"])
        self.refuse("replay", "base", "--style", "fast", says=["patrol: --style fast: must be one of highlights, continuous"])
        self.refuse("replay", "base", "--renderer", "glx", says=["patrol: --renderer glx: must be one of auto, egl, osmesa"])
        self.refuse_variants("sweep", "--keep-runs", "some", says=["patrol: --keep-runs some: must be one of none, failed, all"])
        world = pathlib.Path(self.folder.name) / "map.yaml"
        world.write_text("image: map.pgm\nresolution: 1\norigin: [0, 0, 0]\n")
        (world.parent / "map.pgm").write_bytes(b"P5 4 4 255\n" + bytes([254]) * 16)
        self.refuse("plan", world, "--from", "1,1", "--to", "2,2", "--planner", "nope", says=["patrol: --planner nope: must be one of astar, dijkstra"])

    def test_a_run_directory_excludes_files_to_score(self):
        self.refuse("score", "base", "--estimate", "a.tum", "--reference", "b.tum", says=["--estimate: excludes a run directory"])
        self.refuse("score", "base", "--max-dt-s", "0.1", says=["--max-dt-s", "exclude a run directory"])
        self.refuse("score", "--estimate", "a", "--map", "m", "--reference-map", "r", says=["--estimate: needs --reference or --relations"])
        self.refuse("score", "--estimate", "a", "--reference", "b", "--map", "m", says=["--map: needs --reference-map"])
        self.refuse("score", "--estimate", "a", "--reference", "b", "--reference-x-m", "0.1", says=["--reference-x-m: needs --relations"])
        self.refuse("feed", self.folder.name, "--max-dt-s", "0.1", says=["--max-dt-s and --reference-x-m: only for a recorded log"])
        for option in ("--robot-name", "--monitor-token-file"):
            self.refuse("run", "street/short", option, "rex", says=[f"{option}: needs --monitor-url"])

    def test_wrong_unit_is_an_unknown_key_that_names_the_right_unit(self):
        file = self.scenario("sensors:\n  lidar: {range_noise_std_cm: 3}\n")
        self.refuse_run(file, says=["scenario.yaml:2", "range_noise_std_cm", "range_noise_std_m"])

    def test_wrong_type(self):
        file = self.scenario("seed: many\n")
        self.refuse_run(file, says=["scenario.yaml:1", "seed", "many"])

    def test_nan(self):
        file = self.scenario("sensors:\n  lidar: {range_noise_std_m: .nan}\n")
        self.refuse_run(file, says=["scenario.yaml:2", "range_noise_std_m"])

    def test_out_of_range_names_the_rule(self):
        file = self.scenario("sensors:\n  lidar: {range_noise_std_m: -1}\n")
        self.refuse_run(file, says=["scenario.yaml:2", "range_noise_std_m", "at least 0"])

    def test_a_second_document_or_text_after_the_first(self):
        file = self.scenario("world: street\n---\nworld: tunnel\n")
        self.refuse_run(file, says=["scenario.yaml:2", "only one is allowed"])
        self.refuse_run(SHORT, "--set", "leaks=[]x", says=["--set leaks=[]x", "only one is allowed"])

    def test_an_empty_scenario_or_calibration(self):
        file = self.scenario("# nothing\n")
        self.refuse_run(file, says=["scenario.yaml", "is empty"])
        log = pathlib.Path(self.folder.name) / "log.log"
        log.write_text("FLASER 3 1 1 1 0 0 0 0 0 0 0 host 0\n")
        self.refuse("slam", log, "--calibration", file, "--out", self.out, says=["scenario.yaml", "is empty"])

    def test_an_origin_of_two_numbers(self):
        world = pathlib.Path(self.folder.name) / "map.yaml"
        world.write_text("image: map.pgm\nresolution: 1\norigin: [0, 0]\n")
        self.refuse("plan", world, "--from", "0,0", "--to", "1,1", "--out", self.out, says=["map.yaml:3", "origin", "three numbers"])

    def test_seeds_that_are_no_seeds(self):
        for seed in ("-1", "18446744073709551616", "1.5", "010", "0x10"):
            self.refuse_run(SHORT, f"--seed={seed}", says=["--seed", seed])
        self.refuse("slam", "absent.log", "--seed=-1", "--out", self.out, says=["--seed", "-1"])
        self.refuse("plan", "absent.yaml", "--seed=-1", "--out", self.out, says=["--seed", "-1"])

    def test_numbers_that_are_not_finite(self):
        for number in ("1e400", "inf", "nan", "1e10"):
            self.refuse_variants("sweep", f"--run-timeout-s={number}", says=["--run-timeout-s", number])
        self.refuse_variants("localizability", "--grid-step-m=1e400", says=["--grid-step-m", "1e400"])
        self.refuse_variants("fault-matrix", "--start-s=nan", says=["--start-s", "nan"])
        self.refuse_variants("fault-matrix", "--duration-s=1e400", says=["--duration-s", "1e400"])
        self.refuse_variants("sweep", "--equivalence-margin=1e400", says=["--equivalence-margin", "1e400"])
        for option in ("--speed", "--highlight-speed", "--still"):
            self.refuse("replay", "absent", f"{option}=1e400", says=[option, "1e400"])
        self.refuse("upload", "absent", "--monitor-url=http://localhost:1", "--timeout-s=1e400", says=["--timeout-s", "1e400"])
        for option in ("--radius-m", "--speed-mps"):
            self.refuse("plan", "absent.yaml", f"{option}=-1e400", says=[option, "1e400"])
        for option in ("--max-dt-s", "--reference-x-m"):
            self.refuse("score", "absent", f"{option}=1e400", says=[option, "1e400"])

    def test_devices_pipes_and_large_files(self):
        folder = pathlib.Path(self.folder.name)
        os.mkfifo(folder / "pipe")
        large = self.scenario("world: street\n")
        begin = time.monotonic()
        self.refuse_run(SHORT, "--set", "mission=/dev/zero", says=["/dev/zero", "not a regular file"])
        self.refuse_run(SHORT, "--set", f"mission={folder / 'pipe'}", says=["pipe", "not a regular file"])
        self.refuse_run("/dev/zero", says=["/dev/zero", "not a regular file"])
        os.truncate(large, 17 << 20)
        self.refuse_run(large, says=["scenario.yaml", "too large"])
        self.assertLess(time.monotonic() - begin, 4.0, "four refusals, each well under a second")

    def test_a_yaml_list_without_end_takes_little_memory(self):
        file = self.scenario("world: street\nactors: [" + "1," * (7 << 20) + "1]\n")
        code = ("import resource, subprocess, sys; done = subprocess.run(sys.argv[1:], capture_output=True, text=True); "
                "print(done.returncode, resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss // 1024, done.stderr)")
        done = subprocess.run([sys.executable, "-c", code, PATROL, "run", file, "--out", self.out], capture_output=True, text=True, timeout=60)
        returncode, memory_mb, said = done.stdout.split(maxsplit=2)
        self.assertEqual(returncode, "2")
        self.assertIn("too many values", said)
        self.assertLess(int(memory_mb), 300)

    def test_truncated_yaml(self):
        file = self.scenario("sensors:\n  lidar: {range_noise_std_m: 0.03\n")
        self.refuse_run(file, says=["scenario.yaml"])

    def test_missing_scenario(self):
        self.refuse_run(pathlib.Path(self.folder.name) / "absent.yaml", says=["absent.yaml"])

    def test_unknown_world_names_the_known_ones(self):
        self.refuse_run(SHORT, "--set", "world=moon", says=["world", "moon", "street"])

    def test_missing_mission_file(self):
        self.refuse_run(SHORT, "--set", "mission=routes/absent.json", says=["mission", "absent.json"])

    def test_unknown_override(self):
        self.refuse_run(SHORT, "--set", "stack.slam.rbpf.particels=3", says=["particels", "particles"])

    def test_start_inside_a_wall(self):
        self.refuse_run(SHORT, "--set", "start.left_m=10", says=["start"])

    def test_an_error_of_a_scenario_names_its_file_and_line(self):
        text = SHORT.read_text()
        for old, new, says in (
                ("routes/short.json", "routes/nosuch.json", ["scenario.yaml:6: mission = routes/nosuch.json: ", "not found"]),
                ("mission: routes/short.json", "mission: routes/short.json\nreferences: nosuch", ["scenario.yaml:7: references = nosuch: "]),
                ("mission: routes/short.json", "mission: routes/short.json\ngoals: nosuch.json", ["scenario.yaml:7: goals = nosuch.json: "]),
                ("valve_well_0, rate", "nosuch, rate", ["scenario.yaml:8: leaks: unknown site at = 'nosuch'"]),
                ("mission: routes/short.json", "mission: routes/short.json\ntour: {stations: [{x_m: 1, y_m: 0}]}",
                 ["scenario.yaml:6: mission and tour are mutually exclusive"])):
            self.refuse_run(self.scenario(text.replace(old, new)), says=says)
        more = "stack:\n  mission_type: tunnel\n"
        num_lines = len(text.splitlines())
        self.refuse_run(self.scenario(text + more), says=[f"scenario.yaml:{num_lines + 2}: stack.tunnel_mission: requires goals"])
        self.refuse_run(self.scenario(text + more + "  tunnel_mission:\n    goal_types: S\n"),
                        says=[f"scenario.yaml:{num_lines + 4}: stack.tunnel_mission.goal_types = S: must consist of the letters"])
        self.refuse_run(SHORT, "--set", "leaks.0.at=nosuch", says=["--set leaks.0.at=nosuch: leaks: unknown site"])
        self.refuse_run(SHORT, "--set", "leaks.0.at=imu", says=["--set leaks.0.at=imu: leaks: at = imu: site of the body"])

    def test_a_kidnap_to_where_the_robot_cannot_stand(self):
        self.refuse_run(SHORT, "--set", "kidnaps=[{at_s: 5, x_m: 1000, y_m: 1000}]",
                        says=["--set kidnaps=[{at_s: 5, x_m: 1000, y_m: 1000}]: kidnaps.0: (1000.00, 1000.00): no ground below"])

    def test_a_fault_without_effect(self):
        file = self.scenario(SHORT.read_text() + "faults:\n  - {sensor: hall, kind: delay}\n")
        self.refuse_run(file, says=["scenario.yaml:", "faults.0.sensor = hall: quadruped has no such sensor"])
        file = self.scenario(SHORT.read_text() + "faults:\n  - {sensor: imu, kind: delay, magnitude: -3}\n")
        self.refuse_run(file, says=["scenario.yaml:", "faults.0.magnitude = -3: must be at least 0 for delay"])

    def test_an_expectation_of_an_unknown_station(self):
        self.refuse_run(SHORT, "--set", "expect.stations.nosuch.reached=true", says=["unknown station nosuch: must be one of "])

    def test_an_empty_output_directory(self):
        self.refuse("run", SHORT, "--out", "", says=["--out: is empty: must name a directory for the run"])

    def test_leak_at_an_unknown_place(self):
        self.refuse_run(SHORT, "--set", "leaks.0.at=nowhere", says=["nowhere"])

    def test_costmap_coarser_than_the_map(self):
        self.refuse_run(SHORT, "--set", "stack.slam.graph.scan_odometry.resolution_m=0.2", says=["costmap.resolution_m", "0.2"])

    def test_robot_without_the_methane_meters_frame(self):
        root = pathlib.Path(self.folder.name)
        shutil.copytree(SOURCE / "worlds", root / "worlds")
        shutil.copytree(SOURCE / "models", root / "models")
        urdf = root / "models/quadruped/quadruped.urdf"
        urdf.write_text(urdf.read_text().replace('"tdlas"', '"sniffer"'))
        self.refuse_run(root / "worlds/street/scenarios/short.yaml", says=["quadruped", "tdlas"])

    def refuse_variants(self, command, *more, says):
        self.refuse(command, SHORT, "--out", self.out, *more, says=says)

    def test_fault_matrix_of_a_missing_scenario(self):
        self.refuse("fault-matrix", "absent.yaml", "--out", self.out, says=["absent.yaml"])

    def test_faults_before_the_start(self):
        self.refuse_variants("fault-matrix", "--start-s", -1, says=["--start-s", "-1"])
        self.refuse_variants("fault-matrix", "--start-s", 5000, says=["--start-s 5000", "time_limit_s"])
        self.refuse_variants("fault-matrix", "--duration-s", 0, says=["--duration-s"])
        self.refuse_variants("fault-matrix", "--max-error-m", -1, says=["--max-error-m"])
        self.refuse_variants("fault-matrix", "--min-map-coverage", 7, says=["--min-map-coverage"])
        self.refuse_variants("fault-matrix", "--max-lost-s", -5, says=["--max-lost-s"])

    def test_budget_of_one_seed(self):
        self.refuse_variants("error-budget", "--seeds", 1, says=["--seeds", "two"])

    def test_sweep_over_an_unknown_key(self):
        self.refuse_variants("sweep", "--vary", "sensors.lidar.range_noise_st_m=0.1,0.2", says=["range_noise_st_m", "range_noise_std_m"])

    def test_places_that_are_no_distance_apart(self):
        self.refuse_variants("localizability", "--grid-step-m", 0, says=["--grid-step-m 0"])

    def test_report_of_a_sweep_that_is_not_finished(self):
        (pathlib.Path(self.folder.name) / "INCOMPLETE").touch()
        (pathlib.Path(self.folder.name) / "sweep.json").write_text("{}")
        self.refuse("report", self.folder.name, says=[self.folder.name])
        self.assertFalse((pathlib.Path(self.folder.name) / "report.html").exists())

    def test_a_report_that_would_replace_a_file_of_the_run(self):
        for name in ("log.mcap", "scenario.yaml"):
            file = pathlib.Path(self.folder.name) / name
            file.write_text("mine")
            self.refuse("report", self.folder.name, "--out", file, says=[f"patrol: --out {file}: must end in .html"])
            self.assertEqual(file.read_text(), "mine")

    def test_a_sweep_of_an_unknown_robot(self):
        self.refuse_variants("sweep", "--vary", "robot=quadruped,hovering", says=["robot = hovering: ", "not found (known: cart, quadruped"])
        self.refuse_variants("sweep", "--set", "robot=hovering", says=["robot = hovering: ", "not found (known: cart, quadruped"])

    def test_a_sweep_metric_of_an_unknown_station(self):
        self.refuse_variants("sweep", "--metric", "stations.nowhere.reached", says=["--metric stations.nowhere.reached: unknown station nowhere: must be one of "])

    def test_empty_keys_of_overrides(self):
        for path in ("sensors..lidar", ".seed", "seed."):
            self.refuse_run(SHORT, "--set", f"{path}=3", says=[f"patrol: --set {path}=3: {path} has an empty key"])

    def test_numbers_of_an_association(self):
        for option in ("--max-dt-s", "--reference-x-m"):
            self.refuse("score", "--estimate", "a", "--relations", "b", option, "-11", says=[f"patrol: {option}: ", "-11 not in range"])

    def test_a_users_files_stay(self):
        folder = pathlib.Path(self.folder.name)
        for name in ("scans/notes.ply", "log.mcap/notes"):
            run = folder / name.split("/")[0].replace(".", "_")
            (run / name).parent.mkdir(parents=True)
            (run / name).write_text("mine")
            self.refuse("run", SHORT, "--out", run, says=[str(run), name.split("/")[0]])
            self.assertEqual((run / name).read_text(), "mine")
        run = folder / "linked"
        run.mkdir()
        (folder / "precious").write_text("mine")
        (run / "INCOMPLETE").symlink_to(folder / "precious")
        self.refuse("run", SHORT, "--out", run, says=["INCOMPLETE", "must be a regular file"])
        self.assertEqual((folder / "precious").read_text(), "mine")

    def test_unwritable_output(self):
        self.refuse("run", SHORT, "--out", "/proc/patrol", says=["/proc/patrol"])

    def test_replay_into_a_file_of_an_unknown_format(self):
        self.refuse("replay", "absent", "--out", "film.gif", says=["--out film.gif: must end with .mp4 or .webp"])
        self.refuse("replay", "absent", "--still=1", "--out", "still.jpg", says=["--out still.jpg: must end with .png"])

    def test_unknown_command(self):
        self.refuse("fly", says=["unknown command 'fly' (known: run, trace, bisect, score, "])

    def test_former_names_of_commands_and_options_name_the_present_ones(self):
        self.refuse("send", "absent", "--to", "http://localhost:1", says=["patrol: send: renamed to upload"])
        self.refuse("train-neighbours", "absent", says=["patrol: train-neighbours: renamed to train-neighbors"])
        self.refuse_run(SHORT, "--report-to=http://localhost:1", says=["patrol: --report-to: renamed to --monitor-url"])
        self.refuse_variants("budget", "--keep", "all", says=["patrol: --keep: renamed to --keep-runs"])

    def test_score_of_a_directory_without_a_log(self):
        self.refuse("score", self.folder.name, says=[self.folder.name])

    def test_report_of_a_directory_without_a_log(self):
        self.refuse("report", self.folder.name, says=[self.folder.name, "log.mcap"])

    def test_report_of_a_log_that_cannot_be_read(self):
        shutil.copy(SHORT, pathlib.Path(self.folder.name) / "scenario.yaml")
        (pathlib.Path(self.folder.name) / "log.mcap").write_bytes(b"no log")
        self.refuse("report", self.folder.name, says=["log.mcap"])
        self.assertFalse((pathlib.Path(self.folder.name) / "report.html").exists())


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v"])
