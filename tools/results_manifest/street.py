"""Tables of the street."""
from results_tables import Row, as_text, by_seed, markdown, pair
from .declare import REPORT, REPORT_FIVE, add, sweep, swept

PATROL_ROWS = [
    Row("`pose.site.ate_rmse_m`, in the survey frame", "pose.site.ate_rmse_m"),
    Row("`pose.aligned.rmse_m`", "pose.aligned.rmse_m"),
    Row("`pose.nees.mean`", "pose.nees.mean", ".1f"),
    Row("true calibration within the 95 % intervals: `calibration.within_95`", "calibration.within_95", ".0%", min),
    Row("box 1 in the map: `site_map_error_m`", "stations.regulator_box_1.site_map_error_m"),
    Row("box 2 in the map", "stations.regulator_box_2.site_map_error_m"),
    Row("valve well 3 in the map", "stations.valve_well_3.site_map_error_m"),
    Row("map to nearest surface: `map.nearest_mean_m`", "map.nearest_mean_m"),
    Row("distance walked, m", "mission.distance_m", ".0f", min),
    Row("leaks found / false alarms", pair("inspection.leaks_found", "inspection.false_alarms"), as_text, None),
    Row("falls / collisions", lambda m: f"{m['mission.fell']:d} / {m['mission.collisions']}", as_text, None),
    Row("simulated s per wall s", "performance.real_time_factor", ".1f", min),
]
WU25 = {"box 1 in the map: `site_map_error_m`": "[Wu25] 0.92–1.18", "box 2 in the map": "[Wu25] 0.92–1.18",
        "valve well 3 in the map": "[Wu25] 0.92–1.18"}

add(name="street_patrol", file="worlds/street/README.md", seeds=REPORT, minutes=2,
    steps=[sweep("patrol", "street/scenarios/patrol", REPORT)],
    values=swept(patrol=("mission.*", "pose.site.ate_rmse_m", "pose.aligned.rmse_m", "pose.nees.mean", "calibration.within_95",
                         "stations.*.site_map_error_m", "map.nearest_mean_m", "inspection.*", "performance.real_time_factor")),
    text=lambda values: by_seed(values["patrol"], PATROL_ROWS, WU25))


def methods_text(values):
    def cell(runs, method):
        chosen = [run["metrics"] for run in runs if run["variant"].endswith(method)]
        means = [sum(run[path] for run in chosen) / len(chosen) for path in ("pose.site.ate_rmse_m", "map.nearest_mean_m")]
        return f"{means[0]:.3f}, {means[1]:.3f} m"
    return markdown(["", "`rbpf`", "`graph`"],
                    [[label, cell(values[key], "rbpf"), cell(values[key], "graph")] for label, key in
                     (("street, `patrol.yaml`", "street"), ("tunnel, `mapping.yaml`", "tunnel"))])


add(name="slam_methods", file="worlds/street/README.md", seeds=REPORT_FIVE, minutes=6,
    steps=[sweep("street", "street/scenarios/patrol", REPORT_FIVE, "--vary", "stack.slam.method=rbpf,graph"),
           sweep("tunnel", "tunnel/scenarios/mapping", REPORT_FIVE, "--vary", "stack.slam.method=rbpf,graph")],
    values=swept(street=("pose.site.ate_rmse_m", "map.nearest_mean_m"), tunnel=("pose.site.ate_rmse_m", "map.nearest_mean_m")), text=methods_text)
