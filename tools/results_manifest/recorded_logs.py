"""Tables of SLAM on recorded logs."""
import cmath
import json
import pathlib
import runpy

from results_tables import markdown
from .declare import REPORT, Step, add

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


FED_STACKS = {"built_in": ("built-in mapping", []),
              "process": ("built-in mapping, `patrol stack`", ["--stack", "build/patrol stack"]),
              "kiss_icp": ("KISS-ICP, started from the odometry of the log",
                           ["--stack", "env PYTHONPATH=src/link/python .deps/python/bin/python src/link/python/examples/kiss_icp_scans.py"])}


def fed_steps():
    return [Step(f"{log}_{stack}", ["build/patrol", "feed", f"{{logs}}/{file}", "--relations", f"{{logs}}/{relations}", *scores["score"],
                                    *options, "--out", "{out}"], (0,))
            for log, (file, relations, scores) in LOGS.items() for stack, (_, options) in FED_STACKS.items()]


def fed_values(folders):
    values = []
    for log in LOGS:
        for stack in FED_STACKS:
            metrics = json.loads((folders[f"{log}_{stack}"] / "metrics.json").read_text())
            values.append({"log": log, "stack": stack, "wall_s": metrics["performance"]["wall_s"],
                           **{name: {key: metrics[name]["relations"][key]["mean"] for key in ("translation_m", "rotation_deg")}
                              for name in ("estimate", "online") if name in metrics}})
    return values


def fed_text(values):
    def cell(log, stack, name):
        errors = next(row for row in values if (row["log"], row["stack"]) == (log, stack)).get(name)
        return f"{errors['translation_m']:.4f} m, {errors['rotation_deg']:.3f}°" if errors else "–"
    return markdown(["stack", "Intel Research Lab", "its poses during the log", "Freiburg 079", "its poses during the log"],
                    [[summary, *(cell(log, stack, name) for log in LOGS for name in ("estimate", "online"))]
                     for stack, (summary, _) in FED_STACKS.items()])


add(name="feed_logs", file="src/link/README.md", seeds="default", minutes=5, steps=fed_steps(), values=fed_values, text=fed_text,
    logs=tuple(file for pair_of_files in LOGS.values() for file in pair_of_files[:2]), files=("src/link/python",))


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


SESSION_PARTS = 3  # of a recorded log
STREET_SEEDS = range(*(int(bound) + offset for bound, offset in zip(REPORT.split(".."), (0, 1))))


def sessions_of_log(log):
    """Maps the parts of a log one after the other, and scores all of them together."""
    file, relations, scores = LOGS[log]
    return Step(log, ["sh", "-c", f"map=; for k in $(seq {SESSION_PARTS}); do "
                      f"tools/vary_log {{logs}}/{file} as_recorded {{out}}/$k.log --part $k/{SESSION_PARTS} && "
                      f"build/patrol slam {{out}}/$k.log $map --out {{out}}/$k > {{out}}/$k.txt || exit 3; map=\"--map {{out}}/$k\"; done; "
                      f"cat {{out}}/*/estimate.tum | grep -v '^#' > {{out}}/estimate.tum; "
                      f"build/patrol score --estimate {{out}}/estimate.tum --relations {{logs}}/{relations} {' '.join(scores['score'])} > {{out}}/score.txt"], (0,))


def sessions_of_street():
    """Runs of as many robots, whose logs extend one map."""
    seeds = " ".join(map(str, STREET_SEEDS))
    return Step("street", ["sh", "-c", f"echo {seeds} | xargs -n 1 | xargs -P 2 -I {{}} sh -c 'build/patrol run worlds/street/scenarios/patrol.yaml --seed {{}} "
                           f"--out {{out}}/run_{{}} > {{out}}/run_{{}}.txt || test $? -eq 1' && map=; for k in {seeds}; do "
                           f"build/patrol slam {{out}}/run_$k/log.mcap $map --out {{out}}/map_$k > {{out}}/map_$k.txt || exit 3; map=\"--map {{out}}/map_$k\"; done"], (0,))


def positions(file):
    """Stamps and positions x + iy of a TUM trajectory."""
    rows = [line.split() for line in file.read_text().splitlines() if not line.startswith("#")]
    return [(float(row[0]), complex(float(row[1]), float(row[2]))) for row in rows]


def matched(estimate, truth):
    """Estimated positions, and true ones at their stamps."""
    pairs, k = [], 0
    for stamp, position in estimate:
        while k + 2 < len(truth) and truth[k + 1][0] < stamp:
            k += 1
        (before_s, before), (after_s, after) = truth[k:k + 2]
        pairs.append((position, before + (after - before) * (stamp - before_s) / (after_s - before_s)))
    return pairs


def rigid_motion(pairs):
    """Rotation and translation that take the estimated positions to the true ones, by least squares."""
    mean_estimate, mean_truth = (sum(pair[i] for pair in pairs) / len(pairs) for i in (0, 1))
    turn = cmath.phase(sum((truth - mean_truth) * (estimate - mean_estimate).conjugate() for estimate, truth in pairs))
    rotation = cmath.rect(1.0, turn)
    return rotation, mean_truth - rotation * mean_estimate


def rms_m(pairs, motion):
    rotation, translation = motion
    return (sum(abs(rotation * estimate + translation - truth) ** 2 for estimate, truth in pairs) / len(pairs)) ** 0.5


def session_metrics(folder):
    metrics = json.loads((folder / "metrics.json").read_text())
    return {"located": metrics["earlier_map"]["located"] if metrics["earlier_map"] else None, "nodes": metrics["graph"]["nodes"],
            "cpu_per_minute_s": 60 * metrics["performance"]["processor_s"] / metrics["log"]["duration_s"],
            "peak_memory_mb": metrics["performance"]["peak_memory_mb"], "consistent": metrics["consistency"]["consistent"]}


def sessions_values(folders):
    rows = [{"site": log, "error": mean_errors(folders[log]), "sessions": [session_metrics(folders[log] / str(k + 1)) for k in range(SESSION_PARTS)]} for log in LOGS]
    sessions, in_world = [], None
    for seed in STREET_SEEDS:
        folder = folders["street"] / f"map_{seed}"
        pairs = matched(positions(folder / "estimate.tum"), positions(folders["street"] / f"run_{seed}/truth.tum"))
        in_world = in_world or rigid_motion(pairs)
        sessions.append({**session_metrics(folder), "rms_m": rms_m(pairs, in_world)})
    return rows + [{"site": "street", "error": None, "sessions": sessions}]


def sessions_text(values):
    names = {"intel": f"Intel Research Lab in {SESSION_PARTS} parts", "fr079": f"Freiburg 079 in {SESSION_PARTS} parts", "street": "street, as-built robots"}
    rows = []
    for row in values:
        for number, session in enumerate(row["sessions"], 1):
            located = {None: "–", True: "yes", False: "no"}[session["located"]]
            error = f"{session['rms_m']:.3f} m" if row["error"] is None else row["error"] if number == len(row["sessions"]) else ""
            rows.append([names[row["site"]] if number == 1 else "", str(number), located, error, str(session["nodes"]),
                         f"{session['cpu_per_minute_s']:.1f} s", f"{session['peak_memory_mb']:.0f} MB", "yes" if session["consistent"] else "no"])
    return markdown(["site", "session", "located", "error", "nodes", "processor time per minute", "peak memory", "consistent"], rows)


add(name="slam_sessions", file="src/slam/README.md", seeds=REPORT + " (street)", minutes=14, steps=[*map(sessions_of_log, LOGS), sessions_of_street()],
    values=sessions_values, text=sessions_text, logs=tuple(file for pair_of_files in LOGS.values() for file in pair_of_files[:2]))
