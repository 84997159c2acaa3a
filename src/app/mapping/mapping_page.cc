#include "app/mapping/mapping_page.h"

#include <algorithm>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "report/map_picture.h"

namespace patrol::app {
namespace {

report::MapBlock map_block(const MappingContents& contents) {
  std::vector<Eigen::Vector2d> way;
  Eigen::AlignedBox2d shown;
  for (const StampedPose& entry : contents.estimate) {
    way.push_back(entry.pose.position.head<2>());
    shown.extend(way.back());
  }
  const report::MapLayers layers{.built = contents.map, .T_world_map = {}, .truth = {}, .error_m = {}};
  return {.picture = report::map_picture(layers, shown), .paths = {{"estimated path", report::SeriesColor::kEstimate, {std::move(way)}}}, .marks = {}};
}

/// Plot of one cost column, by its name, over the scans.
report::LinePlot plot_of(const MappingContents& contents, const std::string& column, const std::string& title, const std::string& unit) {
  const auto index_of = [&](const std::string& name) {
    return static_cast<std::size_t>(std::ranges::find(contents.cost.columns, name) - contents.cost.columns.begin());
  };
  const std::size_t scans = index_of("scans"), value = index_of(column);
  report::Curve curve{.name = title, .color = report::SeriesColor::kEstimate, .is_dashed = false, .points = {}};
  for (const auto& row : contents.cost.rows) curve.points.emplace_back(std::get<double>(row[scans]), std::get<double>(row[value]));
  const double last = curve.points.empty() ? 1.0 : curve.points.back().x();
  return {.title = title, .unit = unit, .axis = {.label = "scans", .max = last}, .max = {}, .curves = {std::move(curve)}, .marks = {}, .spans = {}};
}

}  // namespace

report::Page mapping_page(const MappingContents& contents) {
  const io::Metrics &log = contents.metrics["log"], &graph = contents.metrics["graph"], &performance = contents.metrics["performance"];
  const report::KeyMetrics figures{.figures = {{.label = "scans", .value = fmt::format("{}", log["scans"].get<std::size_t>()), .unit = "", .note = fmt::format("{:.0f} s", log["duration_s"].get<double>())},
                                               {.label = "way", .value = fmt::format("{:.0f}", contents.metrics["path"]["way_m"].get<double>()), .unit = "m",
                                                .note = fmt::format("by odometry {:.0f} m", log["odometry_way_m"].get<double>())},
                                               {.label = "edges to other submaps", .value = fmt::format("{}", graph["cross_submap_edges"].get<std::size_t>()), .unit = "",
                                                .note = fmt::format("of {}, between {} nodes", graph["edges"].get<std::size_t>(), graph["nodes"].get<std::size_t>())},
                                               {.label = "time", .value = fmt::format("{:.1f}", performance["wall_s"].get<double>()), .unit = "s",
                                                .note = fmt::format("{:.0f} times real time", performance["real_time_factor"].get<double>())},
                                               {.label = "memory", .value = fmt::format("{:.0f}", performance["peak_memory_mb"].get<double>()), .unit = "MB", .note = "the program's peak"}}};
  return {.kind = "mapping",
          .title = fmt::format("{}, mapped by {}", contents.log, contents.method),
          .facts = {},
          .sections = {{"", {figures}},
                       {"Map", {map_block(contents)}},
                       {"What scans cost as the map grew", {plot_of(contents, "ms_per_scan", "Processor time of a scan", "ms"), plot_of(contents, "peak_memory_mb", "Peak memory", "MB")}}},
          .footer = "Made by patrol slam; every setting stands in settings.yaml."};
}

}  // namespace patrol::app
