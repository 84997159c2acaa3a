"""Tables of fault matrices and sweeps."""
from results_tables import NONE, markdown, with_count
from .declare import REPORT_FIVE, Step, add, sweep, swept

for world, scenario in (("street", "short"), ("tunnel", "docking")):
    add(name=f"faults_{world}", file="tools/faults.md", seeds="1 to 3", minutes=6 if world == "street" else 11,
        steps=[Step("faults", ["build/patrol", "fault-matrix", f"worlds/{world}/scenarios/{scenario}.yaml", "--out", "{out}"])],
        values=lambda folders: (folders["faults"] / "faults.md").read_text().splitlines(), text="\n".join)


def stamps_text(values):
    offsets = sorted({run["variant"] for run in values["stamps"]}, key=lambda variant: float(variant.split("=")[1]))
    rows = []
    for offset in offsets:
        runs = [run["metrics"] for run in values["stamps"] if run["variant"] == offset]
        errors = [run["pose.site.ate_rmse_m"] for run in runs if "pose.site.ate_rmse_m" in run]
        figures = [f"{sum(errors) / len(errors):.3f}", with_count(f"{max(errors):.3f}", len(errors), len(runs))] if errors else [NONE, NONE]
        rows.append([f"{1000 * float(offset.split('=')[1]):+.0f} ms", *figures,
                     f"{sum(run.get('mission.completed', False) for run in runs)} of {len(runs)}",
                     sum(run.get("mission.fell", False) for run in runs)])
    return markdown(["lidar stamps", "`pose.site.ate_rmse_m`, mean", "worst", "completed", "falls"], rows)


add(name="lidar_stamps", file="tools/faults.md", seeds=REPORT_FIVE, minutes=12,
    steps=[sweep("stamps", "street/scenarios/patrol", REPORT_FIVE, "--set",
                 "faults=[{sensor: lidar, kind: clock_offset, start_s: 0, duration_s: 10000, magnitude: 0.0}]",
                 "--vary", "faults.0.magnitude=range:-0.05:0.05:11")],
    values=swept(stamps=("pose.site.ate_rmse_m", "mission.completed", "mission.fell")), text=stamps_text)


def localizability_text(values):
    def row(label, path, form):
        cells = [run["metrics"].get(f"localizability.{path}") for run in values["degenerate"]]
        return [label, *(NONE if cell is None else form(cell) for cell in cells)]
    return markdown(["`degenerate.yaml`, S = 1", "default", "`--set sensors.uwb.enabled=false`"], [
        row("poses with more than 10 cm uncertainty from one scan (`degenerate_share`)", "degenerate_share", "{:.0%}".format),
        row("ROC AUC of the covariance for such poses (`covariance_detection`)", "covariance_detection", "{:.3f}".format),
        row("ROC AUC of the confidence (`trust_detection`)", "trust_detection", "{:.2f}".format),
        row("rank correlation of the covariance with the bound", "covariance_rank_correlation", "{:.2f}".format),
        row("error of the weak direction", "weak_direction_error_deg", "{:.2f}°".format)])


add(name="localizability", file="src/app/campaign/sweep/README.md", seeds="1", minutes=1,
    steps=[sweep("degenerate", "tunnel/scenarios/degenerate", "1", "--vary", "sensors.uwb.enabled=true,false")],
    values=swept(degenerate=("localizability.*",)), text=localizability_text)
