"""Tables of benchmarks, speed, cost of size, branches and mutations."""
import json

from results_tables import NONE, benchmark_values, branch_table, cost_table, markdown, yes_no
from .declare import Step, add

BENCHMARKS = ("physics", "lidar", "render", "particle", "plan")


def benchmarks_values(folders):
    return {name: benchmark_values(folders[name] / "benchmark.json") for name in BENCHMARKS}


def benchmarks_text(values):
    return markdown(["benchmark", "ratio to its reference"],
                    [[f"`{bench}_bench`: {name.replace('/manual_time', '')}", f"{ratio:.2f}"]
                     for bench, found in values.items() for name, ratio in found.items()])


add(name="benchmarks", file="tests/README.md", seeds="none", minutes=6,
    steps=[Step(name, [f"build/tests/bench/{name}_bench", "--benchmark_out_format=json", "--benchmark_out={out}/benchmark.json"], (0,))
           for name in BENCHMARKS],
    values=benchmarks_values, text=benchmarks_text, targets=tuple(f"{name}_bench" for name in BENCHMARKS),
    files=("tests/bench",))


SPED = ("street/patrol", "tunnel/navigate", "tunnel/inspection_round", "substation/patrol")
SHOWN_PARTS = ("physics", "lidar", "depth_camera", "slam", "localization", "planning", "inspection", "log")


def speed_values(folders):
    return {key: json.loads((folder / "metrics.json").read_text())["performance"] for key, folder in folders.items()}


def speed_text(values):
    rows = []
    for scenario in SPED:
        one, two = (values[f"{scenario.replace('/', '_')}_{threads}"] for threads in (1, 2))
        simulated_s = one["real_time_factor"] * one["wall_s"]
        parts = [f"{one['parts_s'][part]:.1f}" if part in one["parts_s"] else NONE for part in SHOWN_PARTS]
        rows.append([f"`{scenario}`", f"{simulated_s:.0f}", f"{one['cpu_s']:.1f}", f"{simulated_s / one['cpu_s']:.1f}", f"{one['wall_s']:.1f}",
                     f"{two['wall_s']:.1f}", *parts])
    return markdown(["scenario", "simulated, s", "processor, s", "simulated / processor", "wall, 1 thread, s", "wall, 2 threads, s",
                     *(f"{part.replace('_', ' ')}, s" for part in SHOWN_PARTS)], rows)


add(name="speed", file="tests/README.md", seeds="those of the scenarios", minutes=8,
    steps=[Step(f"{scenario.replace('/', '_')}_{threads}", ["build/patrol", "run", scenario, "--threads", str(threads), "--out", "{out}"])
           for scenario in SPED for threads in (1, 2)],
    values=speed_values, text=speed_text)

add(name="cost_of_size", file="tests/README.md", seeds="1", minutes=3,
    steps=[Step("cost", ["tools/cost_of_size", "--picture", "tests/bench/cost_of_size.svg", "--out", "{out}"])],
    values=lambda folders: json.loads((folders["cost"] / "cost.json").read_text()), text=cost_table, files=("tools/cost_of_size",))

BRANCHED = ("street/patrol", "tunnel/navigate", "tunnel/inspection_round", "substation/patrol")
add(name="branches", file="src/app/README.md", seeds="1", minutes=30,
    steps=[Step("branches", ["tools/branches", *BRANCHED, "--out", "{out}"])],
    values=lambda folders: json.loads((folders["branches"] / "branches.json").read_text()), text=branch_table, files=("tools/branches",))


def mutations_values(folders):
    return json.loads((folders["mutations"] / "mutations.json").read_text())["rows"]


def mutations_text(values):
    return markdown(["mutation", "caught", "by", "first tests, min", "all tests, min"],
                    [[row["summary"], yes_no(row["caught"]), ", ".join(row["tests"]) or NONE, f"{row['first_min']:.1f}",
                      f"{row['all_min']:.1f}" if row["all_min"] else NONE] for row in values])


add(name="mutations", file="tests/mutation/README.md", seeds="those of the tests", minutes=40,
    steps=[Step("mutations", ["tests/mutation/run", "--out", "{out}"])], values=mutations_values, text=mutations_text, targets=(),
    files=("tests",))
