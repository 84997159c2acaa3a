#include "slam/graph/branch_and_bound.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace patrol::slam {
namespace {

/// Cell of a level of the pyramid with consecutive points in it.
struct PointCell {
  int col = 0, row = 0;
  int num_points = 0;
};

/// Points rotated by an angle.
struct RotatedPoints {
  double yaw_rad = 0.0;
  /// Cells of the points at the first translation of the window, [level][cell]; empty until they are needed.
  std::vector<std::vector<PointCell>> levels = {};
};

int floor_to_int(double value) {
  const int truncated = static_cast<int>(value);
  return truncated - (value < truncated ? 1 : 0);
}

/// Writes the cells of a coarser level, by the cells of the finest; consecutive points in the same cell are counted
/// together.
void write_coarser(const std::vector<PointCell>& finest, int level, std::vector<PointCell>& coarse) {
  coarse.resize(finest.size() + 1);
  PointCell* last = coarse.data();
  *last = {.col = finest[0].col >> level, .row = finest[0].row >> level, .num_points = 0};
  for (const PointCell& fine : finest) {
    const int col = fine.col >> level, row = fine.row >> level;
    const bool is_same = last->col == col && last->row == row;
    const int before = is_same ? last->num_points : 0;
    last += is_same ? 0 : 1;
    *last = {.col = col, .row = row, .num_points = before + fine.num_points};
  }
  coarse.resize(static_cast<std::size_t>(last - coarse.data()) + 1);
}

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
        points_(points),
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
      rotated_.push_back({.yaw_rad = wrap_angle(window.T_map_center.yaw + rotation * step_rad)});
    }
  }

  std::optional<SearchResult> run() {
    std::vector<Candidate> candidates = coarsest_candidates();
    std::stable_sort(candidates.begin(), candidates.end(), is_higher);
    descend(candidates, map_.num_levels() - 1);
    if (!best_) return std::nullopt;
    return SearchResult{.T_map_points = pose_of(*best_),
                        .score = best_sum_ / (static_cast<double>(LikelihoodPyramid::kOnSurface) *
                                              static_cast<double>(points_.size()))};
  }

 private:
  void write_finest(double yaw_rad, std::vector<PointCell>& cells) const {
    const Eigen::Matrix2d R = Eigen::Rotation2Dd(yaw_rad).toRotationMatrix();
    cells.resize(points_.size());
    auto out = cells.begin();
    for (const Eigen::Vector2d& point : points_) {
      const Eigen::Vector2d cell = (R * point + corner_m_) / cell_m_;
      *out++ = {.col = floor_to_int(cell.x()), .row = floor_to_int(cell.y()), .num_points = 1};
    }
  }

  const std::vector<PointCell>& cells_of(int rotation, int level) {
    RotatedPoints& rotated = rotated_[static_cast<std::size_t>(rotation)];
    if (rotated.levels.empty()) {
      rotated.levels.resize(static_cast<std::size_t>(map_.num_levels()));
      write_finest(rotated.yaw_rad, rotated.levels[0]);
    }
    std::vector<PointCell>& cells = rotated.levels[static_cast<std::size_t>(level)];
    if (cells.empty()) write_coarser(rotated.levels[0], level, cells);
    return cells;
  }

  // Whether a candidate begins in the window and the bound of its sum exceeds the best sum.
  bool is_promising(const Candidate& candidate) const {
    return candidate.row < num_steps_ && candidate.col < num_steps_ && candidate.bound > best_sum_;
  }

  // The cells of most rotations are needed for one bound only and not stored.
  std::vector<Candidate> coarsest_candidates() const {
    const int top = map_.num_levels() - 1, num_squares = ((num_steps_ - 1) >> top) + 1;
    std::vector<Candidate> candidates;
    std::vector<PointCell> finest, cells;
    std::vector<int> bounds;
    for (int rotation = 0; rotation < static_cast<int>(rotated_.size()); ++rotation) {
      write_finest(rotated_[static_cast<std::size_t>(rotation)].yaw_rad, finest);
      write_coarser(finest, top, cells);
      sum_bounds(cells, map_.level(top), num_squares, bounds);
      for (int row = 0; row < num_squares; ++row) {
        for (int col = 0; col < num_squares; ++col) {
          const Candidate candidate{rotation, col << top, row << top,
                                    bounds[static_cast<std::size_t>(row * num_squares + col)]};
          if (is_promising(candidate)) candidates.push_back(candidate);
        }
      }
    }
    return candidates;
  }

  // Sums over the cells translated by up to `num_squares` cells of the level, [row][col].
  static void sum_bounds(const std::vector<PointCell>& cells, const LikelihoodPyramid::Level& values, int num_squares,
                         std::vector<int>& bounds) {
    bounds.assign(static_cast<std::size_t>(num_squares * num_squares), 0);
    for (const PointCell& cell : cells) {
      const int col = cell.col - values.first_col, row = cell.row - values.first_row;
      const bool is_inside =
          col >= 0 && row >= 0 && col + num_squares <= values.width && row + num_squares <= values.height;
      int* bound = bounds.data();
      for (int r = 0; r < num_squares; ++r) {
        const std::int8_t* value =
            is_inside ? &values.values[static_cast<std::size_t>((row + r) * values.width + col)] : nullptr;
        for (int c = 0; c < num_squares; ++c)
          *bound++ += cell.num_points * (is_inside ? value[c] : values.find(cell.col + c, cell.row + r));
      }
    }
  }

  // The four quarters of a candidate, whose bounds are sums over neighboring cells of the next finer level.
  std::array<Candidate, 4> children(const Candidate& parent, int level) {
    const LikelihoodPyramid::Level& values = map_.level(level);
    const int shift_col = (parent.col >> level) - values.first_col,
              shift_row = (parent.row >> level) - values.first_row;
    int bound_00 = 0, bound_01 = 0, bound_10 = 0, bound_11 = 0;  // [row][col]
    for (const PointCell& cell : cells_of(parent.rotation, level)) {
      const int col = cell.col + shift_col, row = cell.row + shift_row, n = cell.num_points;
      if (col >= 0 && row >= 0 && col + 1 < values.width && row + 1 < values.height) {
        const std::int8_t* lower = &values.values[static_cast<std::size_t>(row * values.width + col)];
        const std::int8_t* upper = lower + values.width;
        bound_00 += n * lower[0];
        bound_01 += n * lower[1];
        bound_10 += n * upper[0];
        bound_11 += n * upper[1];
      } else {
        const int level_col = col + values.first_col, level_row = row + values.first_row;
        bound_00 += n * values.find(level_col, level_row);
        bound_01 += n * values.find(level_col + 1, level_row);
        bound_10 += n * values.find(level_col, level_row + 1);
        bound_11 += n * values.find(level_col + 1, level_row + 1);
      }
    }
    const int half = 1 << level, right = parent.col + half, above = parent.row + half;
    return {Candidate{parent.rotation, parent.col, parent.row, bound_00},
            Candidate{parent.rotation, right, parent.row, bound_01},
            Candidate{parent.rotation, parent.col, above, bound_10},
            Candidate{parent.rotation, right, above, bound_11}};
  }

  // `candidates` in descending order of their bounds.
  void descend(std::span<const Candidate> candidates, int level) {
    for (const Candidate& candidate : candidates) {
      if (candidate.bound <= best_sum_) return;
      if (is_excluded(candidate, level)) continue;
      if (level == 0) {
        best_ = candidate;
        best_sum_ = candidate.bound;
        return;
      }
      std::array<Candidate, 4> quarters = children(candidate, level - 1);
      const auto end = std::ranges::remove_if(quarters, [&](const Candidate& c) { return !is_promising(c); }).begin();
      sort_few(quarters.begin(), end);
      descend({quarters.begin(), end}, level - 1);
    }
  }

  static bool is_higher(const Candidate& a, const Candidate& b) { return a.bound > b.bound; }

  // Stable insertion sort.
  static void sort_few(Candidate* begin, Candidate* end) {
    for (Candidate* next = begin; next != end; ++next)
      std::rotate(std::upper_bound(begin, next, *next, is_higher), next, next + 1);
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
  const std::vector<Eigen::Vector2d>& points_;
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
