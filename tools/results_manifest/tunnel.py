"""Tables of the tunnel."""
import re

from results_blocks import ResultsError
from results_tables import NONE, Row, as_text, by_seed, count, markdown, missed_expectations, pair, run_values, seeds_of, span, yes_no
from .declare import CALIBRATION_ROW, REPORT, REPORT_FIVE, VERDICT_ROW, Step, add, sweep, swept


def at_goal(goal, quantity, scale, digits):
    def value(metrics):
        mean, std = (metrics.get(f"goals.{goal}.{quantity}.{part}") for part in ("mean", "std"))
        return None if mean is None else f"{scale * mean:.{digits}f} ± {scale * std:.{digits}f}"
    return value


def reached(metrics):
    if "mission.collisions" not in metrics:
        return None
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
    CALIBRATION_ROW,
    Row("track encoders, IMU and UWB: `range_pose.ate_rmse_m`", "range_pose.ate_rmse_m", ".2f"),
    Row("track encoders and IMU: `odometry.ate_rmse_m`", "odometry.ate_rmse_m", ".0f"),
    VERDICT_ROW,
]

add(name="tunnel_navigation", file="worlds/tunnel/README.md", seeds=REPORT, minutes=33,
    steps=[sweep("navigation", "tunnel/scenarios/map_then_navigate", REPORT)],
    values=swept(navigation=("mission.*", "goals.*.arrivals", "goals.*.*.mean", "goals.*.*.std", "docking.*.max",
                             "pose.site.ate_rmse_m", "pose.nees.mean", "calibration.within_95", "range_pose.ate_rmse_m", "odometry.ate_rmse_m")),
    text=lambda values: by_seed(values["navigation"], NAVIGATION_ROWS))

ENDS = ("mission.*", "docking.*.max", "docking.arrivals", "localization.max_error_m", "localization.min_trust",
        "localization.kidnaps.*.*", "pose.site.ate_rmse_m")


def scenarios_text(values):
    def done(runs):
        return f"{sum(run['end'] == 'done' for run in runs)} of {len(runs)} as expected"
    degenerate = {name: [run for run in values["degenerate"] if run["variant"].endswith(name)] for name in ("true", "false")}
    return markdown(["scenario", "seeds", "result"], [
        ["`docking.yaml`", len(values["docking"]),
         f"{done(values['docking'])}; position error {span(values['docking'], 'docking.position_error_m.max', '.4f', ' m')}, heading error "
         f"{span(values['docking'], 'docking.heading_error_deg.max', '.2f', '°')}"],
        ["`low_obstacles.yaml`", len(values["low_obstacles"]),
         f"{done(values['low_obstacles'])}; collisions {span(values['low_obstacles'], 'mission.collisions', '.0f')}"],
        ["`kidnap.yaml`", len(values["kidnap"]),
         f"{done(values['kidnap'])}; relocalized after {span(values['kidnap'], 'localization.kidnaps.0.relocalized_s', '.1f', ' s')}"],
        ["`degenerate.yaml`", len(degenerate["true"]),
         f"{done(degenerate['true'])}; maximum error {span(degenerate['true'], 'localization.max_error_m', '.3f', ' m')}"],
        ["`degenerate.yaml` without UWB", len(degenerate["false"]),
         f"maximum error {span(degenerate['false'], 'localization.max_error_m', '.3f', ' m')}; minimum confidence "
         f"{span(degenerate['false'], 'localization.min_trust', '.2f')}"],
        ["`bridge.yaml`", len(values["bridge"]),
         f"{done(values['bridge'])}; `pose.site.ate_rmse_m` {span(values['bridge'], 'pose.site.ate_rmse_m', '.3f', ' m')}"]])


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
    CALIBRATION_ROW,
    VERDICT_ROW,
]

add(name="tunnel_inspection", file="worlds/tunnel/README.md", seeds=REPORT, minutes=7,
    steps=[sweep("inspection", "tunnel/scenarios/inspection_round", REPORT)],
    values=swept(inspection=("mission.*", "inspection.lining.*", "inspection.lining.rings.*.reported_mm", "inspection.water.*",
                             "inspection.water.findings.*.distance_holds", "docking.*.max", "pose.site.ate_rmse_m",
                             "pose.nees.mean", "calibration.within_95")),
    text=lambda values: by_seed(values["inspection"], INSPECTION_ROWS))

ROUND_SEEDS = ("2001", "2002")
ROUND_METRICS = ("inspection.lining.max_error_mm", "inspection.lining.false_findings", "inspection.lining.registered",
                 "inspection.water.position_error_m", "inspection.water.missed", "docking.position_error_m.max", "mission.completed",
                 "mission.collisions", "pose.site.ate_rmse_m", "pose.nees.mean")


def rounds_values(folders):
    runs = [{"map": seed, "seed": round_seed, "folder": folders["rounds"] / f"{seed}_{round_seed}"}
            for seed in seeds_of(REPORT) for round_seed in ROUND_SEEDS]
    return [{"map": run["map"], "seed": run["seed"], "metrics": run_values(run["folder"], ROUND_METRICS),
             "missed": missed_expectations(run["folder"])} for run in runs]


def verdict(missed):
    """Expectations of a run: "all met", or the missed metrics; the dash if they are not recorded."""
    if missed is None:
        return NONE
    return f"{len(missed)} missed: " + ", ".join(f"`{name}`" for name in missed) if missed else "all met"


def rounds_text(values):
    def cell(run, path, form):
        return format(run["metrics"][path], form) if path in run["metrics"] else NONE
    lines = [[run["map"], run["seed"], f"{yes_no(run['metrics'].get('mission.completed', False))} / {cell(run, 'mission.collisions', 'd')}",
              cell(run, "inspection.lining.max_error_mm", ".2f"), cell(run, "inspection.lining.false_findings", "d"),
              cell(run, "inspection.water.position_error_m", ".2f"), cell(run, "docking.position_error_m.max", ".4f"),
              cell(run, "pose.site.ate_rmse_m", ".3f"), cell(run, "pose.nees.mean", ".1f"), verdict(run.get("missed"))] for run in values]
    return markdown(["seed of the map", "of the round", "completed / collisions", "rings: maximum error, mm", "other rings reported as moved",
                     "water body: error, m", "docking error, m", "`pose.site.ate_rmse_m`", "`pose.nees.mean`", "expectations"], lines)


# Exit status 123 of xargs: a run missed an expectation.
add(name="tunnel_inspection_maps", file="worlds/tunnel/README.md", seeds=f"maps {REPORT}, rounds {' and '.join(ROUND_SEEDS)}", minutes=14,
    steps=[Step("maps", ["sh", "-c", f"seq {REPORT.replace('..', ' ')} | xargs -P 2 -I {{}} build/patrol run "
                         "worlds/tunnel/scenarios/reference_round.yaml --seed {} --out {out}/{}"], (0, 123)),
           Step("rounds", ["sh", "-c", f"for map in $(seq {REPORT.replace('..', ' ')}); do echo {' '.join(ROUND_SEEDS)} | xargs -n 1 | xargs -P 2 "
                           "-I {} build/patrol run worlds/tunnel/scenarios/inspection_round.yaml --seed {} --set map={out}/../maps/$map/map.yaml "
                           "--set goals={out}/../maps/$map/nav.json --set references={out}/../maps/$map/scans --out {out}/${map}_{}; done"], (0, 123))],
    values=rounds_values, text=rounds_text)


WATER_LINE = re.compile(r"^seed +(\d+): found (yes|no)(?:, error (\S+) m, distance (\S+) m in \[ *(\S+), *(\S+)\] (yes|no), "
                        r"radius (\S+) m in \[ *(\S+), *(\S+)\] (yes|no))?$")
LOCATED_M = 3.5


def water_runs(text):
    """Lines that the test of water ahead prints, one per seed. A body that is not found may have no figures."""
    runs = []
    for line in text.splitlines():
        if not (match := WATER_LINE.match(line.strip())):
            if re.match(r"\s*seed +\d+:", line):
                raise ResultsError(f"water ahead: {line.strip()!r}: must be 'seed N: found yes, error E m, distance D m in [L, H] yes, "
                                   "radius R m in [L, H] no'")
            continue
        seed, found, error, distance, *rest = match.groups()
        run = {"seed": int(seed), "found": found == "yes"}
        if run["found"]:
            if error is None:
                raise ResultsError(f"water ahead: {line.strip()!r}: a body that is found must have its error and intervals")
            low, high, holds, radius, radius_low, radius_high, radius_holds = rest
            run |= {"error_m": float(error),
                    "distance": {"m": float(distance), "low": float(low), "high": float(high), "holds": holds == "yes"},
                    "radius": {"m": float(radius), "low": float(radius_low), "high": float(radius_high), "holds": radius_holds == "yes"}}
        runs.append(run)
    if not runs:
        raise ResultsError("water ahead: the test printed no line 'seed N: found ...'")
    return runs


def water_text(runs):
    def estimate(run, quantity):
        value = run.get(quantity)
        return [f"{value['m']:.1f} [{value['low']:.1f}, {value['high']:.1f}]", yes_no(value["holds"])] if value else [NONE, NONE]

    errors = [run["error_m"] for run in runs if run["found"]]

    def held(quantity):
        return f"{sum(run[quantity]['holds'] for run in runs if quantity in run)} of {len(errors)}"
    lines = [[run["seed"], yes_no(run["found"]), f"{run['error_m']:.2f}" if run["found"] else NONE, *estimate(run, "distance"),
              *estimate(run, "radius")] for run in runs]
    near = sum(error < LOCATED_M for error in errors)
    located = f"mean {sum(errors) / len(errors):.2f}, worst {max(errors):.2f}; below {LOCATED_M:g} m: {near} of {len(runs)}" if errors else NONE
    lines.append(["all", f"{len(errors)} of {len(runs)}", located, "", held("distance"), "", held("radius")])
    return markdown(["seed", "found", "error of the position, m", "true distance [95 % interval], m", "contained",
                     "true radius [95 % interval], m", "contained"], lines)


# Exit status 1: a bound of the test is missed; the figures show it.
add(name="tunnel_water_ground", file="worlds/tunnel/README.md", seeds="those of the table, drawn by the test", minutes=2,
    steps=[Step("water", ["build/tests/scenario/scenario_test", "--gtest_filter=WaterAhead.OfTenSpheroidsInRealGround*"])],
    values=lambda folders: water_runs((folders["water"].parent / "water.txt").read_text()), text=water_text, targets=("scenario_test",),
    files=("tests/scenario/water_ahead_test.cc", "tests/support"))
