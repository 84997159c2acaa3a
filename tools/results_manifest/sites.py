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
