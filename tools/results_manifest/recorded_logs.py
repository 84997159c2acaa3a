"""Tables of SLAM on recorded logs."""
from results_tables import markdown
from .declare import Step, add

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
