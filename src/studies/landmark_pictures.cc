#include "studies/landmark_pictures.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "studies/landmark_track.h"

namespace patrol::studies {
namespace {

using report::SeriesColor;

std::string label_of(const LandmarkMethod& method) {
  return method.particles > 0 ? fmt::format("{} ({})", method.name, method.particles) : method.name;
}

std::vector<Eigen::Vector2d> positions(const std::vector<Pose2>& poses) {
  std::vector<Eigen::Vector2d> positions;
  for (const Pose2& pose : poses) positions.push_back(pose.position());
  return positions;
}

report::Curve error_curve(const LandmarkMethod& method, const LandmarkTrack& track, const LandmarkRun& run,
                          double step_s, SeriesColor color) {
  report::Curve curve{.name = label_of(method), .color = color, .is_dashed = false, .points = {}};
  for (std::size_t k = 0; k < run.truth.size(); ++k) {
    const double error_m = (track.estimates[k].T_map_body.position() - run.truth[k].position()).norm();
    curve.points.emplace_back(step_s * static_cast<double>(k + 1), error_m);
  }
  return curve;
}

report::MapBlock map_of(const LandmarkWorld& world, const LandmarkRun& run, const LandmarkTrack& track) {
  const std::vector<report::MapPath> paths = {{"true path", SeriesColor::kTruth, {positions(run.truth)}},
                                              {"estimated path", SeriesColor::kEstimate, {positions(track.poses())}}};
  std::vector<report::MapMark> marks;
  Eigen::AlignedBox2d shown;
  for (const Eigen::Vector2d& p_m : world.landmarks_m) {
    marks.push_back({.label = "", .color = SeriesColor::kTruth, .p_m = p_m});
    shown.extend(p_m);
  }
  for (const auto& p_m : track.landmarks) {
    if (p_m) marks.push_back({.label = "", .color = SeriesColor::kEstimate, .p_m = *p_m});
  }
  for (const report::MapPath& path : paths) {
    for (const Eigen::Vector2d& p_m : path.pieces_m.front()) shown.extend(p_m);
  }
  return {.picture = report::map_picture(
              {.built = OccupancyGrid(GridGeometry{}), .T_world_map = {}, .truth = {}, .error_m = {}}, shown),
          .paths = paths,
          .marks = marks};
}

}  // namespace

std::vector<report::Section> landmark_sections(const LandmarkWorld& world, const std::vector<LandmarkMethod>& methods,
                                               std::uint64_t seed) {
  constexpr std::array kColors = {SeriesColor::kOdometry, SeriesColor::kRanges, SeriesColor::kConfidence,
                                  SeriesColor::kEvent,    SeriesColor::kAlarm,  SeriesColor::kBound};
  constexpr std::size_t kMaps = 4;
  const LandmarkRun run = simulate(world, seed);
  const double end_s = world.motion.step_s * static_cast<double>(run.truth.size());
  const int particles = methods.front().particles;
  report::LinePlot errors{.title = fmt::format("Position error over time, world {}, seed {}", world.name, seed),
                          .unit = "m",
                          .axis = {.label = "s", .max = end_s},
                          .max = {},
                          .curves = {},
                          .marks = {},
                          .spans = {}};
  std::vector<report::Section> maps;
  for (std::size_t i = 0; i < methods.size(); ++i) {
    const bool is_last = i + 1 == methods.size();
    if (methods[i].particles != particles && !is_last) continue;
    const LandmarkTrack track = follow(methods[i], world, run, seed);
    if (errors.curves.size() < kColors.size() || is_last) {
      errors.curves.push_back(error_curve(methods[i], track, run, world.motion.step_s,
                                          is_last ? SeriesColor::kEstimate : kColors[errors.curves.size()]));
    }
    if (i < kMaps || is_last) maps.push_back({label_of(methods[i]), {map_of(world, run, track)}});
  }
  std::vector<report::Section> sections = {{"Errors over time", {errors}}};
  for (report::Section& map : maps) sections.push_back(std::move(map));
  return sections;
}

}  // namespace patrol::studies
