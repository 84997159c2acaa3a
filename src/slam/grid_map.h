#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
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
};

/// Square block of cells, shared between particles and copied on write.
struct GridTile {
  static constexpr int kBits = 5;
  static constexpr int kSize = 1 << kBits;

  std::array<GridCell, kSize * kSize> cells{};      ///< [row][col]
  std::array<std::uint32_t, kSize> surface_bits{};  ///< [row]: bit col is cells[row][col].is_surface()

  GridCell& at(int col, int row) { return cells[static_cast<std::size_t>(row * kSize + col)]; }
  const GridCell& at(int col, int row) const { return cells[static_cast<std::size_t>(row * kSize + col)]; }
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
    return {static_cast<int>(std::floor(p_map.x() * inverse_resolution_)),
            static_cast<int>(std::floor(p_map.y() * inverse_resolution_))};
  }
  Eigen::Vector2d center_of(Cell cell) const { return resolution_m_ * Eigen::Vector2d(cell.col + 0.5, cell.row + 0.5); }

  /// Returns null in tiles without observations.
  const GridCell* find(Cell cell) const;
  bool is_surface(Cell cell) const { return is_surface_within(cell, 0); }
  /// Returns whether a surface cell is at most `radius` columns and rows away; radius < 16.
  bool is_surface_within(Cell cell, int radius) const {
    return visit_surface(cell, radius, [](const GridTile&, int, int, Cell) { return true; });
  }
  /// Calls `visit(mean, hits)` for every surface cell at most `radius` columns and rows away, with the mean of its hits
  /// in map and their number.
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

  double resolution_m_;
  double inverse_resolution_;
  int max_tile_;                                                     ///< tiles from -max_tile_ to max_tile_ - 1 exist
  int first_col_ = 0, first_row_ = 0, num_cols_ = 0, num_rows_ = 0;  ///< tile rectangle
  std::vector<std::shared_ptr<GridTile>> tiles_;                     ///< [row][col]
  bool has_surface_ = false;
};

// Visits surface cells until the visitor returns true. One word of bits covers a row of a tile, so that the mostly
// empty neighborhood costs a few instructions per row.
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
        const std::uint32_t window = (~0U >> (31 - (last_col - col))) << local(col);
        for (int r = row; r <= last_row; ++r) {
          for (std::uint32_t bits = tile->surface_bits[static_cast<std::size_t>(local(r))] & window; bits != 0;
               bits &= bits - 1) {
            const int c = std::countr_zero(bits);
            if (visit(*tile, c, local(r), Cell{tile_col * GridTile::kSize + c, r})) return true;
          }
        }
      }
      col = last_col + 1;
    }
    row = last_row + 1;
  }
  return false;
}

template <typename Visitor>
void GridMap::for_each_surface_near(Cell cell, int radius, Visitor&& visit) const {
  visit_surface(cell, radius, [&](const GridTile& tile, int col, int row, Cell at) {
    const GridCell& hit_cell = tile.at(col, row);
    const Eigen::Vector2d mean = center_of(at) + Eigen::Vector2d(hit_cell.mean_x_m, hit_cell.mean_y_m);
    visit(mean, static_cast<int>(hit_cell.hits));
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
