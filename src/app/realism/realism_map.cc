#include "app/realism/realism_map.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "report/map_picture.h"

namespace patrol::app {
namespace {

/// Points of a scan as strokes of the width of a mark.
report::MapPath points_of(const realism::PosedScan& posed, const std::string& name, report::SeriesColor color,
                          double half_m, Eigen::AlignedBox2d& box) {
  report::MapPath path{.name = name, .color = color, .pieces_m = {}};
  for (std::size_t i = 0; i < posed.num_beams(); ++i) {
    const double range_m = static_cast<double>(posed.scan.ranges_m[i]);
    if (!std::isfinite(range_m) || range_m <= 0.0 || range_m >= posed.scan.range_max_m) continue;
    const Eigen::Vector3d point =
        posed.pose_of(i) * Eigen::Vector3d(range_m * posed.direction_at(posed.azimuth_rad(i)));
    const Eigen::Vector2d p_m = point.head<2>();
    path.pieces_m.push_back({p_m - Eigen::Vector2d(half_m, 0.0), p_m + Eigen::Vector2d(half_m, 0.0)});
    box.extend(p_m);
  }
  return path;
}

}  // namespace

report::MapBlock residual_map(const realism::ScanSet& set) {
  constexpr double kCell_m = 0.05;
  Eigen::AlignedBox2d box;
  for (const realism::Beam& beam : set.beams) {
    if (beam.kind == realism::BeamClass::kStatic) box.extend(Eigen::Vector2d(beam.x_m, beam.y_m));
  }
  std::vector<Eigen::Vector2d> path;
  for (const realism::PosedScan& posed : set.scans) {
    path.emplace_back(posed.T_site_lidar.front().position.head<2>());
    box.extend(path.back());
  }
  constexpr double kMaxCells = 4e6;
  double cell_m = kCell_m;
  while (box.sizes().prod() > kMaxCells * cell_m * cell_m) cell_m *= 2.0;
  const GridGeometry geometry{.resolution_m = cell_m,
                              .width = static_cast<int>(std::ceil(box.sizes().x() / cell_m)) + 1,
                              .height = static_cast<int>(std::ceil(box.sizes().y() / cell_m)) + 1,
                              .origin_m = box.min()};
  OccupancyGrid cells(geometry, kUnknown);
  Grid<float> sums(geometry, 0.0f), counts(geometry, 0.0f);
  Grid<float> errors(geometry, std::numeric_limits<float>::quiet_NaN());
  for (const realism::Beam& beam : set.beams) {
    if (beam.kind != realism::BeamClass::kStatic) continue;
    const Cell cell = geometry.cell_at({beam.x_m, beam.y_m});
    if (!cells.contains(cell)) continue;
    cells.at(cell) = kOccupied;
    sums.at(cell) += static_cast<float>(std::abs(beam.residual_m()));
    counts.at(cell) += 1.0f;
    errors.at(cell) = sums.at(cell) / counts.at(cell);
  }
  const report::MapLayers layers{.built = cells, .T_world_map = {}, .truth = {}, .error_m = errors};
  return {.picture = report::map_picture(layers, box),
          .paths = {{"path of the lidar", report::SeriesColor::kEstimate, {std::move(path)}}},
          .marks = {},
          .error_name = "mean |residual|"};
}

report::PlanView scan_overlay(const realism::ScanSet& recorded, const realism::ScanSet& simulated, std::size_t scan) {
  const realism::PosedScan& posed = recorded.scans[scan];
  Eigen::AlignedBox2d box(Eigen::Vector2d(posed.T_site_lidar.front().position.head<2>()));
  report::PlanView view{.caption = fmt::format("Scan {} of {}", scan + 1, recorded.scans.size()),
                        .x_title = "x in site, m",
                        .y_title = "y in site, m",
                        .paths = {},
                        .marks = {{.label = "lidar",
                                   .color = report::SeriesColor::kEvent,
                                   .p_m = posed.T_site_lidar.front().position.head<2>()}}};
  constexpr double kSize = 0.002;  // of the strokes relative to the picture
  Eigen::AlignedBox2d extent = box;
  points_of(posed, "", report::SeriesColor::kTruth, 0.0, extent);
  const double half_m = kSize * extent.sizes().maxCoeff();
  view.paths.push_back(points_of(simulated.scans[scan], "simulated", report::SeriesColor::kTruth, half_m, box));
  view.paths.push_back(points_of(posed, "recorded", report::SeriesColor::kEstimate, half_m, box));
  view.low_m = box.min().array() - 0.5;
  view.high_m = box.max().array() + 0.5;
  return view;
}

}  // namespace patrol::app
