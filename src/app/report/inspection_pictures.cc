#include "app/report/inspection_pictures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "core/chi_squared.h"
#include "core/geometry/linear_algebra.h"
#include "core/trajectory.h"

namespace patrol::app {
namespace {

using report::SeriesColor;

constexpr double kMinColorRange_mm = 3.0;
constexpr double kShownRadius_m = 60.0;  // true bodies farther from the robot are not shown
constexpr double kMargin_m = 2.0;

/// Number of sectors of the lining from the crown to the invert.
int half_sectors(double sector_deg) { return static_cast<int>(180.0 / sector_deg); }

/// Row of a sector's center in the unrolled lining: the invert's left edge is at the top, the crown in the middle.
int lining_row(double clock_deg, double sector_deg) {
  const double from_crown_deg = clock_deg > 180.0 ? clock_deg - 360.0 : clock_deg;
  const int half = half_sectors(sector_deg);
  return half + std::clamp(static_cast<int>(std::lround(from_crown_deg / sector_deg)), -half, half);
}

/// Labels of the rows, named for a viewer who looks along the axis.
std::vector<std::string> row_labels(double sector_deg) {
  std::vector<std::string> labels(static_cast<std::size_t>(2 * half_sectors(sector_deg) + 1));
  labels[static_cast<std::size_t>(lining_row(270.0, sector_deg))] = "left wall";
  labels[static_cast<std::size_t>(lining_row(0.0, sector_deg))] = "crown";
  labels[static_cast<std::size_t>(lining_row(90.0, sector_deg))] = "right wall";
  return labels;
}

/// Truth of the rings that are scored at a station, below their columns.
std::vector<report::HeatMap::ColumnNote> true_peaks(const io::Metrics& metrics, const std::string& station,
                                                    int first_ring) {
  std::vector<report::HeatMap::ColumnNote> notes;
  if (!io::metric_at(metrics, "inspection.lining.stations")) return notes;
  for (const io::Metrics& ring : metrics["inspection"]["lining"]["rings"]) {
    if (ring.value("station", "") != station) continue;
    const double peak_mm = ring.value("true_peak_mm", 0.0);
    notes.push_back({.column = ring.value("ring", 0) - first_ring,
                     .text = fmt::format("{:.1f}", peak_mm),
                     .tone = ring.value("is_found", false) == (std::abs(peak_mm) > 0.0) ? report::Tone::kGood
                                                                                        : report::Tone::kBad});
  }
  return notes;
}

/// Removes the rows above the first and below the last cell: the scanner does not see the invert.
void trim_rows(report::HeatMap& map) {
  const auto [top, bottom] = std::ranges::minmax_element(map.cells, {}, &report::HeatMap::Cell::row);
  const int first = top->row, last = bottom->row;
  map.rows = {map.rows.begin() + first, map.rows.begin() + last + 1};
  for (report::HeatMap::Cell& cell : map.cells) cell.row -= first;
  for (report::HeatMap::Mark& mark : map.marks) mark.row = std::clamp(mark.row - first, 0, last - first);
}

report::HeatMap unrolled_lining(const LiningResult& result, const io::Metrics& metrics, double sector_deg) {
  const auto [first, last] = std::ranges::minmax_element(result.cells, {}, &LiningCell::ring);
  const int first_ring = first->ring, num_rings = last->ring - first->ring + 1;
  report::HeatMap map{.caption =
                          fmt::format("Lining at {}, unrolled: displacement since the reference scan", result.station),
                      .unit = "mm",
                      .negative = "outward",
                      .positive = "inward",
                      .max = kMinColorRange_mm,
                      .column_title = "ring",
                      .columns = {},
                      .rows = row_labels(sector_deg),
                      .cells = {},
                      .marks = {},
                      .notes_title = "true peak, mm",
                      .notes = true_peaks(metrics, result.station, first_ring)};
  for (int i = 0; i < num_rings; ++i) map.columns.push_back(fmt::format("{}", first_ring + i));
  for (const LiningCell& cell : result.cells) {
    map.cells.push_back({.column = cell.ring - first_ring,
                         .row = lining_row(cell.clock_deg, sector_deg),
                         .value = 1e3 * cell.inward_m});
  }
  for (const RingFinding& finding : result.findings) {
    map.max = std::max(map.max, std::ceil(1e3 * std::abs(finding.inward_m)));
    map.marks.push_back({.column = finding.ring - first_ring,
                         .row = lining_row(finding.clock_deg, sector_deg),
                         .text = fmt::format("{:+.1f} ± {:.1f} mm", 1e3 * finding.inward_m, 2e3 * finding.std_m)});
  }
  trim_rows(map);
  std::erase_if(map.notes, [&](const auto& note) { return note.column < 0 || note.column >= num_rings; });
  return map;
}

/// Ellipse through the directions of a 2D covariance, scaled by `radius` standard deviations.
std::vector<Eigen::Vector2d> ellipse(const Eigen::Vector2d& center_m, const Eigen::Matrix2d& covariance_m2,
                                     double radius) {
  constexpr int kNumPoints = 72;
  const SymmetricEigen<2> axes = symmetric_eigen(covariance_m2);
  const Eigen::Matrix2d half_axes = axes.vectors * axes.values.cwiseMax(0.0).cwiseSqrt().asDiagonal();
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i <= kNumPoints; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kNumPoints;
    points.emplace_back(center_m + radius * half_axes * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
  }
  return points;
}

std::vector<Eigen::Vector2d> circle(const Eigen::Vector2d& center_m, double radius_m) {
  return ellipse(center_m, Eigen::Matrix2d::Identity(), radius_m);
}

/// A reported body and the true ones, in the frame of the robot: x ahead, y left, z up.
struct WaterScene {
  Eigen::Vector3d p_reported_m;
  Eigen::Matrix3d covariance_m2;
  double radius_m;
  std::vector<std::pair<Eigen::Vector3d, double>> true_bodies;  ///< center and radius, m
};

WaterScene scene_of(const WaterResult& result, const RunContents& run) {
  const double height_m = pose_at(run.record.T_world_body, result.stamp).value_or(Pose3{}).position.z();
  const Pose3 T_map_robot = to_pose3(result.T_map_body);
  const Pose3 T_robot_world = (to_pose3(run.T_world_map, height_m) * T_map_robot).inverse();
  const Eigen::Matrix3d R_robot_map = T_map_robot.inverse().rotation.toRotationMatrix();
  WaterScene scene{.p_reported_m = T_map_robot.inverse() * result.p_map,
                   .covariance_m2 = R_robot_map * result.covariance_m2 * R_robot_map.transpose(),
                   .radius_m = result.radius_m,
                   .true_bodies = {}};
  for (const sim::WaterBodySettings& body : run.scenario.water_bodies) {
    const Eigen::Vector3d p_robot_m = T_robot_world * Eigen::Vector3d(body.x_m, body.y_m, body.z_m);
    if (p_robot_m.norm() <= kShownRadius_m) scene.true_bodies.emplace_back(p_robot_m, body.radius_m);
  }
  return scene;
}

/// View along an axis of the robot's frame: x to the right, `axis_y` upward.
report::PlanView view_of(const WaterScene& scene, const std::string& caption, Eigen::Index axis_y,
                         const std::string& y_title) {
  const std::array<Eigen::Index, 2> axes{0, axis_y};
  const auto project = [&](const Eigen::Vector3d& p_m) { return Eigen::Vector2d(p_m(axes[0]), p_m(axes[1])); };
  report::PlanView view{.caption = caption,
                        .x_title = "ahead of the robot, m",
                        .y_title = y_title,
                        .paths = {},
                        .marks = {{.label = "robot", .color = SeriesColor::kEvent, .p_m = Eigen::Vector2d::Zero()}}};
  report::MapPath truth{.name = "true body (sphere of equal volume)", .color = SeriesColor::kTruth, .pieces_m = {}};
  for (const auto& [p_m, radius_m] : scene.true_bodies) truth.pieces_m.push_back(circle(project(p_m), radius_m));
  const Eigen::Vector2d center_m = project(scene.p_reported_m);
  const Eigen::Matrix2d covariance_m2 = scene.covariance_m2(axes, axes);
  view.paths = {
      truth,
      {.name = "reported body", .color = SeriesColor::kEstimate, .pieces_m = {circle(center_m, scene.radius_m)}},
      {.name = "95 % ellipsoid of its center",
       .color = SeriesColor::kConfidence,
       .pieces_m = {ellipse(center_m, covariance_m2, std::sqrt(kChiSquared95Of3))}}};
  for (const report::MapPath& path : view.paths) {
    for (const std::vector<Eigen::Vector2d>& piece : path.pieces_m) {
      for (const Eigen::Vector2d& p_m : piece) {
        view.low_m = view.low_m.cwiseMin(p_m);
        view.high_m = view.high_m.cwiseMax(p_m);
      }
    }
  }
  view.low_m.array() -= kMargin_m;
  view.high_m.array() += kMargin_m;
  return view;
}

}  // namespace

std::vector<report::Block> lining_pictures(const RunContents& run) {
  std::vector<report::Block> blocks;
  for (const LiningResult& result : run.record.linings) {
    if (!result.is_registered || result.cells.empty()) continue;
    blocks.emplace_back(unrolled_lining(result, run.metrics, run.scenario.stack.inspection.lining.sector_deg));
  }
  return blocks;
}

std::vector<report::Block> water_pictures(const RunContents& run) {
  std::vector<report::Block> blocks;
  for (const WaterResult& result : run.record.waters) {
    if (!result.is_found) continue;
    const WaterScene scene = scene_of(result, run);
    blocks.emplace_back(view_of(scene, fmt::format("Water at {}, from above", result.station), 1, "to the left, m"));
    blocks.emplace_back(view_of(scene, fmt::format("Water at {}, from the right", result.station), 2, "up, m"));
  }
  return blocks;
}

}  // namespace patrol::app
