"""Tables of the substation."""
from results_tables import Row, by_seed
from .declare import POSE_METRICS, POSE_ROWS, REPORT, VERDICT_ROW, add, sweep, swept

MAPPING_ROWS = [
    *POSE_ROWS,
    Row("map to nearest surface: `map.nearest_mean_m`", "map.nearest_mean_m"),
    Row("`map.coverage`", "map.coverage", ".2f", min),
    Row("distance driven, m", "mission.distance_m", ".0f", min),
    Row("collisions", "mission.collisions", ".0f"),
    VERDICT_ROW,
]

add(name="substation_mapping", file="worlds/substation/README.md", seeds=REPORT, minutes=9,
    steps=[sweep("mapping", "substation/scenarios/mapping", REPORT)],
    values=swept(mapping=("mission.*", *POSE_METRICS,
                          "map.nearest_mean_m", "map.coverage")),
    text=lambda values: by_seed(values["mapping"], MAPPING_ROWS))

PATROL_ROWS = [*MAPPING_ROWS[:-1],
               Row("outline to the nearest kerb, minimum: `navigation.clearance.keep_out_min_m`", "navigation.clearance.keep_out_min_m", ".2f", min),
               VERDICT_ROW, Row("simulated s per wall s", "performance.real_time_factor", ".1f", min)]

add(name="substation_patrol", file="worlds/substation/README.md", seeds=REPORT, minutes=3,
    steps=[sweep("patrol", "substation/scenarios/patrol", REPORT)],
    values=swept(patrol=("mission.*", *POSE_METRICS, "map.nearest_mean_m", "map.coverage", "navigation.clearance.*", "performance.real_time_factor")),
    text=lambda values: by_seed(values["patrol"], PATROL_ROWS))
