#include "slam/graph/branch_and_bound.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace patrol::slam {
namespace {

/// Rotated points in cells of the finest level.
struct RotatedPoints {
  double yaw_rad = 0.0;
  std::vector<Cell> cells;
};

/// Square of 2^level x 2^level translations, in cells from the lower left corner of the window.
struct Candidate {
  int rotation = 0;
  int col = 0, row = 0;
  int bound = 0;  ///< upper bound of the sum of point values
};

class Search {
 public:
  Search(const LikelihoodPyramid& map, const std::vector<Eigen::Vector2d>& points, const SearchWindow& window,
         int best_sum, std::span<const SearchExclusion> exclusions)
      : map_(map),
        exclusions_(exclusions),
        best_sum_(best_sum),
        cell_m_(map.resolution_m()),
        num_steps_(2 * static_cast<int>(std::ceil(window.half_width_m / cell_m_)) + 1) {
    double far_m = cell_m_;
    for (const Eigen::Vector2d& point : points) far_m = std::max(far_m, point.norm());
    const double step_rad = cell_m_ / far_m;
    const int num_rotations = static_cast<int>(std::ceil(window.half_angle_rad / step_rad));
    corner_m_ = window.T_map_center.position() - Eigen::Vector2d::Constant(0.5 * (num_steps_ - 1) * cell_m_);
    for (int rotation = -num_rotations; rotation <= num_rotations; ++rotation) {
      RotatedPoints rotated{.yaw_rad = wrap_angle(window.T_map_center.yaw + rotation * step_rad), .cells = {}};
      const Eigen::Matrix2d R = Eigen::Rotation2Dd(rotated.yaw_rad).toRotationMatrix();
      for (const Eigen::Vector2d& point : points) {
        const Eigen::Vector2d cell = (R * point + corner_m_) / cell_m_;
        rotated.cells.push_back({static_cast<int>(std::floor(cell.x())), static_cast<int>(std::floor(cell.y()))});
      }
      rotated_.push_back(std::move(rotated));
    }
  }

  std::optional<SearchResult> run() {
    const int top = map_.num_levels() - 1, step = 1 << top;
    std::vector<Candidate> candidates;
    for (int rotation = 0; rotation < static_cast<int>(rotated_.size()); ++rotation) {
      for (int row = 0; row < num_steps_; row += step) {
        for (int col = 0; col < num_steps_; col += step) add(rotation, col, row, top, candidates);
      }
    }
    descend(candidates, top);
    if (!best_) return std::nullopt;
    return SearchResult{.T_map_points = pose_of(*best_),
                        .score = best_sum_ / (static_cast<double>(LikelihoodPyramid::kOnSurface) *
                                              static_cast<double>(rotated_[0].cells.size()))};
  }

 private:
  void add(int rotation, int col, int row, int level, std::vector<Candidate>& candidates) const {
    int sum = 0;
    for (const Cell& cell : rotated_[static_cast<std::size_t>(rotation)].cells)
      sum += map_.value(level, cell.col + col, cell.row + row);
    if (sum > best_sum_) candidates.push_back({rotation, col, row, sum});
  }

  void descend(std::vector<Candidate>& candidates, int level) {
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const Candidate& a, const Candidate& b) { return a.bound > b.bound; });
    for (const Candidate& candidate : candidates) {
      if (candidate.bound <= best_sum_) return;
      if (is_excluded(candidate, level)) continue;
      if (level == 0) {
        best_ = candidate;
        best_sum_ = candidate.bound;
        return;
      }
      const int half = 1 << (level - 1);
      std::vector<Candidate> children;
      for (const int row : {candidate.row, candidate.row + half}) {
        for (const int col : {candidate.col, candidate.col + half}) {
          if (row < num_steps_ && col < num_steps_) add(candidate.rotation, col, row, level - 1, children);
        }
      }
      descend(children, level - 1);
    }
  }

  Pose2 pose_of(const Candidate& candidate) const {
    return {corner_m_.x() + candidate.col * cell_m_, corner_m_.y() + candidate.row * cell_m_,
            rotated_[static_cast<std::size_t>(candidate.rotation)].yaw_rad};
  }

  /// Returns whether one exclusion covers all translations of the candidate.
  bool is_excluded(const Candidate& candidate, int level) const {
    if (exclusions_.empty()) return false;
    const Pose2 pose = pose_of(candidate);
    const double half_m = 0.5 * ((1 << level) - 1) * cell_m_;
    const Eigen::Vector2d center = pose.position() + Eigen::Vector2d::Constant(half_m);
    return std::ranges::any_of(exclusions_, [&](const SearchExclusion& exclusion) {
      const Eigen::Vector2d offset = center - exclusion.T_map_center.position();
      return (offset.cwiseAbs() + Eigen::Vector2d::Constant(half_m)).norm() <= exclusion.radius_m &&
             std::abs(wrap_angle(pose.yaw - exclusion.T_map_center.yaw)) <= exclusion.angle_rad;
    });
  }

  const LikelihoodPyramid& map_;
  std::span<const SearchExclusion> exclusions_;
  int best_sum_;
  double cell_m_;
  int num_steps_;
  Eigen::Vector2d corner_m_;
  std::vector<RotatedPoints> rotated_;
  std::optional<Candidate> best_;
};

}  // namespace

std::optional<SearchResult> search_window(const LikelihoodPyramid& map, const std::vector<Eigen::Vector2d>& points,
                                          const SearchWindow& window, double min_score,
                                          std::span<const SearchExclusion> exclusions) {
  if (points.empty()) return std::nullopt;
  const int min_sum =
      static_cast<int>(std::floor(min_score * LikelihoodPyramid::kOnSurface * static_cast<double>(points.size())));
  return Search(map, points, window, min_sum, exclusions).run();
}

}  // namespace patrol::slam
