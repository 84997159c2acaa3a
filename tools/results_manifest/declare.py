"""Declaration of a table: file, commands, values and text."""
import dataclasses
import typing

from results_tables import Row, met_or_missed, sweep_values

# Seeds of published figures: nothing is tuned on them. Change them here only.
REPORT = "2001..2010"
REPORT_FIVE = "2001..2005"

# Accuracy of an as-built robot that makes its map.
POSE_METRICS = ("pose.site.ate_rmse_m", "pose.aligned.rmse_m", "pose.nees.mean", "calibration.within_95")
CALIBRATION_ROW = Row("true calibration within the 95 % intervals: `calibration.within_95`", "calibration.within_95", ".0%", min)
VERDICT_ROW = Row("expectations of the scenario", "end", met_or_missed, None)
POSE_ROWS = [
    Row("`pose.site.ate_rmse_m`, in the survey frame", "pose.site.ate_rmse_m"),
    Row("`pose.aligned.rmse_m`", "pose.aligned.rmse_m"),
    Row("`pose.nees.mean`", "pose.nees.mean", ".1f"),
    CALIBRATION_ROW,
]


@dataclasses.dataclass
class Step:
    """Command of a table. `{out}` is the step's folder, `{logs}` the folder of recorded logs."""
    key: str
    command: list
    good_codes: tuple = (0, 1)  # 1: an expectation missed; the figures show it


@dataclasses.dataclass
class Table:
    name: str
    file: str
    seeds: str
    minutes: float  # of wall time on two idle cores, estimated
    steps: list
    values: typing.Callable  # {key of step: folder} -> values for the record
    text: typing.Callable  # values -> Markdown
    logs: tuple = ()  # files below --logs that must exist
    targets: tuple = ("patrol",)  # built before the commands
    files: tuple = ()  # that determine the figures besides the program, the robots and the worlds: git's pathspecs
    needs: tuple = ()  # tables whose records are used; values gets {name: values}


def sweep(key, scenario, seeds, *options):
    return Step(key, ["build/patrol", "sweep", f"worlds/{scenario}.yaml", "--seeds", seeds, *options, "--out", "{out}"])


def swept(**metrics):
    """Values of several sweeps: {key: runs}."""
    return lambda folders: {key: sweep_values(folders[key], patterns) for key, patterns in metrics.items()}


def printed(key, folder):
    """Values: the lines that a step printed, with `folder` in place of its output folder."""
    def values(folders):
        text = (folders[key].parent / f"{key}.txt").read_text()
        return text.replace(str(folders[key]), folder).rstrip("\n").splitlines()
    return values


def transcript(lines):
    """Text of what a command printed."""
    return "\n".join(["```", *lines, "```"])


TABLES = []


def add(**fields):
    TABLES.append(Table(**fields))
