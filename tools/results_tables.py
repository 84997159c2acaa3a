"""Values of runs, and Markdown tables made of them."""
import csv
import dataclasses
import json
import math
import re
import statistics
import typing
import xml.etree.ElementTree

NONE = "–"


# --- Values: JSON-like, read from what the commands leave ---------------------------------------------------------------------


def flatten(value, path=""):
    """{path: number} of metrics, lists addressed by name or index, as in `expect:`."""
    if isinstance(value, dict):
        items = [(key, child) for key, child in value.items() if key != "name"]
    elif isinstance(value, list):
        items = [(child.get("name", str(i)) if isinstance(child, dict) else str(i), child) for i, child in enumerate(value)]
    else:
        is_number = isinstance(value, (bool, int, float))
        return {path: value} if is_number else {}
    flat = {}
    for key, child in items:
        flat.update(flatten(child, f"{path}.{key}" if path else key))
    return flat


def matches(pattern, path):
    return re.fullmatch(re.escape(pattern).replace(r"\*", r"[^.]+"), path) is not None


def seeds_of(span):
    """Seeds of "A..B"."""
    first, last = map(int, span.split(".."))
    return range(first, last + 1)


def chosen(metrics, patterns):
    flat = flatten(metrics)
    return {path: round_to(value, 6) for path, value in sorted(flat.items()) if any(matches(pattern, path) for pattern in patterns)}


def run_values(folder, metrics):
    """Metrics of the given patterns of a `patrol run`; none if it has failed."""
    file = folder / "metrics.json"
    return chosen(json.loads(file.read_text()), metrics) if file.exists() else {}


def missed_expectations(folder):
    """Names of the metrics whose expectation a `patrol run` missed, from its JUnit report; first the reason if the run has failed. None
    without a report."""
    file = folder / "junit.xml"
    if not file.exists():
        return None
    missed = []
    for case in xml.etree.ElementTree.parse(file).iter("testcase"):
        bad = next((child for child in case if child.tag in ("failure", "error")), None)
        if bad is not None:
            missed.append(f"run: {bad.get('message')}" if case.get("name") == "run" else case.get("name").split()[0])
    return missed


def sweep_values(folder, metrics):
    """Runs of `patrol sweep`: variant, seed, end and the metrics of the given patterns."""
    manifest = json.loads((folder / "sweep.json").read_text())
    runs = []
    for run in manifest["runs"]:
        result = json.loads((folder / "runs" / f"{run['hash']}.json").read_text())
        runs.append({"variant": manifest["variants"][run["variant"]]["name"], "seed": run["seed"], "end": result["end"],
                     "metrics": chosen(result["metrics"], metrics)})
    return runs


def csv_values(file, columns=None):
    with open(file, newline="") as rows:
        return [{key: value for key, value in row.items() if columns is None or key in columns} for row in csv.DictReader(rows)]


def round_to(value, digits):
    return value if isinstance(value, (bool, int)) else float(f"{value:.{digits}g}")


# --- Tables -------------------------------------------------------------------------------------------------------------------


def markdown(head, rows, align=None):
    lines = [head, align or ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(str(cell) for cell in line) + " |" for line in lines)


def shown(value, form):
    if value is None:
        return NONE
    return form(value) if callable(form) else format(value, form)


@dataclasses.dataclass
class Row:
    """Row of a table with one column per run: a metric, a function of the metrics of a run, or how the run ended ("end")."""
    label: str
    value: typing.Union[str, typing.Callable]
    form: typing.Union[str, typing.Callable] = ".3f"
    worst: typing.Callable = max  # of the values; None: neither mean nor worst

    def of(self, run):
        if self.value == "end":
            return run.get("end")
        return self.value(run["metrics"]) if callable(self.value) else run["metrics"].get(self.value)


def by_seed(runs, rows, published=None):
    """One column per seed, then mean and worst. `published`: {label: text}, a further column."""
    head = ["metric", *(f"S = {run['seed']}" if i == 0 else str(run["seed"]) for i, run in enumerate(runs)), "mean", "worst"]
    lines = []
    for row in rows:
        values = [row.of(run) for run in runs]
        numbers = [value for value in values if isinstance(value, (int, float))]
        line = [row.label, *(shown(value, row.form) for value in values)]
        has_mean = row.worst is not None and numbers and len(numbers) == len(values)
        line += [shown(sum(numbers) / len(numbers), row.form), shown(row.worst(numbers), row.form)] if has_mean else [NONE, NONE]
        lines.append(line)
    if published is not None:
        head.append("published")
        for row, line in zip(rows, lines):
            line.append(published.get(row.label, NONE))
    return markdown(head, lines)


def pair(first, second, form="{} / {}"):
    """Value of two metrics as one text."""
    def value(metrics):
        if first not in metrics or second not in metrics:
            return None
        return form.format(metrics[first], metrics[second])
    return value


def as_text(value):
    return value if isinstance(value, str) else f"{value:g}"


def met_or_missed(end):
    """How a run of a sweep ended, as the verdict on its expectations."""
    return {"done": "met", "expectation missed": "missed"}.get(end, end)


def yes_no(value):
    return "yes" if value else "no"


def count(value):
    return f"{value:.0f}"


def with_count(text, number, total):
    """Text about the runs that have a value, with their number if it is not that of all runs."""
    return text if number == total else f"{text} ({number} of {total} runs)"


def span(runs, path, form, unit=""):
    """Least and largest value of a metric with its unit; the number of runs that have it, unless all have."""
    values = [run["metrics"][path] for run in runs if path in run["metrics"]]
    return with_count(f"{format(min(values), form)} to {format(max(values), form)}{unit}", len(values), len(runs)) if values else NONE


# --- Obstacle courses ---------------------------------------------------------------------------------------------------------


def wilson_interval(successes, runs, z=1.959964):
    """Limits of the 95 % interval of a proportion after Wilson."""
    if runs == 0:
        return 0.0, 1.0
    ratio, square = successes / runs, z * z / runs
    middle = (ratio + square / 2) / (1 + square)
    half = z / (1 + square) * math.sqrt(ratio * (1 - ratio) / runs + square / (4 * runs))
    return max(0.0, middle - half), min(1.0, middle + half)


def course_table(results):
    """Runs of tools/courses: one line per stack."""
    lines = ["| stack | runs | success | 95 % interval | collision | no arrival | median time / optimal time | mean score |",
             "| --- | --- | --- | --- | --- | --- | --- | --- |"]
    for stack in dict.fromkeys(run["stack"] for run in results):
        runs = [run for run in results if run["stack"] == stack]
        successes = sum(run["successful"] for run in runs)
        low, high = wilson_interval(successes, len(runs))
        collided = sum(run["collided"] for run in runs)
        ratios = [run["duration_s"] / run["optimal_time_s"] for run in runs if run["successful"]]
        ratio = f"{statistics.median(ratios):.2f}" if ratios else "–"
        score = sum(run["score"] for run in runs) / len(runs)
        lines.append(f"| {stack.replace('_', '-')} | {len(runs)} | {successes / len(runs):.3f} | {low:.3f} to {high:.3f} | {collided / len(runs):.3f} | "
                     f"{(len(runs) - successes - collided) / len(runs):.3f} | {ratio} | {score:.3f} |")
    return "\n".join(lines) + "\n\nThe score is at most 0.5. The times are those of the successes. The interval is Wilson's.\n"


def growth(rows, size, column):
    """Exponent of a power law through the first and the last row; None with one row."""
    if len(rows) < 2 or rows[0][column] <= 0.0:
        return None
    return math.log(rows[-1][column] / rows[0][column]) / math.log(rows[-1][size] / rows[0][size])


def cost_table(cost):
    """Rows of tools/cost_of_size: one line per run, then the exponents."""
    columns = ("processor_s", "score_s", "memory_mb", "log_mb")
    lines = ["| area (m²) | path (m) | simulated (s) | processor time (s) | scoring (s) | memory (MB) | log (MB) |", "| --- | --- | --- | --- | --- | --- | --- |"]
    shown = []
    for row in [*cost["path"], *cost["site"]]:
        if row in shown:
            continue
        shown.append(row)
        lines.append(f"| {row['area_m2']:.0f} | {row['distance_m']:.0f} | {row['duration_s']:.0f} | {row['processor_s']:.1f} | {row['score_s']:.2f} | "
                     f"{row['memory_mb']:.0f} | {row['log_mb']:.1f} |")
    for name, size in (("path", "distance_m"), ("site", "area_m2")):
        exponents = [growth(cost[name], size, column) for column in columns]
        lines.append(f"| growth with the {name}: exponent | | | " + " | ".join("–" if value is None else f"{value:.2f}" for value in exponents) + " |")
    return "\n".join(lines) + "\n"


def branch_table(rows):
    """Rows of tools/branches: one line per scenario."""
    lines = ["| scenario | simulated (s) | instants | identical | largest snapshot (MB) | one snapshot (ms) | branch / run, processor time |",
             "| --- | --- | --- | --- | --- | --- | --- |"]
    for row in rows:
        branches = row["branches"]
        identical = sum(branch["difference"] is None for branch in branches)
        share = sum(branch["processor_s"] for branch in branches) / len(branches) / row["run_s"]
        lines.append(f"| {row['scenario']} | {row['duration_s']:.0f} | {len(branches)} | {identical} | {row['largest_mb']:.1f} | "
                     f"{row['snapshot_ms']:.0f} | {share:.2f} |")
    return "\n".join(lines) + "\n"


# --- Studies ------------------------------------------------------------------------------------------------------------------


def three_digits(value):
    """Number with three significant digits and without an exponent for large ones."""
    rounded = float(f"{value:.3g}")
    return f"{rounded:.3g}" if abs(rounded) < 1000 else f"{rounded:,.0f}"


def interval(row):
    """Mean of a study's result with half of its 95 % interval, the mean with three digits; the dash if no run has a value."""
    if not row.get("mean"):
        return NONE
    mean = float(row["mean"])
    if not row.get("mean_low"):
        return three_digits(mean)
    return f"{three_digits(mean)} ± {(float(row['mean_high']) - float(row['mean_low'])) / 2:.2g}"


def p_value(row, column):
    """Adjusted p-value in brackets; nothing if there is no comparison."""
    return f" [{float(row[column]):.2g}]" if row.get(column) else ""


def compared(row, num_runs):
    """Mean and interval of a study's result, with the adjusted p-value of its difference from the reference, the number of pairs if it is
    less than that of the runs, and the number of failed runs with the adjusted p-value of equal failure rates."""
    text = interval(row) + p_value(row, "adjusted_p_value")
    failed = int(row.get("failed") or 0)
    if failed:
        text += f"; {failed} failed{p_value(row, 'adjusted_failure_p_value')}"
    is_compared = row.get("adjusted_p_value") or failed
    if is_compared and row.get("pairs") and int(row["pairs"]) < num_runs:
        text += f"; {row['pairs']} pairs"
    return text


def study_cell(row, form, num_runs):
    if form == "published":
        return f"{float(row['published']):.3g}" if row.get("published") else NONE
    if form == "compared":
        return compared(row, num_runs)
    if form == "interval":
        return interval(row)
    return three_digits(float(row["mean"])) if row.get("mean") else NONE


def study_table(rows, head, columns, key="method"):
    """Pivots results of a study. `columns`: (filter, figure, form), with forms "published", "mean", "interval", "compared"; one line per
    value of `key`, in the order of the rows."""
    num_runs = max((int(row.get("seeds") or 0) + int(row.get("failed") or 0) for row in rows), default=0)
    lines = []
    for name in dict.fromkeys(row[key] for row in rows):
        line = [name]
        for wanted, figure, form in columns:
            found = [row for row in rows if row[key] == name and row["figure"] == figure
                     and all(row[column] == value for column, value in wanted.items())]
            line.append(study_cell(found[0], form, num_runs) if found else NONE)
        if any(cell != NONE for cell in line[1:]):
            lines.append(line)
    return markdown(head, lines)


def study_values(folder, columns=()):
    """Results and processor times of a study, with the failures, pairs and adjusted p-values of its comparisons, and further columns of
    text."""
    texts = ("world", "method", "particles", "figure", "seeds", "failed", "pairs", *columns)
    numbers = ("published", "mean", "mean_low", "mean_high", "adjusted_p_value", "adjusted_failure_p_value")
    values = csv_values(folder / "results.csv", texts + numbers) + csv_values(folder / "performance.csv", texts + numbers)
    for row in values:
        for column in numbers:
            if row.get(column):
                row[column] = f"{float(row[column]):.6g}"
    return values


def benchmark_values(file):
    """Ratios of a benchmark's JSON output."""
    found = json.loads(file.read_text())["benchmarks"]
    return {one["name"]: round_to(one["ratio"], 4) for one in found if "ratio" in one and one.get("run_type") != "aggregate"}
