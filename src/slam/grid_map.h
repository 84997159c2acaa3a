#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "core/grid.h"

namespace patrol::slam {

/// Beam statistics of a cell: number of beams that ended in it, number that passed through, and the mean end point.
/// Matching against the mean is more accurate than against the cell [Grisetti07].
struct GridCell {
  float mean_x_m = 0.0F;  ///< mean of the hits relative to the cell center
  float mean_y_m = 0.0F;
  std::uint16_t hits = 0;
  std::uint16_t passes = 0;

  /// True if at least a fifth of the beams ended here. Beams that graze a wall and end farther along it also count as
  /// passes, so a threshold of one half would erase walls. A moving object is cleared after more than four times as
  /// many passes as hits. An object in a cell observed as free appears only after as many hits as exceed a quarter of
  /// the passes.
  bool is_surface() const { return hits > 0 && 4U * hits >= passes; }
  bool is_observed() const { return hits > 0 || passes > 0; }
  bool operator==(const GridCell&) const = default;
};

/// Square block of cells, shared between particles and copied on write. Passes are separate from hits: a row of passes
/// is one cache line, and most tiles have no hits.
struct GridTile {
  static constexpr int kBits = 5;
  static constexpr int kSize = 1 << kBits;

  /// Hits of a cell.
  struct Hits {
    float mean_x_m = 0.0F;  ///< mean of the hits relative to the cell center
    float mean_y_m = 0.0F;
    std::uint16_t count = 0;
  };

  alignas(64) std::array<std::uint16_t, kSize * kSize> passes{};  ///< [row][col]
  std::array<std::uint32_t, kSize> hit_bits{};                    ///< [row]: bit col is at(col, row).hits > 0
  std::array<std::uint32_t, kSize> surface_bits{};                ///< [row]: bit col is at(col, row).is_surface()
  std::vector<Hits> hits;                                         ///< [row][col]; empty: no cell has hits

  static std::size_t index_of(int col, int row) { return static_cast<std::size_t>(row * kSize + col); }
  bool has_hits(int col, int row) const { return (hit_bits[static_cast<std::size_t>(row)] >> col & 1U) != 0; }
  bool is_surface(int col, int row) const { return (surface_bits[static_cast<std::size_t>(row)] >> col & 1U) != 0; }
  GridCell at(int col, int row) const;
  /// Calls `visit(col, row, hits)` for the surface cells in ascending row order.
  template <typename Visitor>
  void for_each_surface(Visitor&& visit) const {
    for (int row = 0; row < kSize; ++row) {
      for (std::uint32_t bits = surface_bits[static_cast<std::size_t>(row)]; bits != 0; bits &= bits - 1) {
        const int col = std::countr_zero(bits);
        visit(col, row, hits[index_of(col, row)]);
      }
    }
  }
  void update_surface_bit(int col, int row);
};

/// Map of a particle: a growing rectangle of tiles, copied on write. Copying a map copies pointers only; a tile is
/// copied when it is modified and another map refers to it. Cell (0, 0) has its lower-left corner at the origin of
/// `map`; indices may be negative.
class GridMap {
 public:
  /// Hits and rays farther than half of `max_extent_m` from the origin along either axis are ignored.
  GridMap(double resolution_m, double max_extent_m);

  double resolution_m() const { return resolution_m_; }
  Cell cell_at(const Eigen::Vector2d& p_map) const {
    return {floor_to_int(p_map.x() * inverse_resolution_), floor_to_int(p_map.y() * inverse_resolution_)};
  }
  Eigen::Vector2d center_of(Cell cell) const { return resolution_m_ * Eigen::Vector2d(cell.col + 0.5, cell.row + 0.5); }

  /// Returns none in tiles without observations.
  std::optional<GridCell> find(Cell cell) const;
  bool is_surface(Cell cell) const { return is_surface_within(cell, 0); }
  /// Returns whether a surface cell is at most `radius` columns and rows away; radius < 16.
  bool is_surface_within(Cell cell, int radius) const {
    return visit_surface(cell, radius, [](const GridTile&, int, int, Cell) { return true; });
  }
  /// Calls `visit(mean_x_m, mean_y_m, hits)` for every surface cell at most `radius` columns and rows away, with the
  /// mean of its hits in map and their number.
  template <typename Visitor>
  void for_each_surface_near(Cell cell, int radius, Visitor&& visit) const;

  /// Adds a beam that ended at `p_map`.
  void add_hit(const Eigen::Vector2d& p_map);
  /// Adds `weight` beams that were free from `from_map` to `to_map`. In a cell with hits, a pass counts only if the
  /// beam runs near the mean of the hits. A beam along a wall, within its cells, thus does not clear the wall.
  /// `stop_at_surface` ends the ray at the first surface, because a beam without a return may have met a dark surface.
  void add_free_ray(const Eigen::Vector2d& from_map, const Eigen::Vector2d& to_map, int weight, bool stop_at_surface);

  bool has_surface() const { return has_surface_; }
  /// Calls `visit(first_cell, tile)` for every tile, in ascending row order.
  template <typename Visitor>
  void for_each_tile(Visitor&& visit) const;
  /// Number of tiles not shared with another map: the actual memory cost of this particle.
  std::size_t num_unshared_tiles() const;
  std::size_t num_tiles() const;

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(resolution_m_, inverse_resolution_, max_tile_, first_col_, first_row_, num_cols_, num_rows_, tiles_,
            has_surface_);
  }

 private:
  static int floor_to_int(double value) {
    const int truncated = static_cast<int>(value);
    return static_cast<int>(static_cast<unsigned>(truncated) - (value < truncated ? 1U : 0U));
  }
  static int tile_of(int index) { return index >> GridTile::kBits; }
  static int local(int index) { return index & (GridTile::kSize - 1); }

  const GridTile* tile_at(int tile_col, int tile_row) const {
    const int col = tile_col - first_col_, row = tile_row - first_row_;
    if (col < 0 || row < 0 || col >= num_cols_ || row >= num_rows_) return nullptr;
    return tiles_[static_cast<std::size_t>(row * num_cols_ + col)].get();
  }
  GridTile* writable_tile(int tile_col, int tile_row);
  void grow_to_include(int tile_col, int tile_row);
  template <typename Visitor>
  bool visit_surface(Cell cell, int radius, Visitor&& visit) const;

  /// Columns and rows of a tile.
  struct LocalWindow {
    int col = 0, row = 0;            ///< first column and row
    int num_cols = 1, num_rows = 1;  ///< number of columns and rows
  };
  /// Calls `visit(col, row)` for the surface cells of a window until it returns true, in ascending row order.
  template <typename Visitor>
  static bool visit_rows(const GridTile& tile, const LocalWindow& window, Visitor&& visit);
  /// Version of `visit_rows` for a window of at most 8 columns and rows.
  template <typename Visitor>
  static bool visit_small(const GridTile& tile, const LocalWindow& window, Visitor&& visit);

  double resolution_m_;
  double inverse_resolution_;
  int max_tile_;                                                     ///< tiles from -max_tile_ to max_tile_ - 1 exist
  int first_col_ = 0, first_row_ = 0, num_cols_ = 0, num_rows_ = 0;  ///< tile rectangle
  std::vector<std::shared_ptr<GridTile>> tiles_;                     ///< [row][col]
  bool has_surface_ = false;
};

inline GridCell GridTile::at(int col, int row) const {
  const std::size_t index = index_of(col, row);
  GridCell cell{.passes = passes[index]};
  if (has_hits(col, row)) {
    cell.mean_x_m = hits[index].mean_x_m;
    cell.mean_y_m = hits[index].mean_y_m;
    cell.hits = hits[index].count;
  }
  return cell;
}

// Visits surface cells until the visitor returns true. One word of bits covers a row of a tile, and one word of 8 x 8
// bits a small window in a tile, so that the mostly empty neighborhood costs a few instructions.
template <typename Visitor>
bool GridMap::visit_surface(Cell cell, int radius, Visitor&& visit) const {
  const int col_end = cell.col + radius, row_end = cell.row + radius;
  for (int row = cell.row - radius; row <= row_end;) {
    const int tile_row = tile_of(row);
    const int last_row = std::min(row_end, (tile_row + 1) * GridTile::kSize - 1);
    for (int col = cell.col - radius; col <= col_end;) {
      const int tile_col = tile_of(col);
      const int last_col = std::min(col_end, (tile_col + 1) * GridTile::kSize - 1);
      if (const GridTile* tile = tile_at(tile_col, tile_row)) {
        const auto visit_local = [&](int c, int r) {
          return visit(*tile, c, r, Cell{tile_col * GridTile::kSize + c, tile_row * GridTile::kSize + r});
        };
        const LocalWindow window{local(col), local(row), last_col - col + 1, last_row - row + 1};
        if (radius < 4 ? visit_small(*tile, window, visit_local) : visit_rows(*tile, window, visit_local)) return true;
      }
      col = last_col + 1;
    }
    row = last_row + 1;
  }
  return false;
}

template <typename Visitor>
bool GridMap::visit_small(const GridTile& tile, const LocalWindow& window, Visitor&& visit) {
  const std::uint32_t row_mask = (1U << window.num_cols) - 1U;
  std::uint64_t bits = 0;
  for (int i = 0; i < window.num_rows; ++i) {
    const std::uint64_t row_bits = tile.surface_bits[static_cast<std::size_t>(window.row + i)] >> window.col & row_mask;
    bits |= row_bits << (8 * i);
  }
  for (; bits != 0; bits &= bits - 1) {
    const int bit = std::countr_zero(bits);
    if (visit(window.col + (bit & 7), window.row + (bit >> 3))) return true;
  }
  return false;
}

template <typename Visitor>
bool GridMap::visit_rows(const GridTile& tile, const LocalWindow& window, Visitor&& visit) {
  const std::uint32_t mask = (~0U >> (32 - window.num_cols)) << window.col;
  for (int row = window.row; row < window.row + window.num_rows; ++row) {
    for (std::uint32_t bits = tile.surface_bits[static_cast<std::size_t>(row)] & mask; bits != 0; bits &= bits - 1) {
      if (visit(std::countr_zero(bits), row)) return true;
    }
  }
  return false;
}

template <typename Visitor>
void GridMap::for_each_surface_near(Cell cell, int radius, Visitor&& visit) const {
  visit_surface(cell, radius, [&](const GridTile& tile, int col, int row, Cell at) {
    const GridTile::Hits& hits = tile.hits[GridTile::index_of(col, row)];
    visit(resolution_m_ * (at.col + 0.5) + static_cast<double>(hits.mean_x_m),
          resolution_m_ * (at.row + 0.5) + static_cast<double>(hits.mean_y_m), static_cast<int>(hits.count));
    return false;
  });
}

template <typename Visitor>
void GridMap::for_each_tile(Visitor&& visit) const {
  for (int row = 0; row < num_rows_; ++row) {
    for (int col = 0; col < num_cols_; ++col) {
      const auto& tile = tiles_[static_cast<std::size_t>(row * num_cols_ + col)];
      if (tile) visit(Cell{(first_col_ + col) * GridTile::kSize, (first_row_ + row) * GridTile::kSize}, *tile);
    }
  }
}

}  // namespace patrol::slam
