"""Tables of stacks that take part by the turn protocol."""
import dataclasses
import json

from results_tables import Row, as_text, by_seed, course_table, markdown, pair, span
from .declare import REPORT, Step, add, sweep, swept


def reached(metrics):
    return sum(value > 0 for path, value in metrics.items() if path.startswith("goals.") and path.endswith(".arrivals"))


def at_goal(number):
    def value(metrics):
        error = metrics.get(f"goals.goal_{number}.position_error_m.mean")
        return None if error is None else f"{100 * error:.0f}"
    return value


MRPT_ROWS = [
    Row("goals reached, of 3", reached, as_text, None),
    Row("collisions", "mission.collisions", ".0f", max),
    *(Row(f"error at goal {i}, cm", at_goal(i), as_text, None) for i in (1, 2, 3)),
    Row("`pose.site.ate_rmse_m`", "pose.site.ate_rmse_m", ".2f"),
    Row("simulated time, s", "mission.duration_s", ".0f", max),
]

add(name="stack_mrpt", file="src/link/README.md", seeds=REPORT, minutes=12,
    steps=[sweep("built_in", "tunnel/scenarios/navigate", REPORT),
           sweep("mrpt", "tunnel/scenarios/navigate", REPORT, "--set", "stack.command=build/tests/interop/mrpt/mrpt_stack")],
    values=swept(**{key: ("mission.*", "goals.*.arrivals", "goals.*.position_error_m.mean", "pose.site.ate_rmse_m") for key in ("built_in", "mrpt")}),
    text=lambda values: "Built-in stack:\n\n" + by_seed(values["built_in"], MRPT_ROWS) + "\n\nMRPT:\n\n" + by_seed(values["mrpt"], MRPT_ROWS),
    targets=("patrol", "mrpt_stack"), files=("tests/interop/mrpt",))

FACTORS = (0, 1, 3, 10, 20, 30, 60)


def compute_text(values):
    rows = []
    for factor in FACTORS:
        runs = [run for run in values["compute"] if run["variant"].endswith(f"={factor}")]
        metrics = [run["metrics"] for run in runs]
        rows.append([factor, f"{sum(bool(one.get('mission.completed')) for one in metrics)} of {len(runs)}",
                     span(runs, "mission.collisions", ".0f"), span(runs, "pose.site.ate_rmse_m", ".3f"),
                     span(runs, "map.nearest_mean_m", ".3f")])
    return markdown(["`stack.compute.factor`", "missions completed", "collisions", "`pose.site.ate_rmse_m`", "`map.nearest_mean_m`"], rows)


# Runs of the slowest computer go on to the time limit.
COMPUTE_SEEDS = "2001..2003"
add(name="stack_compute", file="src/link/README.md", seeds=COMPUTE_SEEDS, minutes=11,
    steps=[dataclasses.replace(sweep("compute", "street/scenarios/patrol", COMPUTE_SEEDS, "--set", "stack.compute.model=measured", "--jobs", "1",
                                     "--vary", "stack.compute.factor=" + ",".join(map(str, FACTORS))), good_codes=(0, 1, 4))],
    values=swept(compute=("mission.completed", "mission.collisions", "pose.site.ate_rmse_m", "map.nearest_mean_m")),
    text=compute_text)

# 50 courses, of which none has been used to choose a setting.
COURSES, COURSE_SEEDS = "1..50", "2001..2003"
add(name="courses", file="worlds/README.md", seeds=COURSE_SEEDS, minutes=25,
    steps=[Step("courses", ["tools/courses", COURSES, "--seeds", COURSE_SEEDS, "--stack", "built_in", "--stack", "mrpt=build/tests/interop/mrpt/mrpt_stack", "--jobs", "2", "--out", "{out}"])],
    values=lambda folders: json.loads((folders["courses"] / "courses.json").read_text()),
    text=course_table, targets=("patrol", "mrpt_stack"), files=("tests/interop/mrpt", "tools/courses"))
