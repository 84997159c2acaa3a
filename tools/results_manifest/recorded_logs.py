"""Tables of SLAM on recorded logs."""
import json
import pathlib
import runpy

from results_tables import markdown
from .declare import Step, add

# File, relations, and the options of each of its scores: Freiburg 079 is scored with the reference point of its relations, and without.
LOGS = {"intel": ("intel.log", "intel.relations", {"score": []}),
        "fr079": ("fr079.log", "fr079.relations", {"score": ["--reference-x-m", "0.04"], "score_of_body": []})}
SLAM_METHODS = ("graph", "submap_rbpf", "rbpf")


def slam_steps():
    steps = []
    for log, (file, relations, scores) in LOGS.items():
        for method in SLAM_METHODS:
            steps.append(Step(f"{log}_{method}", ["build/patrol", "slam", f"{{logs}}/{file}", "--method", method, "--out", "{out}"], (0,)))
            for score, options in scores.items():
                steps.append(Step(f"{log}_{method}_{score}", ["sh", "-c", f"build/patrol score --estimate {{out}}/../{log}_{method}/estimate.tum "
                                  f"--relations {{logs}}/{relations} {' '.join(options)} > {{out}}/score.txt"], (0,)))
    return steps


def mean_errors(folder):
    """Mean absolute errors that `patrol score --relations` printed: translation, rotation."""
    means = dict(line.split(", ", 1) for line in (folder / "score.txt").read_text().splitlines() if ", " in line and line.startswith("  "))
    return f"{means['  translation'].split()[1]} m, {means['  rotation'].split()[1]}°"


def slam_values(folders):
    return [{"log": log, "method": method, "error": mean_errors(folders[f"{log}_{method}_{score}"]), "score": score}
            for log, (_, _, scores) in LOGS.items() for method in SLAM_METHODS for score in scores]


def slam_text(values):
    cells = {(row["log"], row["method"], row["score"]): row["error"] for row in values}

    def freiburg(method):
        return f"{cells['fr079', method, 'score']}; {cells['fr079', method, 'score_of_body']}"
    return markdown(["", "Intel Research Lab, 45 min, 739 m", "Freiburg 079, 18 min, 393 m: with `--reference-x-m 0.04`; without"],
                    [[f"`{method}`", cells["intel", method, "score"], freiburg(method)] for method in SLAM_METHODS]
                    + [["Cartographer, published [Hess16]", "0.0229 m, 0.45°", "0.0452 m, 0.54°"],
                       ["graph mapping, published [Kuemmerle09]", "0.031 m, 1.3°", "0.056 m, 0.6°"],
                       ["GMapping, 50 particles, published [Kuemmerle09]", "0.070 m", "0.061 m"]])


add(name="slam_logs", file="src/slam/README.md", seeds="default", minutes=2, steps=slam_steps(), values=slam_values, text=slam_text,
    logs=tuple(file for pair_of_files in LOGS.values() for file in pair_of_files[:2]))


VARIANTS = {name: summary for name, (summary, _) in runpy.run_path(str(pathlib.Path(__file__).parent.parent / "vary_log"))["VARIANTS"].items()}
PUBLISHED_VARIANTS = {"beams_16": "0.085 m (11 beams) [Zhou22]"}  # of the Intel log


def variants_step(log):
    file, relations, scores = LOGS[log]
    one = (f"mkdir -p {{out}}/{{}} && tools/vary_log {{logs}}/{file} {{}} {{out}}/{{}}/varied.log --relations {{logs}}/{relations} {{out}}/{{}}/relations && "
           f"build/patrol slam {{out}}/{{}}/varied.log --out {{out}}/{{}}/map > {{out}}/{{}}/slam.txt && "
           f"build/patrol score --estimate {{out}}/{{}}/map/estimate.tum --relations {{out}}/{{}}/relations {' '.join(scores['score'])} > {{out}}/{{}}/score.txt")
    return Step(log, ["sh", "-c", f"echo {' '.join(VARIANTS)} | xargs -n 1 | xargs -P 2 -I {{}} sh -c '{one}'"], (0,))


def errors_and_verdict(folder):
    metrics = json.loads((folder / "map/metrics.json").read_text())
    return mean_errors(folder) + ("" if metrics["consistency"]["consistent"] else ", flagged")


def variants_values(folders):
    return [{"variant": name, **{log: errors_and_verdict(folders[log] / name) for log in LOGS}} for name in VARIANTS]


def variants_text(values):
    return markdown(["variant", "contents", "Intel Research Lab", "Freiburg 079, `--reference-x-m 0.04`", "Intel, published"],
                    [[f"`{row['variant']}`", VARIANTS[row["variant"]], row["intel"], row["fr079"], PUBLISHED_VARIANTS.get(row["variant"], "–")]
                     for row in values])


add(name="slam_variants", file="src/slam/README.md", seeds="1 (of the variants)", minutes=10, steps=[variants_step(log) for log in LOGS],
    values=variants_values, text=variants_text, logs=tuple(file for pair_of_files in LOGS.values() for file in pair_of_files[:2]))
