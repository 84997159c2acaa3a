#include "importer/site/points/scanned_ground.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "core/error.h"

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

/// Calls `visit` with each cell whose center is within the patch seen from above, and with the height there.
template <typename Visit>
void visit_cells(const Patch& patch, const GridGeometry& grid, Visit visit) {
  Eigen::AlignedBox2d box;
  for (std::size_t i = 0; i < patch.num_corners; ++i) box.extend(patch.corners_m[i].head<2>().cast<double>());
  const Cell low = grid.cell_at(box.min()), high = grid.cell_at(box.max());
  const Eigen::Vector3d a = patch.corners_m[0].cast<double>();
  for (std::size_t k = 1; k + 1 < patch.num_corners; ++k) {
    const Eigen::Vector3d ab = patch.corners_m[k].cast<double>() - a, ac = patch.corners_m[k + 1].cast<double>() - a;
    const double area = ab.x() * ac.y() - ab.y() * ac.x();
    if (std::abs(area) < 1e-9) continue;
    for (int row = std::max(0, low.row); row <= std::min(grid.height - 1, high.row); ++row) {
      for (int col = std::max(0, low.col); col <= std::min(grid.width - 1, high.col); ++col) {
        const Eigen::Vector2d p = grid.center_of({col, row}) - a.head<2>();
        const double u = (p.x() * ac.y() - p.y() * ac.x()) / area, v = (ab.x() * p.y() - ab.y() * p.x()) / area;
        if (u < 0.0 || v < 0.0 || u + v > 1.0) continue;
        visit(Cell{col, row}, a.z() + u * ab.z() + v * ac.z());
      }
    }
  }
}

class GroundFinder {
 public:
  GroundFinder(const GridGeometry& grid, const ScannedGroundSettings& settings)
      : grid_(grid), settings_(settings), height_m_(grid, 0.0f), is_known_(grid, 0) {}

  void add(const std::vector<Patch>& patches, bool is_oriented) {
    for (const Patch& patch : patches) {
      const Eigen::Vector3d normal = patch.area_normal();
      const double up = is_oriented ? normal.z() : std::abs(normal.z());
      if (up < settings_.min_cosine * normal.norm()) continue;
      visit_cells(patch, grid_, [&](Cell cell, double height_m) {
        levels_.push_back({index(cell), static_cast<float>(height_m)});
      });
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
      const Grid<char> near = near_known();
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
    const Grid<char> near = near_known(), outside = outside_region();
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

  /// Marks cells within the largest gap of a known one, by a square dilation along rows, then columns.
  Grid<char> near_known() const {
    const int reach = static_cast<int>(settings_.max_gap_m / grid_.resolution_m);
    Grid<char> along_rows(grid_, 0), near(grid_, 0);
    for (int row = 0; row < grid_.height; ++row) {
      for (int col = 0, last = -reach - 1; col < grid_.width; ++col) {
        if (is_known_.at({col, row}) != 0) last = col;
        if (col - last <= reach) along_rows.at({col, row}) = 1;
      }
      for (int col = grid_.width - 1, last = grid_.width + reach; col >= 0; --col) {
        if (is_known_.at({col, row}) != 0) last = col;
        if (last - col <= reach) along_rows.at({col, row}) = 1;
      }
    }
    for (int col = 0; col < grid_.width; ++col) {
      for (int row = 0, last = -reach - 1; row < grid_.height; ++row) {
        if (along_rows.at({col, row}) != 0) last = row;
        if (row - last <= reach) near.at({col, row}) = 1;
      }
      for (int row = grid_.height - 1, last = grid_.height + reach; row >= 0; --row) {
        if (along_rows.at({col, row}) != 0) last = row;
        if (last - row <= reach) near.at({col, row}) = 1;
      }
    }
    return near;
  }

  /// Marks unknown cells that are connected to the edge of the grid.
  Grid<char> outside_region() const {
    Grid<char> outside(grid_, 0);
    std::vector<Cell> open;
    const auto visit = [&](Cell cell) {
      if (!grid_.contains(cell) || is_known_.at(cell) != 0 || outside.at(cell) != 0) return;
      outside.at(cell) = 1;
      open.push_back(cell);
    };
    for (int col = 0; col < grid_.width; ++col) {
      visit({col, 0});
      visit({col, grid_.height - 1});
    }
    for (int row = 0; row < grid_.height; ++row) {
      visit({0, row});
      visit({grid_.width - 1, row});
    }
    while (!open.empty()) {
      const Cell at = open.back();
      open.pop_back();
      visit({at.col + 1, at.row});
      visit({at.col - 1, at.row});
      visit({at.col, at.row + 1});
      visit({at.col, at.row - 1});
    }
    return outside;
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

void fill_smoothly(Grid<float>& values, const Grid<char>& is_known) {
  const GridGeometry& grid = values.geometry();
  if (grid.width <= 1 && grid.height <= 1) return;
  // Means of 2 x 2 cells, recursively, are the values of the unknown cells before smoothing.
  GridGeometry half = grid;
  half.resolution_m *= 2.0;
  half.width = (grid.width + 1) / 2;
  half.height = (grid.height + 1) / 2;
  Grid<float> coarse(half, 0.0f);
  Grid<char> is_coarse_known(half, 0);
  bool has_unknown = false;
  for (int row = 0; row < half.height; ++row) {
    for (int col = 0; col < half.width; ++col) {
      float sum = 0.0f;
      int count = 0;
      for (const Cell cell : {Cell{2 * col, 2 * row}, Cell{2 * col + 1, 2 * row}, Cell{2 * col, 2 * row + 1},
                              Cell{2 * col + 1, 2 * row + 1}}) {
        if (!grid.contains(cell)) continue;
        if (is_known.at(cell) == 0) {
          has_unknown = true;
          continue;
        }
        sum += values.at(cell);
        ++count;
      }
      if (count == 0) continue;
      coarse.at({col, row}) = sum / static_cast<float>(count);
      is_coarse_known.at({col, row}) = 1;
    }
  }
  if (!has_unknown) return;
  fill_smoothly(coarse, is_coarse_known);
  std::vector<Cell> unknown;
  for (int row = 0; row < grid.height; ++row) {
    for (int col = 0; col < grid.width; ++col) {
      if (is_known.at({col, row}) != 0) continue;
      values.at({col, row}) = coarse.at({col / 2, row / 2});
      unknown.push_back({col, row});
    }
  }
  constexpr int kSweeps = 12;
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (const Cell& cell : unknown) {
      float sum = 0.0f;
      int count = 0;
      for (const Cell next : {Cell{cell.col + 1, cell.row}, Cell{cell.col - 1, cell.row}, Cell{cell.col, cell.row + 1},
                              Cell{cell.col, cell.row - 1}}) {
        if (!grid.contains(next)) continue;
        sum += values.at(next);
        ++count;
      }
      values.at(cell) = sum / static_cast<float>(count);
    }
  }
}

namespace {

/// Squares of interpolated cells that are flat within a tolerance.
class FilledGround {
 public:
  FilledGround(const ScannedGround& ground, float reflectivity) : ground_(ground), reflectivity_(reflectivity) {}

  std::vector<Patch> make() {
    const GridGeometry& grid = ground_.height_m.geometry();
    for (int row = 0; row < grid.height; row += kLargest) {
      for (int col = 0; col < grid.width; col += kLargest) divide({col, row}, kLargest);
    }
    return std::move(patches_);
  }

 private:
  static constexpr int kLargest = 32;

  /// Height at the corner of cells (col, row): mean of the cells around it.
  double corner_height_m(int col, int row) const {
    double sum = 0.0;
    int count = 0;
    for (const Cell cell : {Cell{col, row}, Cell{col - 1, row}, Cell{col, row - 1}, Cell{col - 1, row - 1}}) {
      if (!ground_.height_m.contains(cell)) continue;
      sum += double{ground_.height_m.at(cell)};
      ++count;
    }
    return sum / std::max(1, count);
  }

  void divide(Cell begin, int side) {
    const GridGeometry& grid = ground_.height_m.geometry();
    bool is_any = false, is_whole = begin.col + side <= grid.width && begin.row + side <= grid.height;
    for (int row = begin.row; row < std::min(begin.row + side, grid.height); ++row) {
      for (int col = begin.col; col < std::min(begin.col + side, grid.width); ++col) {
        const bool is_filled = ground_.origin.at({col, row}) == GroundOrigin::kInterpolated;
        is_any = is_any || is_filled;
        is_whole = is_whole && is_filled;
      }
    }
    if (!is_any) return;
    if (is_whole && (side == 1 || is_flat(begin, side))) {
      add(begin, side);
      return;
    }
    const int half = side / 2;
    for (const int dc : {0, half}) {
      for (const int dr : {0, half}) divide({begin.col + dc, begin.row + dr}, half);
    }
  }

  bool is_flat(Cell begin, int side) const {
    constexpr double kFlat_m = 0.004;
    const double a = corner_height_m(begin.col, begin.row), b = corner_height_m(begin.col + side, begin.row),
                 c = corner_height_m(begin.col, begin.row + side),
                 d = corner_height_m(begin.col + side, begin.row + side);
    if (std::abs(a + d - b - c) > kFlat_m) return false;
    for (int row = 0; row <= side; ++row) {
      for (int col = 0; col <= side; ++col) {
        const double u = static_cast<double>(col) / side, v = static_cast<double>(row) / side;
        const double flat = (1 - u) * (1 - v) * a + u * (1 - v) * b + (1 - u) * v * c + u * v * d;
        if (std::abs(corner_height_m(begin.col + col, begin.row + row) - flat) > kFlat_m) return false;
      }
    }
    return true;
  }

  void add(Cell begin, int side) {
    const GridGeometry& grid = ground_.height_m.geometry();
    Patch patch{.corners_m = {}, .num_corners = 4, .reflectivity = reflectivity_, .is_filled_in = true};
    const int corners[4][2] = {{0, 0}, {side, 0}, {side, side}, {0, side}};
    for (std::size_t i = 0; i < 4; ++i) {
      const int col = begin.col + corners[i][0], row = begin.row + corners[i][1];
      const Eigen::Vector2d p = grid.origin_m + grid.resolution_m * Eigen::Vector2d(col, row);
      patch.corners_m[i] = Eigen::Vector3d(p.x(), p.y(), corner_height_m(col, row)).cast<float>();
    }
    patches_.push_back(patch);
  }

  const ScannedGround& ground_;
  float reflectivity_;
  std::vector<Patch> patches_;
};

}  // namespace

std::vector<Patch> filled_ground(const ScannedGround& ground, float reflectivity) {
  return FilledGround(ground, reflectivity).make();
}

}  // namespace patrol::importer
