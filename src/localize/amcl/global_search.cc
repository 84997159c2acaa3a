#include "localize/amcl/global_search.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "core/particle_weights.h"
#include "localize/amcl/distance_to_occupied.h"

namespace patrol::localize {
namespace {

// difference in log likelihood to the best position beyond which positions are skipped
constexpr double kNegligible = 12.0;
constexpr int kFineSteps = 4;         // fine steps per coarse step along x and y
constexpr int kFineTurns = 5;         // fine steps per coarse step in heading

/// Center of part `i` of `parts` equal parts of a step centered on 0.
double part_of_step(int i, int parts, double step) { return ((i + 0.5) / parts - 0.5) * step; }

RangeLikelihoodSettings widened(RangeLikelihoodSettings settings, double step_m) {
  settings.range_std_m = std::hypot(settings.range_std_m, 0.5 * step_m);
  return settings;
}

double log_likelihood_of(const std::vector<AnchoredRange>& ranges, const Pose2& pose, const RangeLikelihoodSettings& settings) {
  double sum = 0.0;
  for (const AnchoredRange& range : ranges) sum += range_log_likelihood(range_excess_m(range, pose), settings);
  return sum;
}

}  // namespace

GlobalSearch::GlobalSearch(const GlobalSearchSettings& settings, const LikelihoodFieldSettings& field, const OccupancyGrid& map,
                           const LineField& lines)
    : settings_(settings),
      coarse_({.hit_std_m = std::hypot(field.hit_std_m, settings.step_m), .random_share = field.random_share, .max_beams = settings.max_beams},
              map, lines),
      fine_(field, map, lines) {
  const GridGeometry& geometry = map.geometry();
  const Grid<float> clearance_m = distance_to_occupied(map, settings.min_clearance_m + geometry.resolution_m);
  const int stride = std::max(1, static_cast<int>(std::lround(settings.step_m / geometry.resolution_m)));
  for (int row = stride / 2; row < geometry.height; row += stride) {
    for (int col = stride / 2; col < geometry.width; col += stride) {
      const bool has_room = static_cast<double>(clearance_m.at({col, row})) > settings.min_clearance_m;
      if (has_room && is_free(map.at({col, row}))) free_places_.push_back(geometry.center_of({col, row}));
    }
  }
  if (!free_places_.empty()) return;
  for (int row = 0; row < geometry.height; ++row) {  // the map is too small for the grid
    for (int col = 0; col < geometry.width; ++col) {
      if (is_free(map.at({col, row}))) free_places_.push_back(geometry.center_of({col, row}));
    }
  }
}

// Ignores the lever arm of the antenna, which is shorter than the coarse step.
std::vector<GlobalSearch::Place> GlobalSearch::places_by_range(const std::vector<AnchoredRange>& ranges,
                                                               const RangeLikelihoodSettings& settings) const {
  std::vector<Place> places;
  double best = -std::numeric_limits<double>::infinity();
  for (const Eigen::Vector2d& p_map : free_places_) {
    places.push_back({p_map, log_likelihood_of(ranges, {p_map.x(), p_map.y(), 0.0}, settings)});
    best = std::max(best, places.back().log_ranges);
  }
  std::erase_if(places, [&](const Place& place) { return place.log_ranges < best - kNegligible; });
  return places;
}

GlobalSearch::Candidates GlobalSearch::find(const LevelScan& scan, const std::vector<AnchoredRange>& ranges,
                                            const RangeLikelihoodSettings& range_settings, double independent_beams,
                                            double uniform) const {
  const BeamEnds ends = select_beam_ends(scan, settings_.max_beams);
  const double scan_gain = std::min(independent_beams, static_cast<double>(ends.size()));
  const std::vector<Place> places = places_by_range(ranges, widened(range_settings, settings_.step_m));
  if (places.empty()) return {};
  const int turns = static_cast<int>(std::ceil(2.0 * std::numbers::pi / settings_.step_rad));
  const double step_rad = 2.0 * std::numbers::pi / turns;
  const auto coarse_pose = [&](std::size_t i) {
    const Place& place = places[i / static_cast<std::size_t>(turns)];
    return Pose2{place.p_map.x(), place.p_map.y(), wrap_angle(static_cast<double>(i % static_cast<std::size_t>(turns)) * step_rad)};
  };

  std::vector<double> log_coarse(places.size() * static_cast<std::size_t>(turns));
  for (std::size_t i = 0; i < log_coarse.size(); ++i) {
    log_coarse[i] = places[i / static_cast<std::size_t>(turns)].log_ranges + scan_gain * coarse_.mean_log(ends, coarse_pose(i));
  }
  const std::vector<double> coarse = normalized_weights(log_coarse);
  const auto samples = static_cast<std::size_t>(settings_.coarse_samples);
  std::vector<std::size_t> chosen = resample_systematic(coarse, uniform, samples);

  Candidates candidates;
  candidates.half_step_m = 0.5 * settings_.step_m / kFineSteps;
  candidates.half_step_rad = 0.5 * step_rad / kFineTurns;
  std::vector<double> log_fine;
  for (std::size_t first = 0; first < chosen.size();) {
    const std::size_t cell = chosen[first];
    std::size_t end = first;
    while (end < chosen.size() && chosen[end] == cell) ++end;
    // Importance weight of the sampled cell: number of samples relative to the expected number.
    const double log_share = std::log(static_cast<double>(end - first) / (static_cast<double>(samples) * coarse[cell]));
    const Pose2 center = coarse_pose(cell);
    for (int part = 0; part < kFineSteps * kFineSteps * kFineTurns; ++part) {
      const Pose2 pose{center.x + part_of_step(part % kFineSteps, kFineSteps, settings_.step_m),
                       center.y + part_of_step(part / kFineSteps % kFineSteps, kFineSteps, settings_.step_m),
                       wrap_angle(center.yaw + part_of_step(part / (kFineSteps * kFineSteps), kFineTurns, step_rad))};
      candidates.T_map_body.push_back(pose);
      log_fine.push_back(log_share + scan_gain * fine_.mean_log(ends, pose) + log_likelihood_of(ranges, pose, range_settings));
    }
    first = end;
  }
  candidates.weights = normalized_weights(log_fine);
  return candidates;
}

std::vector<Pose2> draw_poses(const GlobalSearch::Candidates& candidates, std::size_t count, const RandomStream& noise, std::uint64_t tick) {
  if (candidates.weights.empty() || count == 0) return {};
  std::vector<Pose2> poses;
  const std::vector<std::size_t> parents = resample_systematic(candidates.weights, noise.uniform(tick, 0), count);
  for (std::size_t i = 0; i < count; ++i) {
    const Pose2& pose = candidates.T_map_body[parents[i]];
    const auto jitter = [&](std::uint64_t axis, double half) { return half * (2.0 * noise.uniform(tick, 1 + 3 * i + axis) - 1.0); };
    poses.push_back({pose.x + jitter(0, candidates.half_step_m), pose.y + jitter(1, candidates.half_step_m),
                     wrap_angle(pose.yaw + jitter(2, candidates.half_step_rad))});
  }
  return poses;
}

}  // namespace patrol::localize
