"""Tables of measured results in the documentation: file, commands, values and text of each. Used by tools/results."""
import dataclasses
import json
import pathlib
import typing

from results_tables import (NONE, Row, as_text, benchmark_values, by_seed, csv_values, markdown, pair, run_values, seeds_of, study_table,
                            study_values, sweep_values)

# Seeds of published figures: nothing is tuned on them. Change them here only.
REPORT = "2001..2010"
REPORT_FIVE = "2001..2005"


@dataclasses.dataclass
class Step:
    """Command of a table. `{out}` is the step's folder, `{logs}` the folder of recorded logs."""
    key: str
    command: list
    good_codes: tuple = (0, 1)  # 1: an expectation missed; the figures show it


@dataclasses.dataclass
class Table:
    name: str
    file: str
    seeds: str
    minutes: float  # of wall time on two idle cores, estimated
    steps: list
    values: typing.Callable  # {key of step: folder} -> values for the record
    text: typing.Callable  # values -> Markdown
    logs: tuple = ()  # files below --logs that must exist
    targets: tuple = ("patrol",)  # built before the commands
    needs: tuple = ()  # tables whose records are used; values gets {name: values}


def sweep(key, scenario, seeds, *options):
    return Step(key, ["build/patrol", "sweep", f"worlds/{scenario}.yaml", "--seeds", seeds, *options, "--out", "{out}"])


def study(name, seeds=None):
    return Step("study", ["build/patrol", "study", name, *(["--seeds", seeds] if seeds else []), "--out", "{out}"], (0,))


def swept(**metrics):
    """Values of several sweeps: {key: runs}."""
    return lambda folders: {key: sweep_values(folders[key], patterns) for key, patterns in metrics.items()}


def yes_no(value):
    return "yes" if value else "no"


def count(value):
    return f"{value:.0f}"


TABLES = []


def add(**fields):
    TABLES.append(Table(**fields))


# --- README.md ----------------------------------------------------------------------------------------------------------------

def short_values(folders):
    """Lines that the run printed."""
    said = (folders["run"].parent / "run.txt").read_text()
    return said.replace(str(folders["run"]), "out/short").strip("\n").splitlines()


def short_text(values):
    return "\n".join(["```", *values, "```"])


add(name="street_short", file="README.md", seeds="1", minutes=0.1,
    steps=[Step("run", ["build/patrol", "run", "worlds/street/scenarios/short.yaml", "--seed", "1", "--out", "{out}"])],
    values=short_values, text=short_text)


def span(runs, path, form):
    values = [run["metrics"][path] for run in runs if path in run["metrics"]]
    return f"{format(min(values), form)} to {format(max(values), form)}" if values else NONE


def summary_values(tables):
    patrol, navigation = tables["street_patrol"]["patrol"], tables["tunnel_navigation"]["navigation"]
    scenarios, inspection = tables["tunnel_scenarios"], tables["tunnel_inspection"]["inspection"]
    goals = [span(navigation, f"goals.goal_{i}.position_error_m.mean", ".3f") for i in (1, 2, 3)]
    worst = max(run["metrics"]["docking.position_error_m.max"] for run in scenarios["docking"])
    return {"patrol": span(patrol, "pose.site.ate_rmse_m", ".3f"), "goals": "; ".join(goals), "docking": f"{1000 * worst:.1f}",
            "lining": span(inspection, "inspection.lining.max_error_mm", ".2f"), "patrol_seeds": len(patrol),
            "navigation_seeds": len(navigation), "docking_seeds": len(scenarios["docking"]), "lining_seeds": len(inspection),
            "log": next(row["error"] for row in tables["slam_logs"] if row["log"] == "intel" and row["method"] == "graph"),
            "substation": next(row["mean"] for row in tables["study_substation"]
                               if row["figure"] == "map to nearest surface" and "graph" in row["method"])}


def summary_text(values):
    return markdown(["result", "value", "seeds"], [
        ["[street patrol](worlds/street/README.md), quadruped, 194 m: position error in the survey frame", f"{values['patrol']} m", values["patrol_seeds"]],
        ["[tunnel navigation](worlds/tunnel/README.md), tracked robot: mean errors at goals 1, 2 and 3", f"{values['goals']} m",
         values["navigation_seeds"]],
        ["[tunnel docking](worlds/tunnel/README.md)", f"at most {values['docking']} mm", values["docking_seeds"]],
        ["[lining deformation](worlds/tunnel/README.md#inspection) of 3, 6 and 12 mm: maximum error", f"{values['lining']} mm",
         values["lining_seeds"]],
        ["[recorded log](src/slam/README.md), Intel Research Lab: mean relation error", values["log"], NONE],
        ["[substation map](src/app/study/README.md), 923 m: distance to the nearest surface", f"{float(values['substation']):.3f} m", 5]])


add(name="summary", file="README.md", seeds="those of the linked tables", minutes=0, steps=[],
    needs=("street_patrol", "tunnel_navigation", "tunnel_scenarios", "tunnel_inspection", "slam_logs", "study_substation"),
    values=summary_values, text=summary_text)

# --- worlds/street ------------------------------------------------------------------------------------------------------------

PATROL_ROWS = [
    Row("`pose.site.ate_rmse_m`, in the survey frame", "pose.site.ate_rmse_m"),
    Row("`pose.aligned.rmse_m`", "pose.aligned.rmse_m"),
    Row("`pose.nees.mean`", "pose.nees.mean", ".1f"),
    Row("true calibration within the 95 % intervals: `calibration.within_95`", "calibration.within_95", ".0%", min),
    Row("box 1 in the map: `site_map_error_m`", "stations.regulator_box_1.site_map_error_m"),
    Row("box 2 in the map", "stations.regulator_box_2.site_map_error_m"),
    Row("valve well 3 in the map", "stations.valve_well_3.site_map_error_m"),
    Row("map to nearest surface: `map.nearest_mean_m`", "map.nearest_mean_m"),
    Row("distance walked, m", "mission.distance_m", ".0f", min),
    Row("leaks found / false alarms", pair("inspection.leaks_found", "inspection.false_alarms"), as_text, None),
    Row("falls / collisions", lambda m: f"{m['mission.fell']:d} / {m['mission.collisions']}", as_text, None),
    Row("simulated s per wall s", "performance.real_time_factor", ".1f", min),
]
WU25 = {"box 1 in the map: `site_map_error_m`": "[Wu25] 0.92–1.18", "box 2 in the map": "[Wu25] 0.92–1.18",
        "valve well 3 in the map": "[Wu25] 0.92–1.18"}

add(name="street_patrol", file="worlds/street/README.md", seeds=REPORT, minutes=2,
    steps=[sweep("patrol", "street/scenarios/patrol", REPORT)],
    values=swept(patrol=("mission.*", "pose.site.ate_rmse_m", "pose.aligned.rmse_m", "pose.nees.mean", "calibration.within_95",
                         "stations.*.site_map_error_m", "map.nearest_mean_m", "inspection.*", "performance.real_time_factor")),
    text=lambda values: by_seed(values["patrol"], PATROL_ROWS, WU25))


def methods_text(values):
    def cell(runs, method):
        chosen = [run["metrics"] for run in runs if run["variant"].endswith(method)]
        means = [sum(run[path] for run in chosen) / len(chosen) for path in ("pose.site.ate_rmse_m", "map.nearest_mean_m")]
        return f"{means[0]:.3f}, {means[1]:.3f} m"
    return markdown(["", "`rbpf`", "`graph`"],
                    [[label, cell(values[key], "rbpf"), cell(values[key], "graph")] for label, key in
                     (("street, `patrol.yaml`", "street"), ("tunnel, `mapping.yaml`", "tunnel"))])


add(name="slam_methods", file="worlds/street/README.md", seeds=REPORT_FIVE, minutes=6,
    steps=[sweep("street", "street/scenarios/patrol", REPORT_FIVE, "--vary", "stack.slam.method=rbpf,graph"),
           sweep("tunnel", "tunnel/scenarios/mapping", REPORT_FIVE, "--vary", "stack.slam.method=rbpf,graph")],
    values=swept(street=("pose.site.ate_rmse_m", "map.nearest_mean_m"), tunnel=("pose.site.ate_rmse_m", "map.nearest_mean_m")), text=methods_text)

# --- worlds/tunnel ------------------------------------------------------------------------------------------------------------


def at_goal(goal, quantity, scale, digits):
    def value(metrics):
        mean, std = (metrics.get(f"goals.{goal}.{quantity}.{part}") for part in ("mean", "std"))
        return None if mean is None else f"{scale * mean:.{digits}f} ± {scale * std:.{digits}f}"
    return value


def reached(metrics):
    arrivals = sum(value for path, value in metrics.items() if path.endswith(".arrivals") and path.startswith("goals."))
    return f"{arrivals} / {metrics['mission.collisions']}"


def worst_docking(metrics):
    if "docking.position_error_m.max" not in metrics:
        return None
    return f"{1000 * metrics['docking.position_error_m.max']:.1f} mm, {metrics['docking.heading_error_deg.max']:.1f}°"


NAVIGATION_ROWS = [
    Row("goals reached, of 30 / collisions", reached, as_text, None),
    *(Row(f"goal {i}, cm", at_goal(f"goal_{i}", "position_error_m", 100, 1), as_text, None) for i in (1, 2, 3)),
    *(Row(f"goal {i}, °", at_goal(f"goal_{i}", "heading_error_deg", 1, 2), as_text, None) for i in (1, 2, 3)),
    Row("worst docking", worst_docking, as_text, None),
    Row("`pose.site.ate_rmse_m`", "pose.site.ate_rmse_m"),
    Row("`pose.nees.mean`", "pose.nees.mean", ".1f"),
    Row("track encoders, IMU and UWB: `range_pose.ate_rmse_m`", "range_pose.ate_rmse_m", ".2f"),
    Row("track encoders and IMU: `odometry.ate_rmse_m`", "odometry.ate_rmse_m", ".0f"),
]

add(name="tunnel_navigation", file="worlds/tunnel/README.md", seeds=REPORT, minutes=33,
    steps=[sweep("navigation", "tunnel/scenarios/map_then_navigate", REPORT)],
    values=swept(navigation=("mission.*", "goals.*.arrivals", "goals.*.*.mean", "goals.*.*.std", "docking.*.max",
                             "pose.site.ate_rmse_m", "pose.nees.mean", "range_pose.ate_rmse_m", "odometry.ate_rmse_m")),
    text=lambda values: by_seed(values["navigation"], NAVIGATION_ROWS))

ENDS = ("mission.*", "docking.*.max", "docking.arrivals", "localization.max_error_m", "localization.min_trust",
        "localization.kidnaps.*.*", "pose.site.ate_rmse_m")


def scenarios_text(values):
    def done(runs):
        return f"{sum(run['end'] == 'done' for run in runs)} of {len(runs)} as expected"
    degenerate = {name: [run for run in values["degenerate"] if run["variant"].endswith(name)] for name in ("true", "false")}
    return markdown(["scenario", "seeds", "result"], [
        ["`docking.yaml`", len(values["docking"]),
         f"{done(values['docking'])}; position error {span(values['docking'], 'docking.position_error_m.max', '.4f')} m, heading error "
         f"{span(values['docking'], 'docking.heading_error_deg.max', '.2f')}°"],
        ["`low_obstacles.yaml`", len(values["low_obstacles"]),
         f"{done(values['low_obstacles'])}; collisions {span(values['low_obstacles'], 'mission.collisions', '.0f')}"],
        ["`kidnap.yaml`", len(values["kidnap"]),
         f"{done(values['kidnap'])}; relocalized after {span(values['kidnap'], 'localization.kidnaps.0.relocalized_s', '.1f')} s"],
        ["`degenerate.yaml`", len(degenerate["true"]),
         f"{done(degenerate['true'])}; maximum error {span(degenerate['true'], 'localization.max_error_m', '.3f')} m"],
        ["`degenerate.yaml` without UWB", len(degenerate["false"]),
         f"maximum error {span(degenerate['false'], 'localization.max_error_m', '.3f')} m; minimum confidence "
         f"{span(degenerate['false'], 'localization.min_trust', '.2f')}"],
        ["`bridge.yaml`", len(values["bridge"]),
         f"{done(values['bridge'])}; `pose.site.ate_rmse_m` {span(values['bridge'], 'pose.site.ate_rmse_m', '.3f')} m"]])


add(name="tunnel_scenarios", file="worlds/tunnel/README.md", seeds=f"{REPORT}; low obstacles, kidnap, degenerate and bridge {REPORT_FIVE}",
    minutes=9,
    steps=[sweep("docking", "tunnel/scenarios/docking", REPORT), sweep("low_obstacles", "tunnel/scenarios/low_obstacles", REPORT_FIVE),
           sweep("kidnap", "tunnel/scenarios/kidnap", REPORT_FIVE),
           sweep("degenerate", "tunnel/scenarios/degenerate", REPORT_FIVE, "--vary", "sensors.uwb.enabled=true,false"),
           sweep("bridge", "tunnel/scenarios/bridge", REPORT_FIVE)],
    values=swept(docking=ENDS, low_obstacles=ENDS, kidnap=ENDS, degenerate=ENDS, bridge=ENDS), text=scenarios_text)


INSPECTION_ROWS = [
    Row("ring 20, moved inwards by 3 mm: reported, mm", "inspection.lining.rings.goal_1_ring_20.reported_mm", ".2f", None),
    Row("ring 29, settled by 6 mm", "inspection.lining.rings.goal_2_ring_29.reported_mm", ".2f", None),
    Row("ring 44, bulge of 12 mm", "inspection.lining.rings.goal_3_ring_44.reported_mm", ".2f", None),
    Row("rings: maximum error, mm", "inspection.lining.max_error_mm", ".2f"),
    Row("other rings reported as moved", "inspection.lining.false_findings", count),
    Row("cells (ring × 10°): RMS error, mm", "inspection.lining.cell_rmse_mm", ".2f"),
    Row("coverage of the 95 % intervals of the cells", "inspection.lining.cell_coverage_95", ".1%", min),
    Row("position of the findings, maximum error, m", "inspection.lining.max_place_error_m", ".2f"),
    Row("water body 18 m ahead of the coil: error, m", "inspection.water.position_error_m", ".2f"),
    Row("water bodies missed / false alarms", pair("inspection.water.missed", "inspection.water.false_alarms"), as_text, None),
    Row("95 % interval contains the distance", lambda m: next(
        (yes_no(value) for path, value in m.items() if path.endswith(".distance_holds")), None), as_text, None),
    Row("docking error, mm", lambda m: None if "docking.position_error_m.max" not in m else 1000 * m["docking.position_error_m.max"], ".1f"),
    Row("`pose.site.ate_rmse_m`", "pose.site.ate_rmse_m"),
    Row("`pose.nees.mean`", "pose.nees.mean", ".1f"),
]

add(name="tunnel_inspection", file="worlds/tunnel/README.md", seeds=REPORT, minutes=7,
    steps=[sweep("inspection", "tunnel/scenarios/inspection_round", REPORT)],
    values=swept(inspection=("mission.*", "inspection.lining.*", "inspection.lining.rings.*.reported_mm", "inspection.water.*",
                             "inspection.water.findings.*.distance_holds", "docking.*.max", "pose.site.ate_rmse_m",
                             "pose.nees.mean")),
    text=lambda values: by_seed(values["inspection"], INSPECTION_ROWS))

ROUND_SEEDS = ("2001", "2002")
ROUND_METRICS = ("inspection.lining.max_error_mm", "inspection.lining.false_findings", "inspection.lining.registered",
                 "inspection.water.position_error_m", "inspection.water.missed", "docking.position_error_m.max", "mission.completed",
                 "mission.collisions", "pose.site.ate_rmse_m", "pose.nees.mean")


def rounds_values(folders):
    return [{"map": seed, "seed": round_seed, "metrics": run_values(folders["rounds"] / f"{seed}_{round_seed}", ROUND_METRICS)}
            for seed in seeds_of(REPORT) for round_seed in ROUND_SEEDS]


def rounds_text(values):
    def cell(run, path, form):
        return format(run["metrics"][path], form) if path in run["metrics"] else NONE
    lines = [[run["map"], run["seed"], f"{yes_no(run['metrics'].get('mission.completed', False))} / {cell(run, 'mission.collisions', 'd')}",
              cell(run, "inspection.lining.max_error_mm", ".2f"), cell(run, "inspection.lining.false_findings", "d"),
              cell(run, "inspection.water.position_error_m", ".2f"), cell(run, "docking.position_error_m.max", ".4f"),
              cell(run, "pose.site.ate_rmse_m", ".3f"), cell(run, "pose.nees.mean", ".1f")] for run in values]
    return markdown(["seed of the map", "of the round", "completed / collisions", "rings: maximum error, mm", "other rings reported as moved",
                     "water body: error, m", "docking error, m", "`pose.site.ate_rmse_m`", "`pose.nees.mean`"], lines)


# Exit status 123 of xargs: a run missed an expectation.
add(name="tunnel_inspection_maps", file="worlds/tunnel/README.md", seeds=f"maps {REPORT}, rounds {' and '.join(ROUND_SEEDS)}", minutes=14,
    steps=[Step("maps", ["sh", "-c", f"seq {REPORT.replace('..', ' ')} | xargs -P 2 -I {{}} build/patrol run "
                         "worlds/tunnel/scenarios/reference_round.yaml --seed {} --out {out}/{}"], (0, 123)),
           Step("rounds", ["sh", "-c", f"for map in $(seq {REPORT.replace('..', ' ')}); do echo {' '.join(ROUND_SEEDS)} | xargs -n 1 | xargs -P 2 "
                           "-I {} build/patrol run worlds/tunnel/scenarios/inspection_round.yaml --seed {} --set map={out}/../maps/$map/map.yaml "
                           "--set goals={out}/../maps/$map/nav.json --set references={out}/../maps/$map/scans --out {out}/${map}_{}; done"], (0, 123))],
    values=rounds_values, text=rounds_text)

# --- Fault matrices, sweeps ---------------------------------------------------------------------------------------------------

for world, scenario in (("street", "short"), ("tunnel", "docking")):
    add(name=f"faults_{world}", file="tools/faults.md", seeds="1", minutes=2 if world == "street" else 3,
        steps=[Step("faults", ["build/patrol", "fault-matrix", f"worlds/{world}/scenarios/{scenario}.yaml", "--out", "{out}"])],
        values=lambda folders: (folders["faults"] / "faults.md").read_text().splitlines(), text="\n".join)


def stamps_text(values):
    offsets = sorted({run["variant"] for run in values["stamps"]}, key=lambda variant: float(variant.split("=")[1]))
    rows = []
    for offset in offsets:
        runs = [run["metrics"] for run in values["stamps"] if run["variant"] == offset]
        errors = [run["pose.site.ate_rmse_m"] for run in runs]
        rows.append([f"{1000 * float(offset.split('=')[1]):+.0f} ms", f"{sum(errors) / len(errors):.3f}", f"{max(errors):.3f}",
                     f"{sum(run['mission.completed'] for run in runs)} of {len(runs)}", sum(run["mission.fell"] for run in runs)])
    return markdown(["lidar stamps", "`pose.site.ate_rmse_m`, mean", "worst", "completed", "falls"], rows)


add(name="lidar_stamps", file="tools/faults.md", seeds=REPORT_FIVE, minutes=12,
    steps=[sweep("stamps", "street/scenarios/patrol", REPORT_FIVE, "--set",
                 "faults=[{sensor: lidar, kind: clock_offset, start_s: 0, duration_s: 10000, magnitude: 0.0}]",
                 "--vary", "faults.0.magnitude=range:-0.05:0.05:11")],
    values=swept(stamps=("pose.site.ate_rmse_m", "mission.completed", "mission.fell")), text=stamps_text)


def localizability_text(values):
    def row(label, path, form):
        cells = [run["metrics"].get(f"localizability.{path}") for run in values["degenerate"]]
        return [label, *(NONE if cell is None else form(cell) for cell in cells)]
    return markdown(["`degenerate.yaml`, S = 1", "default", "`--set sensors.uwb.enabled=false`"], [
        row("poses with more than 10 cm uncertainty from one scan (`degenerate_share`)", "degenerate_share", "{:.0%}".format),
        row("ROC AUC of the covariance for such poses (`covariance_detection`)", "covariance_detection", "{:.3f}".format),
        row("ROC AUC of the confidence (`trust_detection`)", "trust_detection", "{:.2f}".format),
        row("rank correlation of the covariance with the bound", "covariance_rank_correlation", "{:.2f}".format),
        row("error of the weak direction", "weak_direction_error_deg", "{:.2f}°".format)])


add(name="localizability", file="src/app/campaign/sweep/README.md", seeds="1", minutes=1,
    steps=[sweep("degenerate", "tunnel/scenarios/degenerate", "1", "--vary", "sensors.uwb.enabled=true,false")],
    values=swept(degenerate=("localizability.*",)), text=localizability_text)

# --- Planning -----------------------------------------------------------------------------------------------------------------

PLANNERS = {"theta_star": "Theta*", "astar": "A*", "dijkstra": "Dijkstra"}


def plan_values(folders):
    kept = {}
    for key in PLANNERS:
        plan = json.loads((folders[key] / "plan.json").read_text())
        kept[key] = {"length_m": plan["route"]["length_m"], "turns": plan["route"]["turns"],
                     "expanded_cells": plan["route"]["expanded_cells"], "gap_to_any_angle": plan["references"]["gap_to_any_angle"]}
    return kept


def plan_text(values):
    return markdown(["planner", "length, m", "turns", "above the any-angle optimum", "expanded cells"],
                    [[title, f"{values[key]['length_m']:.2f}", values[key]["turns"],
                      f"{values[key]['gap_to_any_angle']:.2%}", values[key]["expanded_cells"]]
                     for key, title in PLANNERS.items()])


add(name="plan_tunnel", file="src/plan/README.md", seeds="none (no random draw)", minutes=0.2,
    steps=[Step(key, ["build/patrol", "plan", "worlds/tunnel/map/map.yaml", "--from", "0,0", "--to", "-109.35,-5.75", "--robot", "tracked",
                      "--planner", key, "--out", "{out}"], (0,)) for key in PLANNERS],
    values=plan_values, text=plan_text)

METHODS = {"theta_star": "**Theta\\***", "astar": "A*", "dijkstra": "Dijkstra", "ant_colony_li22": "ant colony, improved",
           "ant_system": "ant system", "dual_swarm_pso": "dual swarm"}
DRIVEN = ("mission.duration_s", "mission.distance_m", "navigation.detours", "navigation.clearance.mean_m", "navigation.clearance.p05_m")


def driven_text(values):
    def mean(runs, method, path):
        found = [run["metrics"][path] for run in runs if run["variant"].endswith(f"={method}") or run["variant"] == method]
        return sum(found) / len(found)
    rows = []
    for method, title in METHODS.items():
        row = [title]
        for key in ("tunnel", "street"):
            cells = [mean(values[key], method, path) for path in DRIVEN]
            row += [f"{cells[0]:.0f}", f"{cells[1]:.1f}", f"{cells[2]:.1f}", f"{cells[3]:.2f}, {cells[4]:.2f}"]
        rows.append(row)
    return markdown(["", "tunnel: s", "m", "detours", "clearance, m: mean, 5 % quantile", "street: s", "m", "detours", "clearance, m"], rows)


add(name="planners_in_the_loop", file="src/plan/README.md", seeds=REPORT_FIVE, minutes=25,
    steps=[sweep(key, f"{key}/scenarios/{scenario}", REPORT_FIVE, "--vary",
                 "stack.navigation.global_planner.method=" + ",".join(METHODS)) for key, scenario in (("tunnel", "navigate"), ("street", "patrol"))],
    values=swept(tunnel=DRIVEN, street=DRIVEN), text=driven_text)

# --- Recorded logs ------------------------------------------------------------------------------------------------------------

LOGS = {"intel": ("intel.log", "intel.relations", []), "fr079": ("fr079.log", "fr079.relations", ["--reference-x-m", "0.04"])}
SLAM_METHODS = ("graph", "submap_rbpf", "rbpf")


def slam_steps():
    steps = []
    for log, (file, relations, options) in LOGS.items():
        for method in SLAM_METHODS:
            steps.append(Step(f"{log}_{method}", ["build/patrol", "slam", f"{{logs}}/{file}", "--method", method, "--out", "{out}"], (0,)))
            steps.append(Step(f"{log}_{method}_score", ["sh", "-c", f"build/patrol score --estimate {{out}}/../{log}_{method}/estimate.tum "
                              f"--relations {{logs}}/{relations} {' '.join(options)} > {{out}}/score.txt"], (0,)))
    return steps


def slam_values(folders):
    rows = []
    for log in LOGS:
        for method in SLAM_METHODS:
            lines = (folders[f"{log}_{method}_score"] / "score.txt").read_text().splitlines()
            rows.append({"log": log, "method": method, "error": "; ".join(line.strip() for line in lines if "mean" in line)})
    return rows


def slam_text(values):
    cells = {(row["log"], row["method"]): row["error"] for row in values}
    return markdown(["", "Intel Research Lab, 45 min, 739 m", "Freiburg 079, 18 min, 393 m"],
                    [[f"`{method}`", cells["intel", method], cells["fr079", method]] for method in SLAM_METHODS]
                    + [["Cartographer, published [Hess16]", "0.0229 m, 0.45°", "0.0452 m, 0.54°"],
                       ["graph mapping, published [Kuemmerle09]", "0.031 m, 1.3°", "0.056 m, 0.6°"],
                       ["GMapping, 50 particles, published [Kuemmerle09]", "0.070 m", "0.061 m"]])


add(name="slam_logs", file="src/slam/README.md", seeds="default", minutes=2, steps=slam_steps(), values=slam_values, text=slam_text,
    logs=tuple(file for pair_of_files in LOGS.values() for file in pair_of_files[:2]))

# --- Studies ------------------------------------------------------------------------------------------------------------------


def add_study(name, command, minutes, head, columns, key="method", seeds="the study's own, from 1001 on"):
    add(name=name, file="src/app/study/README.md", seeds=seeds, minutes=minutes, steps=[study(command)],
        values=lambda folders: study_values(folders["study"]), text=lambda values: study_table(values, head, columns, key))


def landmark(world, particles=""):
    return {"world": world, **({"particles": particles} if particles else {})}


add_study("study_landmarks_circle", "landmarks-circle", 8.3,
          ["position RMSE, m; 10 particles", "paper", "S5", "S3", "M", "NEES in S5 (consistent: 2)"],
          [({"world": "S5"}, "position RMSE", "published"), *(({"world": world}, "position RMSE", "interval") for world in ("S5", "S3", "M")),
           ({"world": "S5"}, "NEES", "mean")])
add_study("study_landmarks_100x80", "landmarks-100x80", 1, ["position RMSE, m", "paper", "biased", "biased, 2 m/s", "biased, 5 m/s", "matched"],
          [({"world": "biased odometry"}, "position RMSE", "published"),
           *(({"world": world}, "position RMSE", "interval") for world in
             ("biased odometry", "biased odometry, 2 m/s", "biased odometry, 5 m/s", "matched odometry"))])
add_study("study_ungm", "ungm", 0.5, ["RMSE: paper, then here", "N = 50", "", "N = 100", "", "N = 150", ""],
          [({"particles": particles}, "RMSE", form) for particles in ("50", "100", "150") for form in ("published", "interval")])
add_study("study_street_map", "street-map", 15,
          ["", "box 1: paper", "here", "box 2: paper", "here", "well 3: paper", "here", "map to nearest surface", "pose RMSE", "SLAM s", "MB"],
          [*(({}, figure, form) for figure in ("box 1", "box 2", "well 3") for form in ("published", "mean")),
           *(({}, figure, "mean") for figure in ("map to nearest surface", "pose RMSE", "time", "memory"))])
add_study("study_substation", "substation", 11,
          ["", "map to nearest surface, m: paper", "here", "variance, m²: paper", "here", "pose RMSE, m", "closures: precision", "recall", "s", "MB"],
          [({}, "map to nearest surface", "published"), ({}, "map to nearest surface", "interval"), ({}, "variance of that", "published"),
           ({}, "variance of that", "mean"), ({}, "pose RMSE", "mean"), ({}, "loop precision", "mean"), ({}, "loop recall", "mean"),
           ({}, "time", "mean"), ({}, "memory", "mean")])
PLANNER_TITLES = ("improved ant colony (this work)", "ant colony [Li22]", "ant system", "dual swarm", "Q-learning", "Theta*")
add_study("study_planners", "planners", 28,
          ["", *(f"{title}: {figure}" for title in PLANNER_TITLES for figure in ("longer than A*, %", "ms"))],
          [({"method": title}, figure, form) for title in PLANNER_TITLES for figure, form in (("longer than A*", "interval"), ("time", "mean"))],
          key="world")

# --- Benchmarks, mutations ----------------------------------------------------------------------------------------------------

BENCHMARKS = ("physics", "lidar", "render", "particle", "plan")


def benchmarks_values(folders):
    return {name: benchmark_values(folders[name] / "benchmark.json") for name in BENCHMARKS}


def benchmarks_text(values):
    return markdown(["benchmark", "ratio to its reference"],
                    [[f"`{bench}_bench`: {name.replace('/manual_time', '')}", f"{ratio:.2f}"]
                     for bench, found in values.items() for name, ratio in found.items()])


add(name="benchmarks", file="tests/README.md", seeds="none", minutes=6,
    steps=[Step(name, [f"build/tests/bench/{name}_bench", "--benchmark_out_format=json", "--benchmark_out={out}/benchmark.json"], (0,))
           for name in BENCHMARKS],
    values=benchmarks_values, text=benchmarks_text, targets=tuple(f"{name}_bench" for name in BENCHMARKS))


def mutations_values(folders):
    return json.loads((folders["mutations"] / "mutations.json").read_text())["rows"]


def mutations_text(values):
    return markdown(["mutation", "caught", "by", "first tests, min", "all tests, min"],
                    [[row["summary"], yes_no(row["caught"]), ", ".join(row["tests"]) or NONE, f"{row['first_min']:.1f}",
                      f"{row['all_min']:.1f}" if row["all_min"] else NONE] for row in values])


add(name="mutations", file="tests/mutation/README.md", seeds="those of the tests", minutes=120,
    steps=[Step("mutations", ["tests/mutation/run", "--out", "{out}"])], values=mutations_values, text=mutations_text, targets=())

assert len({table.name for table in TABLES}) == len(TABLES)
ROOT = pathlib.Path(__file__).resolve().parent.parent
