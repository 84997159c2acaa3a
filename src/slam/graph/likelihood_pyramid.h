#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "core/grid.h"
#include "slam/grid_map.h"

namespace patrol::slam {

/// Multiresolution likelihood of points for searches over many poses. Values: 100 on a surface, decreasing around it; 0
/// in unobserved cells; negative in free cells, to penalize walls in free space. A cell of level l covers 2^l x 2^l
/// finest cells. It holds the maximum over itself and its right and upper neighbors. That is an upper bound for a point
/// and all its translations by less than a cell.
class LikelihoodPyramid {
 public:
  LikelihoodPyramid(const GridMap& map, double resolution_m, int num_levels);

  int num_levels() const { return static_cast<int>(levels_.size()); }
  double resolution_m() const { return resolution_m_; }
  double cell_m(int level) const { return resolution_m_ * (1 << level); }

  /// Value at a position in map, given in cells of the finest level from the origin of map.
  int value(int level, int col, int row) const {
    return levels_[static_cast<std::size_t>(level)].find(col >> level, row >> level);
  }

  static constexpr int kOnSurface = 100;
  static constexpr int kInFreeSpace = -40;

  /// Grid of the values of one level.
  struct Level {
    int first_col = 0, first_row = 0, width = 0, height = 0;
    std::vector<std::int8_t> values;  ///< [row][col]

    void clear() { values.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0); }
    std::int8_t& at(int col, int row) {
      return values[static_cast<std::size_t>((row - first_row) * width + col - first_col)];
    }
    /// Returns 0 outside the level.
    int find(int col, int row) const {
      const auto c = static_cast<unsigned>(col - first_col), r = static_cast<unsigned>(row - first_row);
      return c < static_cast<unsigned>(width) && r < static_cast<unsigned>(height)
                 ? values[r * static_cast<unsigned>(width) + c]
                 : 0;
    }
  };

  const Level& level(int number) const { return levels_[static_cast<std::size_t>(number)]; }

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(resolution_m_, levels_);
  }

 private:
  Cell cell_of(const Eigen::Vector2d& p_map) const;
  Level empty_level(const GridMap& map) const;
  Level rasterize_finest(const GridMap& map) const;
  static Level halved(const Level& fine, bool is_from_finest);

  double resolution_m_;
  std::vector<Level> levels_;
};

}  // namespace patrol::slam
