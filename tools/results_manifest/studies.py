"""Tables of published experiments."""
from results_tables import study_table, study_values
from .declare import Step, add


def study(name, seeds=None):
    return Step("study", ["build/patrol", "study", name, *(["--seeds", seeds] if seeds else []), "--out", "{out}"], (0,))


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
