#include "localize/amcl/global_search.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "core/map_cells.h"
#include "core/particle_weights.h"
#include "localize/amcl/distance_to_occupied.h"

namespace patrol::localize {
namespace {

// difference in log likelihood to the best position beyond which positions are skipped
constexpr double kNegligible = 12.0;
constexpr int kFineSteps = 4;     // fine steps per coarse step along x and y
constexpr int kFineHeadings = 5;  // fine steps per coarse step in heading

/// Center of part `i` of `parts` equal parts of a step centered on 0.
double part_of_step(int i, int parts, double step) { return ((i + 0.5) / parts - 0.5) * step; }

RangeLikelihoodSettings widen(RangeLikelihoodSettings settings, double step_m) {
  settings.range_std_m = std::hypot(settings.range_std_m, 0.5 * step_m);
  return settings;
}

}  // namespace

GlobalSearch::GlobalSearch(const GlobalSearchSettings& settings, const LikelihoodFieldSettings& field,
                           const OccupancyGrid& map, const LineField& lines)
    : settings_(settings),
      coarse_({.hit_std_m = std::hypot(field.hit_std_m, settings.step_m),
               .z_rand = field.z_rand,
               .max_beams = settings.max_beams},
              map, lines),
      fine_(field, map, lines) {
  const GridGeometry& geometry = map.geometry();
  const Grid<float> clearance_m = distance_to_occupied(map, settings.min_clearance_m + geometry.resolution_m);
  const int stride = std::max(1, static_cast<int>(std::lround(settings.step_m / geometry.resolution_m)));
  for (int row = stride / 2; row < geometry.height; row += stride) {
    for (int col = stride / 2; col < geometry.width; col += stride) {
      const bool has_room = static_cast<double>(clearance_m.at({col, row})) > settings.min_clearance_m;
      if (has_room && is_free(map.at({col, row}))) free_positions_.push_back(geometry.center_of({col, row}));
    }
  }
  if (!free_positions_.empty()) return;
  for (int row = 0; row < geometry.height; ++row) {  // the map is too small for the grid
    for (int col = 0; col < geometry.width; ++col) {
      if (is_free(map.at({col, row}))) free_positions_.push_back(geometry.center_of({col, row}));
    }
  }
}

// Ignores the lever arm of the antenna, which is shorter than the coarse step.
std::vector<GlobalSearch::CandidatePosition> GlobalSearch::filter_positions_by_range(
    const std::vector<AnchoredRange>& ranges, const RangeLikelihoodSettings& settings) const {
  std::vector<CandidatePosition> positions;
  double best = -std::numeric_limits<double>::infinity();
  for (const Eigen::Vector2d& p_map : free_positions_) {
    positions.push_back({p_map, ranges_log_likelihood(ranges, {p_map.x(), p_map.y(), 0.0}, settings)});
    best = std::max(best, positions.back().log_ranges);
  }
  std::erase_if(positions, [&](const CandidatePosition& position) { return position.log_ranges < best - kNegligible; });
  return positions;
}

GlobalSearch::Candidates GlobalSearch::find(const LevelScan& scan, const std::vector<AnchoredRange>& ranges,
                                            const RangeLikelihoodSettings& range_settings, double effective_beams,
                                            double uniform) const {
  const BeamEnds ends = select_beam_ends(scan, settings_.max_beams);
  const double scan_gain = std::min(effective_beams, static_cast<double>(ends.size()));
  const std::vector<CandidatePosition> positions =
      filter_positions_by_range(ranges, widen(range_settings, settings_.step_m));
  if (positions.empty()) return {};
  const int num_headings = static_cast<int>(std::ceil(2.0 * std::numbers::pi / settings_.step_rad));
  const double step_rad = 2.0 * std::numbers::pi / num_headings;
  const auto coarse_pose = [&](std::size_t i) {
    const CandidatePosition& position = positions[i / static_cast<std::size_t>(num_headings)];
    return Pose2{position.p_map.x(), position.p_map.y(),
                 wrap_angle(static_cast<double>(i % static_cast<std::size_t>(num_headings)) * step_rad)};
  };

  std::vector<double> log_coarse(positions.size() * static_cast<std::size_t>(num_headings));
  for (std::size_t i = 0; i < log_coarse.size(); ++i) {
    log_coarse[i] = positions[i / static_cast<std::size_t>(num_headings)].log_ranges +
                    scan_gain * coarse_.mean_log(ends, coarse_pose(i));
  }
  const std::vector<double> coarse = normalized_weights(log_coarse);
  const auto samples = static_cast<std::size_t>(settings_.coarse_samples);
  std::vector<std::size_t> chosen = systematic_parents(coarse, uniform, samples);

  Candidates candidates;
  candidates.half_step_m = 0.5 * settings_.step_m / kFineSteps;
  candidates.half_step_rad = 0.5 * step_rad / kFineHeadings;
  std::vector<double> log_fine;
  for (std::size_t first = 0; first < chosen.size();) {
    const std::size_t cell = chosen[first];
    std::size_t end = first;
    while (end < chosen.size() && chosen[end] == cell) ++end;
    // Importance weight of the sampled cell: number of samples relative to the expected number.
    const double log_importance_weight =
        std::log(static_cast<double>(end - first) / (static_cast<double>(samples) * coarse[cell]));
    const Pose2 center = coarse_pose(cell);
    for (int part = 0; part < kFineSteps * kFineSteps * kFineHeadings; ++part) {
      const Pose2 pose{
          center.x + part_of_step(part % kFineSteps, kFineSteps, settings_.step_m),
          center.y + part_of_step(part / kFineSteps % kFineSteps, kFineSteps, settings_.step_m),
          wrap_angle(center.yaw + part_of_step(part / (kFineSteps * kFineSteps), kFineHeadings, step_rad))};
      candidates.T_map_body.push_back(pose);
      log_fine.push_back(log_importance_weight + scan_gain * fine_.mean_log(ends, pose) +
                         ranges_log_likelihood(ranges, pose, range_settings));
    }
    first = end;
  }
  candidates.weights = normalized_weights(log_fine);
  return candidates;
}

std::vector<Pose2> sample_poses(const GlobalSearch::Candidates& candidates, std::size_t count,
                                const RandomStream& noise, std::uint64_t tick) {
  if (candidates.weights.empty() || count == 0) return {};
  std::vector<Pose2> poses;
  const std::vector<std::size_t> parents = systematic_parents(candidates.weights, noise.uniform(tick, 0), count);
  for (std::size_t i = 0; i < count; ++i) {
    const Pose2& pose = candidates.T_map_body[parents[i]];
    const auto jitter = [&](std::uint64_t axis, double half) {
      return half * (2.0 * noise.uniform(tick, 1 + 3 * i + axis) - 1.0);
    };
    poses.push_back({pose.x + jitter(0, candidates.half_step_m), pose.y + jitter(1, candidates.half_step_m),
                     wrap_angle(pose.yaw + jitter(2, candidates.half_step_rad))});
  }
  return poses;
}

}  // namespace patrol::localize
