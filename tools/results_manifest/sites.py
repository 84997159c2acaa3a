"""Tables of imported sites."""
import json

from results_tables import markdown
from .declare import REPORT_FIVE, Step, add
from .recorded_logs import LOGS

SEEDS = range(2001, 2006)
NUM_STATIONS = 5


def twin_step(log, file, seed):
    # The site lies below worlds/ of the step's folder, in which the run is started.
    script = (f"program=$PWD/build/patrol && cd {{out}} && $program import site {{logs}}/{file} --out worlds/{log} --random-stations {NUM_STATIONS} --seed {seed} "
              f"&& $program run {log}/patrol --seed {seed} --out run")
    return Step(f"{log}_{seed}", ["sh", "-c", script])


def twin_values(folders):
    values = []
    for log in LOGS:
        for seed in SEEDS:
            metrics = json.loads((folders[f"{log}_{seed}"] / "run" / "metrics.json").read_text())
            stations = metrics["stations"]
            values.append({"log": log, "seed": seed, "completed": metrics["mission"]["completed"], "collisions": metrics["mission"]["collisions"],
                           "distance_m": metrics["mission"]["distance_m"], "ate_m": metrics["pose"]["site"]["ate_rmse_m"],
                           "map_m": metrics["map"]["nearest_mean_m"], "stations": len(stations)})
    return values


def twin_text(values):
    rows = []
    for log, title in (("intel", "Intel Research Lab"), ("fr079", "Freiburg 079")):
        runs = [row for row in values if row["log"] == log]

        def span(key, unit, digits):
            return f"{min(run[key] for run in runs):.{digits}f} to {max(run[key] for run in runs):.{digits}f} {unit}"
        rows.append([title, f"{sum(run['completed'] for run in runs)} of {len(runs)}", str(sum(run["collisions"] for run in runs)),
                     span("distance_m", "m", 0), span("ate_m", "m", 3), span("map_m", "m", 3)])
    return markdown(["site from the log", "patrols of five random stations completed", "collisions", "distance", "`pose.site.ate_rmse_m`",
                     "`map.nearest_mean_m`"], rows)


add(name="twin_logs", file="src/importer/README.md", seeds=REPORT_FIVE, minutes=4,
    steps=[twin_step(log, file, seed) for log, (file, _, _) in LOGS.items() for seed in SEEDS],
    values=twin_values, text=twin_text, logs=tuple(file for file, _, _ in LOGS.values()))


def realism_steps():
    # The site lies below worlds/ of the step's folder. Its frame is that of the map.
    steps = []
    for log, (file, _, _) in LOGS.items():
        script = (f"program=$PWD/build/patrol && cd {{out}} && $program slam {{logs}}/{file} --out slam && $program import site {{logs}}/{file} --out worlds/{log} "
                  f"&& $program calibrate --sensor lidar {{logs}}/{file} --site {log} --trajectory slam/estimate.tum --lidar tim571 --out lidar")
        steps.append(Step(log, ["sh", "-c", script], (0,)))
    return steps


def realism_values(folders):
    values = []
    for log in LOGS:
        held_out = json.loads((folders[log] / "lidar" / "metrics.json").read_text())["held_out"]
        static = held_out["fit"]["recorded"]["static"]
        values.append({"log": log, **{key: static[key] for key in ("median_m", "median_abs_m", "p95_abs_m")},
                       **{key: held_out[key] for key in ("ks_preset", "ks_fit", "ks_ratio")}})
    return values


def realism_text(values):
    return markdown(["log", "median residual", "its absolute value", "95 %", "distance, preset", "distance, fit", "ratio"],
                    [[{"intel": "Intel Research Lab", "fr079": "Freiburg 079"}[row["log"]], f"{1000 * row['median_m']:.1f} mm", f"{1000 * row['median_abs_m']:.1f} mm",
                      f"{1000 * row['p95_abs_m']:.0f} mm", f"{row['ks_preset']:.3f}", f"{row['ks_fit']:.3f}", f"{row['ks_ratio']:.3f}"] for row in values])


add(name="realism_logs", file="src/realism/README.md", seeds="default", minutes=2, steps=realism_steps(), values=realism_values, text=realism_text,
    logs=tuple(file for file, _, _ in LOGS.values()))
