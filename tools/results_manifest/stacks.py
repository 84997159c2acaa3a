"""Tables of stacks that take part by the turn protocol."""
from results_tables import Row, as_text, by_seed
from .declare import REPORT, add, sweep, swept


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
