#include "importer/site/points/scanned_ground.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "core/error.h"
#include "importer/grid/cell_regions.h"
#include "importer/grid/height_grid.h"
#include "importer/grid/triangle_cells.h"

namespace patrol::importer {
namespace {

/// Height of a level surface in a cell.
struct Level {
  std::uint32_t cell;
  float height_m;
  friend bool operator<(const Level& a, const Level& b) {
    return a.cell != b.cell ? a.cell < b.cell : a.height_m < b.height_m;
  }
};

class GroundFinder {
 public:
  GroundFinder(const GridGeometry& grid, const ScannedGroundSettings& settings)
      : grid_(grid), settings_(settings), height_m_(grid, 0.0f), is_known_(grid, 0) {}

  void add(const std::vector<Patch>& patches, bool is_oriented) {
    for (const Patch& patch : patches) {
      const Eigen::Vector3d normal = patch.area_normal();
      const double up = is_oriented ? normal.z() : std::abs(normal.z());
      if (up < settings_.min_cosine * normal.norm()) continue;
      for (std::size_t k = 1; k + 1 < patch.num_corners; ++k) {
        visit_cell_centers({patch.corners_m[0].cast<double>(), patch.corners_m[k].cast<double>(),
                            patch.corners_m[k + 1].cast<double>()},
                           grid_, [&](Cell cell, double height_m) {
                             levels_.push_back({index(cell), static_cast<float>(height_m)});
                           });
      }
    }
    std::sort(levels_.begin(), levels_.end());
    begin_.assign(grid_.size() + 1, 0);
    for (const Level& level : levels_) ++begin_[level.cell + 1];
    for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
  }

  void seed_below(const Eigen::Vector3d& scanner_m) {
    constexpr double kRadius_m = 3.5, kLowest_m = 5.0, kHighest_m = 0.15;
    std::vector<Level> lowest;
    const int reach = static_cast<int>(kRadius_m / grid_.resolution_m);
    const Cell at = grid_.cell_at(scanner_m.head<2>());
    for (int row = at.row - reach; row <= at.row + reach; ++row) {
      for (int col = at.col - reach; col <= at.col + reach; ++col) {
        if (!grid_.contains({col, row}) || (grid_.center_of({col, row}) - scanner_m.head<2>()).norm() > kRadius_m)
          continue;
        for (std::uint32_t i = begin_[index({col, row})]; i < begin_[index({col, row}) + 1]; ++i) {
          const double below_m = scanner_m.z() - double{levels_[i].height_m};
          if (below_m > kLowest_m || below_m < kHighest_m) continue;
          lowest.push_back(levels_[i]);
          break;
        }
      }
    }
    if (lowest.empty()) return;
    std::vector<float> heights;
    for (const Level& level : lowest) heights.push_back(level.height_m);
    std::nth_element(heights.begin(), heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 2), heights.end());
    const float middle = heights[heights.size() / 2];
    for (const Level& level : lowest) {
      if (std::abs(level.height_m - middle) < 0.2f) accept(level.cell, level.height_m);
    }
  }

  /// Begins with the lowest level that has a quarter of the cells of the largest one.
  void seed_lowest() {
    constexpr double kBin_m = 0.2;
    std::map<int, std::size_t> cells;
    for (const Level& level : levels_) ++cells[static_cast<int>(std::floor(double{level.height_m} / kBin_m))];
    std::size_t max_count = 0;
    for (const auto& [bin, count] : cells) max_count = std::max(max_count, count);
    for (const auto& [bin, count] : cells) {
      if (4 * count < max_count) continue;
      for (const Level& level : levels_) {
        if (static_cast<int>(std::floor(double{level.height_m} / kBin_m)) == bin) accept(level.cell, level.height_m);
      }
      return;
    }
  }

  bool has_seeds() const { return !open_.empty(); }

  /// Follows the surface over small steps, then across gaps, until nothing is added.
  void grow() {
    constexpr int kMaxRounds = 40;
    follow_surface();
    for (int round = 0; round < kMaxRounds; ++round) {
      Grid<float> filled = height_m_;
      fill_smoothly(filled, is_known_);
      const Grid<char> near = dilated(is_known_, max_gap_cells());
      for (int row = 0; row < grid_.height; ++row) {
        for (int col = 0; col < grid_.width; ++col) {
          if (is_known_.at({col, row}) != 0 || near.at({col, row}) == 0) continue;
          const auto height = nearest_level(index({col, row}), filled.at({col, row}));
          if (height) accept(index({col, row}), *height);
        }
      }
      if (open_.empty()) return;
      follow_surface();
    }
  }

  ScannedGround take() {
    ScannedGround ground{.height_m = height_m_, .origin = Grid<GroundOrigin>(grid_, GroundOrigin::kExtrapolated)};
    fill_smoothly(ground.height_m, is_known_);
    const Grid<char> near = dilated(is_known_, max_gap_cells()), outside = outer_cells(is_known_);
    for (int row = 0; row < grid_.height; ++row) {
      for (int col = 0; col < grid_.width; ++col) {
        const Cell cell{col, row};
        if (is_known_.at(cell) != 0) {
          ground.origin.at(cell) = GroundOrigin::kMeasured;
        } else if (near.at(cell) != 0 || outside.at(cell) == 0) {
          ground.origin.at(cell) = GroundOrigin::kInterpolated;
        }
      }
    }
    return ground;
  }

 private:
  int max_gap_cells() const { return static_cast<int>(settings_.max_gap_m / grid_.resolution_m); }
  std::uint32_t index(Cell cell) const {
    return static_cast<std::uint32_t>(cell.row) * static_cast<std::uint32_t>(grid_.width) +
           static_cast<std::uint32_t>(cell.col);
  }
  Cell cell_of(std::uint32_t at) const {
    return {static_cast<int>(at % static_cast<std::uint32_t>(grid_.width)),
            static_cast<int>(at / static_cast<std::uint32_t>(grid_.width))};
  }

  /// Takes a level of a cell as ground: the mean of the levels close to it.
  void accept(std::uint32_t cell, float height_m) {
    constexpr float kSame_m = 0.03f;
    if (is_known_.values()[cell] != 0) return;
    float sum = 0.0f;
    int count = 0;
    for (std::uint32_t i = begin_[cell]; i < begin_[cell + 1]; ++i) {
      if (std::abs(levels_[i].height_m - height_m) > kSame_m) continue;
      sum += levels_[i].height_m;
      ++count;
    }
    height_m_.values()[cell] = count > 0 ? sum / static_cast<float>(count) : height_m;
    is_known_.values()[cell] = 1;
    open_.push_back(cell);
  }

  std::optional<float> nearest_level(std::uint32_t cell, float height_m) const {
    std::optional<float> best;
    auto best_m = static_cast<float>(settings_.max_step_m);
    for (std::uint32_t i = begin_[cell]; i < begin_[cell + 1]; ++i) {
      const float off_m = std::abs(levels_[i].height_m - height_m);
      if (off_m > best_m) continue;
      best_m = off_m;
      best = levels_[i].height_m;
    }
    return best;
  }

  void follow_surface() {
    for (std::size_t i = 0; i < open_.size(); ++i) {
      const Cell cell = cell_of(open_[i]);
      const float height_m = height_m_.at(cell);
      for (const Cell next : {Cell{cell.col + 1, cell.row}, Cell{cell.col - 1, cell.row}, Cell{cell.col, cell.row + 1},
                              Cell{cell.col, cell.row - 1}}) {
        if (!grid_.contains(next) || is_known_.at(next) != 0) continue;
        const auto level = nearest_level(index(next), height_m);
        if (level) accept(index(next), *level);
      }
    }
    open_.clear();
  }

  GridGeometry grid_;
  const ScannedGroundSettings& settings_;
  std::vector<Level> levels_;
  std::vector<std::uint32_t> begin_;  ///< [cell], first of its levels
  Grid<float> height_m_;
  Grid<char> is_known_;
  std::vector<std::uint32_t> open_;
};

/// Returns the grid around the scanners, or around all patches if there are none, within the patches that face upward.
GridGeometry ground_grid(const std::vector<Patch>& patches, bool is_oriented, const ScannedGroundSettings& settings) {
  Eigen::AlignedBox2d box;
  for (const Patch& patch : patches) {
    const Eigen::Vector3d normal = patch.area_normal();
    if ((is_oriented ? normal.z() : std::abs(normal.z())) < settings.min_cosine * normal.norm()) continue;
    for (std::size_t i = 0; i < patch.num_corners; ++i) box.extend(patch.corners_m[i].head<2>().cast<double>());
  }
  if (box.isEmpty()) return {};
  GridGeometry grid{.resolution_m = settings.resolution_m, .width = 0, .height = 0, .origin_m = box.min()};
  const double cells = box.sizes().x() * box.sizes().y() / (grid.resolution_m * grid.resolution_m);
  if (cells > static_cast<double>(settings.max_cells))
    grid.resolution_m *= std::sqrt(cells / static_cast<double>(settings.max_cells));
  grid.origin_m -= Eigen::Vector2d::Constant(grid.resolution_m);
  grid.width = static_cast<int>(std::ceil(box.sizes().x() / grid.resolution_m)) + 3;
  grid.height = static_cast<int>(std::ceil(box.sizes().y() / grid.resolution_m)) + 3;
  return grid;
}

}  // namespace

double ScannedGround::height_at(const Eigen::Vector2d& p_m) const {
  const GridGeometry& grid = height_m.geometry();
  Cell cell = grid.cell_at(p_m);
  cell.col = std::clamp(cell.col, 0, grid.width - 1);
  cell.row = std::clamp(cell.row, 0, grid.height - 1);
  return double{height_m.at(cell)};
}

double ScannedGround::area_m2(GroundOrigin wanted) const {
  const double resolution_m = origin.geometry().resolution_m;
  return static_cast<double>(std::count(origin.values().begin(), origin.values().end(), wanted)) * resolution_m *
         resolution_m;
}

ScannedGround find_scanned_ground(const std::vector<Patch>& patches, const std::vector<Eigen::Vector3d>& scanners_m,
                                  bool is_oriented, const ScannedGroundSettings& settings, const std::string& source) {
  const GridGeometry grid = ground_grid(patches, is_oriented, settings);
  if (grid.size() == 0) throw InputError(source + ": has no surface that faces upward, which the ground must");
  GroundFinder finder(grid, settings);
  finder.add(patches, is_oriented);
  for (const Eigen::Vector3d& scanner : scanners_m) finder.seed_below(scanner);
  if (!finder.has_seeds()) finder.seed_lowest();
  if (!finder.has_seeds()) throw InputError(source + ": has no level surface, which the ground must be");
  finder.grow();
  return finder.take();
}

}  // namespace patrol::importer
