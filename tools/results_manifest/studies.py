"""Tables of published experiments."""
from results_tables import NONE, markdown, study_cell, study_table, study_values
from .declare import REPORT, Step, add


def study(name, seeds=None):
    return Step("study", ["build/patrol", "study", name, *(["--seeds", seeds] if seeds else []), "--out", "{out}"], (0,))


STUDY_SEEDS = "the study's own, from 1001 on"


def add_study(name, command, minutes, head, columns, above):
    add(name=name, file="src/app/study/README.md", seeds=STUDY_SEEDS, minutes=minutes, steps=[study(command)],
        values=lambda folders: study_values(folders["study"]), text=lambda values: f"{above}\n\n{study_table(values, head, columns)}")


# Legend of cells of the form "compared".
def legend(reference, note=""):
    return (f"Mean ± half of its 95 % interval. In brackets: p-value of the difference from {reference}, paired by seed, adjusted for all comparisons "
            f"of the study [Holm79]. Failed runs with the adjusted p-value of equal failure rates, and the number of pairs, where a run has failed.{note}")


add_study("study_landmarks_circle", "landmarks-circle", 8.3,
          ["position RMSE, m; 10 particles", "paper", "S5", "S3", "M", "NEES in S5 (consistent: 2)"],
          [({"world": "S5"}, "position RMSE", "published"), *(({"world": world}, "position RMSE", "compared") for world in ("S5", "S3", "M")),
           ({"world": "S5"}, "NEES", "mean")], above=legend("FastSLAM"))
add_study("study_landmarks_100x80", "landmarks-100x80", 1, ["position RMSE, m", "paper", "biased", "biased, 2 m/s", "biased, 5 m/s", "matched"],
          [({"world": "biased odometry"}, "position RMSE", "published"),
           *(({"world": world}, "position RMSE", "compared") for world in
             ("biased odometry", "biased odometry, 2 m/s", "biased odometry, 5 m/s", "matched odometry"))], above=legend("FastSLAM"))
add_study("study_ungm", "ungm", 0.5, ["RMSE: paper, then here", "N = 50", "", "N = 100", "", "N = 150", ""],
          [({"particles": particles}, "RMSE", form) for particles in ("50", "100", "150") for form in ("published", "compared")],
          above=legend("the exact Bayes filter"))
add_study("study_street_map", "street-map", 15,
          ["", "box 1: paper", "here", "box 2: paper", "here", "well 3: paper", "here", "map to nearest surface", "pose RMSE", "SLAM s", "MB"],
          [*(({}, figure, form) for figure in ("box 1", "box 2", "well 3") for form in ("published", "compared")),
           *(({}, figure, "mean") for figure in ("map to nearest surface", "pose RMSE", "time", "memory"))], above=legend("FastSLAM"))
add_study("study_substation", "substation", 11,
          ["", "map to nearest surface, m: paper", "here", "variance, m²: paper", "here", "pose RMSE, m", "closures: precision", "recall", "s", "MB"],
          [({}, "map to nearest surface", "published"), ({}, "map to nearest surface", "compared"), ({}, "variance of that", "published"),
           ({}, "variance of that", "compared"), ({}, "pose RMSE", "mean"), ({}, "loop precision", "mean"), ({}, "loop recall", "mean"),
           ({}, "time", "mean"), ({}, "memory", "mean")], above=legend("the plain RBPF"))

ITERATING_PLANNERS = ("improved ant colony (this work)", "ant colony [Li22]", "ant system", "dual swarm", "Q-learning")
# Table: its caption, the figure, the form of its cells, and its methods.
PLANNER_TABLES = (
    ("Longer than A*, %", "longer than A*", "compared", (*ITERATING_PLANNERS, "Theta*")),
    ("Iterations to within 1 % of the own final length", "iterations to 1 % of its final value", "compared", ITERATING_PLANNERS),
    ("CPU time, ms", "time", "mean", (*ITERATING_PLANNERS, "A*", "Theta*")))


def planners_text(values):
    parts = [legend("the improved ant colony", " A run has failed if it found no path; lengths and iterations are those of found paths.")]
    for title, figure, form, methods in PLANNER_TABLES:
        parts.append(study_table(values, [title, *methods], [({"method": method}, figure, form) for method in methods], key="world"))
    return "\n\n".join(parts)


add(name="study_planners", file="src/app/study/README.md", seeds=STUDY_SEEDS, minutes=28, steps=[study("planners")],
    values=lambda folders: study_values(folders["study"]), text=planners_text)


# Sites from scans: the figures of a study in rows, its worlds or methods in columns.
def by_figure(values, head, key, names, form):
    num_runs = max((int(row.get("seeds") or 0) + int(row.get("failed") or 0) for row in values), default=0)
    rows = []
    for figure, unit in dict.fromkeys((row["figure"], row.get("unit", "")) for row in values):
        cells = [next((study_cell(row, form, num_runs) for row in values if row["figure"] == figure and row[key] == name), NONE) for name in names]
        rows.append([f"{figure}, {unit}" if unit else figure, *cells])
    return markdown([head, *names], rows)


def add_scan_study(name, command, seeds, minutes, text):
    add(name=name, file="src/app/study/README.md", seeds=seeds, minutes=minutes, steps=[study(command, seeds)],
        values=lambda folders: study_values(folders["study"], ("unit",)), text=text)


add_scan_study("study_scan_import", "scan-import", "2001..2002", 5,
               lambda values: by_figure(values, "mean of the seeds", "world", ("tunnel", "substation"), "mean"))
for name, command in (("study_scan_navigation", "scan-navigation"), ("study_scan_navigation_substation", "scan-navigation-substation")):
    add_scan_study(name, command, REPORT, 18, lambda values: f"{legend('the world')}\n\n" + by_figure(
        values, "", "method", ("world", "site of scans"), "compared"))
