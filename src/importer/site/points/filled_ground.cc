#include "importer/site/points/filled_ground.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace patrol::importer {
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
