"""Tables of the street."""
from results_tables import NONE, Row, as_text, by_seed, csv_values, markdown, pair, span
from .declare import POSE_METRICS, POSE_ROWS, REPORT, REPORT_FIVE, VERDICT_ROW, Step, add, sweep, swept

PATROL_ROWS = [
    *POSE_ROWS,
    Row("box 1 in the map: `site_map_error_m`", "stations.regulator_box_1.site_map_error_m"),
    Row("box 2 in the map", "stations.regulator_box_2.site_map_error_m"),
    Row("valve well 3 in the map", "stations.valve_well_3.site_map_error_m"),
    Row("map to nearest surface: `map.nearest_mean_m`", "map.nearest_mean_m"),
    Row("distance walked, m", "mission.distance_m", ".0f", min),
    Row("leaks found / false alarms", pair("inspection.leaks_found", "inspection.false_alarms"), as_text, None),
    Row("falls / collisions", pair("mission.fell", "mission.collisions", "{:d} / {}"), as_text, None),
    VERDICT_ROW,
    Row("simulated s per wall s", "performance.real_time_factor", ".1f", min),
]
WU25 = {"box 1 in the map: `site_map_error_m`": "[Wu25] 0.92–1.18", "box 2 in the map": "[Wu25] 0.92–1.18",
        "valve well 3 in the map": "[Wu25] 0.92–1.18"}

add(name="street_patrol", file="worlds/street/README.md", seeds=REPORT, minutes=2,
    steps=[sweep("patrol", "street/scenarios/patrol", REPORT)],
    values=swept(patrol=("mission.*", *POSE_METRICS,
                         "stations.*.site_map_error_m", "map.nearest_mean_m", "inspection.*", "performance.real_time_factor")),
    text=lambda values: by_seed(values["patrol"], PATROL_ROWS, WU25))


CART_ROWS = [*PATROL_ROWS[:-5], Row("distance driven, m", "mission.distance_m", ".0f", min), PATROL_ROWS[-4],
             Row("outline to the nearest kerb, minimum: `navigation.clearance.keep_out_min_m`", "navigation.clearance.keep_out_min_m", ".2f", min),
             Row("collisions", "mission.collisions", ".0f"), VERDICT_ROW,
             Row("simulated s per wall s", "performance.real_time_factor", ".1f", min)]

add(name="street_cart", file="worlds/street/README.md", seeds=REPORT, minutes=5,
    steps=[sweep("cart", "street/scenarios/cart", REPORT)],
    values=swept(cart=("mission.*", *POSE_METRICS, "stations.*.site_map_error_m", "map.nearest_mean_m", "inspection.*", "navigation.clearance.*",
                       "performance.real_time_factor")),
    text=lambda values: by_seed(values["cart"], CART_ROWS))

LEAK_STATIONS = {"regulator_box_1": "regulator box 1", "regulator_box_2": "regulator box 2", "valve_well_3": "valve well 3"}
WIND_DIRECTIONS = (240, 60)


def leaks_text(values):
    rows = []
    for station, title in LEAK_STATIONS.items():
        for direction in WIND_DIRECTIONS:
            runs = [run for run in values["leaks"] if f"={station}" in run["variant"] and run["variant"].endswith(f"={direction}")]
            metrics = [run["metrics"] for run in runs]
            found = [one["inspection.findings.0.position_error_m"] for one in metrics if one.get("inspection.leaks_found")]
            columns = span([{"metrics": one} for one in metrics if one.get("inspection.leaks_found")], "inspection.findings.0.column_ppm_m", ".0f")
            rows.append([title, f"{direction}°", f"{len(found)} of {len(runs)}", sum(one.get("inspection.false_alarms", 0) for one in metrics),
                         f"{max(found):.3f}" if found else NONE, columns, f"{sum(one.get('mission.completed', False) for one in metrics)} of {len(runs)}"])
    return markdown(["leak", "wind", "found", "false alarms", "position error of the finding, worst, m", "column of gas, ppm m", "completed"], rows)


add(name="street_leaks", file="worlds/street/README.md", seeds=REPORT, minutes=13,
    steps=[sweep("leaks", "street/scenarios/patrol", REPORT, "--vary", "leaks.0.at=" + ",".join(LEAK_STATIONS),
                 "--vary", "wind.direction_deg=" + ",".join(map(str, WIND_DIRECTIONS)))],
    values=swept(leaks=("inspection.leaks_found", "inspection.false_alarms", "inspection.findings.*.position_error_m", "inspection.findings.*.column_ppm_m",
                        "mission.completed")),
    text=leaks_text)

BUDGET_METRICS = ("pose.site.ate_rmse_m", "map.nearest_mean_m")
BUDGET_TERMS = 5


def budget_values(folders):
    """The rows of each metric; of the error sources, which are sorted, the largest only."""
    rows = csv_values(folders["budget"] / "budget.csv")
    kept = []
    for metric in BUDGET_METRICS:
        of_metric = [row for row in rows if row["metric"] == metric]
        kept += of_metric[:1 + BUDGET_TERMS] + of_metric[-3:]
    return {"sources": len(rows) // len(BUDGET_METRICS) - 4, "rows": kept}


def budget_text(values):
    def cell(row):
        return f"{1000 * float(row['value']):.1f} [{1000 * float(row['low']):.1f}, {1000 * float(row['high']):.1f}]" if row["value"] else NONE
    return markdown(["metric", f"the five largest of {values['sources']} error sources", "mm [95 %]", "p-value [Holm79]"],
                    [[f"`{row['metric']}`" if row["row"] == "baseline" else "", row["row"], cell(row),
                      f"{float(row['p_adjusted']):.2g}" if row["p_adjusted"] else NONE] for row in values["rows"]])


add(name="street_budget", file="worlds/street/README.md", seeds=REPORT_FIVE, minutes=40,
    steps=[Step("budget", ["build/patrol", "error-budget", "worlds/street/scenarios/patrol.yaml", "--seeds", REPORT_FIVE,
                           *(word for metric in BUDGET_METRICS for word in ("--metric", metric)), "--out", "{out}"])],
    values=budget_values, text=budget_text)


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
