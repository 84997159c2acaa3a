"""Tables of the substation."""
from results_tables import Row, by_seed
from .declare import REPORT, add, sweep, swept

MAPPING_ROWS = [
    Row("`pose.site.ate_rmse_m`, in the survey frame", "pose.site.ate_rmse_m"),
    Row("`pose.aligned.rmse_m`", "pose.aligned.rmse_m"),
    Row("`pose.nees.mean`", "pose.nees.mean", ".1f"),
    Row("true calibration within the 95 % intervals: `calibration.within_95`", "calibration.within_95", ".0%", min),
    Row("map to nearest surface: `map.nearest_mean_m`", "map.nearest_mean_m"),
    Row("`map.coverage`", "map.coverage", ".2f", min),
    Row("distance driven, m", "mission.distance_m", ".0f", min),
    Row("collisions", "mission.collisions", ".0f"),
]

add(name="substation_mapping", file="worlds/substation/README.md", seeds=REPORT, minutes=9,
    steps=[sweep("mapping", "substation/scenarios/mapping", REPORT)],
    values=swept(mapping=("mission.*", "pose.site.ate_rmse_m", "pose.aligned.rmse_m", "pose.nees.mean", "calibration.within_95",
                          "map.nearest_mean_m", "map.coverage")),
    text=lambda values: by_seed(values["mapping"], MAPPING_ROWS))
