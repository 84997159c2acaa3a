#include "slam/graph/likelihood_pyramid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

namespace patrol::slam {
namespace {

constexpr int kMargin_cells = 2;  ///< radius in cells around a surface with nonzero likelihood

/// Values around a surface, [row][col].
using Kernel = std::array<std::array<std::int8_t, 2 * kMargin_cells + 1>, 2 * kMargin_cells + 1>;

Kernel surface_kernel() {
  Kernel kernel{};
  for (int row = -kMargin_cells; row <= kMargin_cells; ++row) {
    for (int col = -kMargin_cells; col <= kMargin_cells; ++col) {
      const double likelihood = std::exp(-0.5 * (col * col + row * row));
      kernel[static_cast<std::size_t>(row + kMargin_cells)][static_cast<std::size_t>(col + kMargin_cells)] =
          static_cast<std::int8_t>(std::lround(LikelihoodPyramid::kOnSurface * likelihood));
    }
  }
  return kernel;
}

/// Marks the free cells of a tile. `centers`: columns and rows of the tile's cells in the level.
void mark_free(const GridTile& tile, const std::array<Cell, GridTile::kSize>& centers,
               LikelihoodPyramid::Level& finest) {
  for (std::size_t row = 0; row < GridTile::kSize;) {
    const int finest_row = centers[row].row;
    std::array<std::uint16_t, GridTile::kSize> passes{};  // nonzero: free in one of the rows in finest_row
    for (; row < GridTile::kSize && centers[row].row == finest_row; ++row) {
      const std::uint16_t* passes_of_row = &tile.passes[GridTile::kSize * row];
      const std::uint32_t surfaces = tile.surface_bits[row];
      if (surfaces == 0) {
        for (std::size_t col = 0; col < GridTile::kSize; ++col) passes[col] |= passes_of_row[col];
      } else {
        for (std::size_t col = 0; col < GridTile::kSize; ++col)
          passes[col] |= (surfaces >> col & 1U) != 0 ? std::uint16_t{0} : passes_of_row[col];
      }
    }
    std::int8_t* const values = &finest.at(centers[0].col, finest_row);
    for (std::size_t col = 0; col < GridTile::kSize; ++col) {
      if (passes[col] != 0) values[centers[col].col - centers[0].col] = LikelihoodPyramid::kInFreeSpace;
    }
  }
}

/// Rows of a level with zeros around it.
class PaddedRows {
 public:
  /// Columns from `first_col` on, `num_cols` or slightly more.
  PaddedRows(const LikelihoodPyramid::Level& level, int first_col, int num_cols)
      : first_row_(level.first_row),
        height_(level.height),
        width_((static_cast<std::size_t>(num_cols) + kBlock - 1) / kBlock * kBlock),
        zeros_(width_),
        values_(width_ * static_cast<std::size_t>(level.height)) {
    for (int row = 0; row < level.height; ++row) {
      const auto from = level.values.begin() + static_cast<std::ptrdiff_t>(row) * level.width;
      std::copy(from, from + level.width,
                values_.begin() + row * static_cast<std::ptrdiff_t>(width_) + level.first_col - first_col);
    }
  }

  /// Number of columns, a multiple of kBlock.
  std::size_t width() const { return width_; }
  const std::int8_t* at(int row) const {
    const int local = row - first_row_;
    return local < 0 || local >= height_ ? zeros_.data() : &values_[static_cast<std::size_t>(local) * width_];
  }

  static constexpr std::size_t kBlock = 8;

 private:
  int first_row_, height_;
  std::size_t width_;
  std::vector<std::int8_t> zeros_, values_;
};

/// Maximum over rows of PaddedRows, [col].
template <std::size_t kRows>
void highest_of(const std::array<const std::int8_t*, kRows>& rows, std::vector<std::int8_t>& highest) {
  for (std::size_t block = 0; block < highest.size(); block += PaddedRows::kBlock) {
    std::array<std::uint64_t, kRows> words;
    for (std::size_t i = 0; i < kRows; ++i) std::memcpy(&words[i], rows[i] + block, sizeof(words[i]));
    std::int8_t* const out = &highest[block];
    std::memcpy(out, words.data(), sizeof(words[0]));
    if (std::ranges::count(words, words[0]) == kRows) continue;
    for (std::size_t i = 1; i < kRows; ++i) {
      for (std::size_t col = 0; col < PaddedRows::kBlock; ++col) out[col] = std::max(out[col], rows[i][block + col]);
    }
  }
}

}  // namespace

LikelihoodPyramid::LikelihoodPyramid(const GridMap& map, double resolution_m, int num_levels)
    : resolution_m_(resolution_m) {
  levels_.push_back(rasterize_finest(map));
  for (int l = 1; l < num_levels; ++l) levels_.push_back(halved(levels_.back(), l == 1));
}

Cell LikelihoodPyramid::cell_of(const Eigen::Vector2d& p_map) const {
  return {static_cast<int>(std::floor(p_map.x() / resolution_m_)),
          static_cast<int>(std::floor(p_map.y() / resolution_m_))};
}

// Returns an empty level that covers all tiles, plus a margin of `kMargin_cells` cells. Mean hits are up to half a map
// cell from the cell centers, and slightly more after rounding to float. The extent of the centers alone would be too
// small.
LikelihoodPyramid::Level LikelihoodPyramid::empty_level(const GridMap& map) const {
  constexpr int kMax = std::numeric_limits<int>::max();
  int low_col = kMax, low_row = kMax, high_col = -kMax, high_row = -kMax;
  const Eigen::Vector2d margin = Eigen::Vector2d::Constant(map.resolution_m());
  map.for_each_tile([&](Cell first, const GridTile&) {
    const Cell last{first.col + GridTile::kSize - 1, first.row + GridTile::kSize - 1};
    const Cell low = cell_of(map.center_of(first) - margin), high = cell_of(map.center_of(last) + margin);
    low_col = std::min(low_col, low.col), low_row = std::min(low_row, low.row);
    high_col = std::max(high_col, high.col), high_row = std::max(high_row, high.row);
  });
  Level level;
  if (low_col <= high_col) {
    level.first_col = low_col - kMargin_cells, level.first_row = low_row - kMargin_cells;
    level.width = high_col - low_col + 1 + 2 * kMargin_cells, level.height = high_row - low_row + 1 + 2 * kMargin_cells;
  }
  level.clear();
  return level;
}

LikelihoodPyramid::Level LikelihoodPyramid::rasterize_finest(const GridMap& map) const {
  Level finest = empty_level(map);
  std::vector<Cell> surfaces;
  map.for_each_tile([&](Cell first, const GridTile& tile) {
    std::array<Cell, GridTile::kSize> centers;  // of the cells on the tile's diagonal: the column and row of each cell
    for (int i = 0; i < GridTile::kSize; ++i)
      centers[static_cast<std::size_t>(i)] = cell_of(map.center_of({first.col + i, first.row + i}));
    mark_free(tile, centers, finest);
    tile.for_each_surface([&](int col, int row, const GridTile::Hits& hits) {
      const Eigen::Vector2d center = map.center_of({first.col + col, first.row + row});
      surfaces.push_back(cell_of(center + Eigen::Vector2d(hits.mean_x_m, hits.mean_y_m)));
    });
  });
  const Kernel kernel = surface_kernel();
  for (const Cell& surface : surfaces) {
    int row = surface.row - kMargin_cells;
    for (const auto& values : kernel) {
      std::int8_t* cell = &finest.at(surface.col - kMargin_cells, row++);
      for (const std::int8_t value : values) {
        *cell = std::max(*cell, value);
        ++cell;
      }
    }
  }
  return finest;
}

// A cell and its neighbors cover 4 x 4 cells of the level below. Above the finest level each of those already covers 2
// x 2, so every second one suffices. The maximum over rows is computed first, of eight columns at a time: most are in
// an unobserved or free area, where the rows are equal.
LikelihoodPyramid::Level LikelihoodPyramid::halved(const Level& fine, bool is_from_finest) {
  Level coarse;
  coarse.first_col = (fine.first_col >> 1) - 1, coarse.first_row = (fine.first_row >> 1) - 1;
  coarse.width = ((fine.first_col + fine.width) >> 1) + 1 - coarse.first_col,
  coarse.height = ((fine.first_row + fine.height) >> 1) + 1 - coarse.first_row;
  coarse.clear();
  const PaddedRows rows(fine, 2 * coarse.first_col, 2 * coarse.width + 2);
  std::vector<std::int8_t> highest(rows.width());  // over the rows, [col of fine]
  const std::size_t step = is_from_finest ? 1 : 2;
  auto value = coarse.values.begin();
  for (int row = coarse.first_row; row < coarse.first_row + coarse.height; ++row) {
    if (is_from_finest) {
      highest_of<4>({rows.at(2 * row), rows.at(2 * row + 1), rows.at(2 * row + 2), rows.at(2 * row + 3)}, highest);
    } else {
      highest_of<2>({rows.at(2 * row), rows.at(2 * row + 2)}, highest);
    }
    const std::int8_t* first = highest.data();
    for (int col = 0; col < coarse.width; ++col, first += 2, ++value) {
      *value = std::max(first[0], first[2]);
      if (step == 1) *value = std::max({*value, first[1], first[3]});
    }
  }
  return coarse;
}

}  // namespace patrol::slam
