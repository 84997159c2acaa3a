#include "slam/grid_map.h"

#include <algorithm>
#include <limits>

namespace patrol::slam {
namespace {

constexpr std::uint16_t kMaxCount = std::numeric_limits<std::uint16_t>::max();
constexpr double kPassToleranceInCells = 0.2;  // a beam this close to the mean hit would have been stopped by a surface

std::uint16_t add_saturated(std::uint16_t count, int more) {
  return static_cast<std::uint16_t>(std::min(static_cast<int>(kMaxCount), count + more));
}

}  // namespace

void GridTile::update_surface_bit(int col, int row) {
  const std::uint32_t bit = 1U << col;
  std::uint32_t& bits = surface_bits[static_cast<std::size_t>(row)];
  bits = at(col, row).is_surface() ? bits | bit : bits & ~bit;
}

GridMap::GridMap(double resolution_m, double max_extent_m)
    : resolution_m_(resolution_m),
      inverse_resolution_(1.0 / resolution_m),
      max_tile_(std::max(1, static_cast<int>(std::ceil(max_extent_m / (2.0 * resolution_m * GridTile::kSize))))) {}

std::optional<GridCell> GridMap::find(Cell cell) const {
  const GridTile* tile = tile_at(tile_of(cell.col), tile_of(cell.row));
  return tile ? std::optional(tile->at(local(cell.col), local(cell.row))) : std::nullopt;
}

void GridMap::add_hit(const Eigen::Vector2d& p_map) {
  const Cell at = cell_at(p_map);
  GridTile* tile = writable_tile(tile_of(at.col), tile_of(at.row));
  if (!tile) return;
  if (tile->hits.empty()) tile->hits.resize(GridTile::kSize * GridTile::kSize);
  const int col = local(at.col), row = local(at.row);
  GridTile::Hits& hits = tile->hits[GridTile::index_of(col, row)];
  if (hits.count < kMaxCount) {
    ++hits.count;
    const auto x_m = static_cast<float>(p_map.x() - resolution_m_ * (at.col + 0.5)),
               y_m = static_cast<float>(p_map.y() - resolution_m_ * (at.row + 0.5));
    const float weight = 1.0F / static_cast<float>(hits.count);
    hits.mean_x_m += weight * (x_m - hits.mean_x_m);
    hits.mean_y_m += weight * (y_m - hits.mean_y_m);
  }
  tile->hit_bits[static_cast<std::size_t>(row)] |= 1U << col;
  tile->update_surface_bit(col, row);
  has_surface_ = true;
}

// Voxel traversal [Amanatides87], tile by tile.
void GridMap::add_free_ray(const Eigen::Vector2d& from_map, const Eigen::Vector2d& to_map, int weight,
                           bool stop_at_surface) {
  const Eigen::Vector2d ray = to_map - from_map;
  const double length_m = ray.norm();
  if (!(length_m > 0.0)) return;
  const Eigen::Vector2d direction = ray / length_m;
  Cell at = cell_at(from_map);
  const int step_x = direction.x() < 0.0 ? -1 : 1, step_y = direction.y() < 0.0 ? -1 : 1;
  constexpr double kNever = std::numeric_limits<double>::infinity();
  const double delta_x = direction.x() != 0.0 ? resolution_m_ / std::abs(direction.x()) : kNever;
  const double delta_y = direction.y() != 0.0 ? resolution_m_ / std::abs(direction.y()) : kNever;
  const auto first_crossing = [&](int index, int step, double start, double slope) {
    const double edge = resolution_m_ * (step > 0 ? index + 1 : index);
    return slope != 0.0 ? (edge - start) / slope : kNever;
  };
  double next_x = first_crossing(at.col, step_x, from_map.x(), direction.x());
  double next_y = first_crossing(at.row, step_y, from_map.y(), direction.y());
  const auto is_near_mean = [&](Cell cell, const GridTile::Hits& hits) {
    const double x_m = resolution_m_ * (cell.col + 0.5) + static_cast<double>(hits.mean_x_m) - from_map.x(),
                 y_m = resolution_m_ * (cell.row + 0.5) + static_cast<double>(hits.mean_y_m) - from_map.y();
    return std::abs(direction.x() * y_m - direction.y() * x_m) < kPassToleranceInCells * resolution_m_;
  };

  for (double traveled = 0.0; traveled < length_m;) {
    GridTile* tile = writable_tile(tile_of(at.col), tile_of(at.row));
    if (!tile) return;
    const Cell corner{at.col - local(at.col), at.row - local(at.row)};
    int col = local(at.col), row = local(at.row);
    do {
      const std::size_t index = GridTile::index_of(col, row);
      if (!tile->has_hits(col, row)) {
        tile->passes[index] = add_saturated(tile->passes[index], weight);
      } else {
        if (stop_at_surface && tile->is_surface(col, row)) return;
        if (is_near_mean({corner.col + col, corner.row + row}, tile->hits[index])) {
          tile->passes[index] = add_saturated(tile->passes[index], weight);
          tile->update_surface_bit(col, row);
        }
      }
      if (next_x < next_y) {
        traveled = next_x;
        next_x += delta_x;
        col += step_x;
      } else {
        traveled = next_y;
        next_y += delta_y;
        row += step_y;
      }
    } while (traveled < length_m && ((col | row) & ~(GridTile::kSize - 1)) == 0);
    at = {corner.col + col, corner.row + row};
  }
}

GridTile* GridMap::writable_tile(int tile_col, int tile_row) {
  const auto is_kept = [this](int index) { return index >= -max_tile_ && index < max_tile_; };
  if (!is_kept(tile_col) || !is_kept(tile_row)) return nullptr;
  if (static_cast<unsigned>(tile_col - first_col_) >= static_cast<unsigned>(num_cols_) ||
      static_cast<unsigned>(tile_row - first_row_) >= static_cast<unsigned>(num_rows_))
    grow_to_include(tile_col, tile_row);
  auto& tile = tiles_[static_cast<std::size_t>((tile_row - first_row_) * num_cols_ + tile_col - first_col_)];
  if (!tile) {
    tile = std::make_shared<GridTile>();
  } else if (tile.use_count() > 1) {
    tile = std::make_shared<GridTile>(*tile);
  }
  return tile.get();
}

// Grows by a margin of tiles, so that the pointers are not copied at every step.
void GridMap::grow_to_include(int tile_col, int tile_row) {
  constexpr int kMargin = 16;
  const bool is_empty = tiles_.empty();
  const auto grown = [&](int index, int first, int count) {
    int low = is_empty ? index : first, high = is_empty ? index + 1 : first + count;
    if (index < low || is_empty) low = index - kMargin;
    if (index >= high || is_empty) high = index + kMargin + 1;
    return std::pair{std::max(low, -max_tile_), std::min(high, max_tile_)};
  };
  const auto [col_begin, col_end] = grown(tile_col, first_col_, num_cols_);
  const auto [row_begin, row_end] = grown(tile_row, first_row_, num_rows_);
  const int cols = col_end - col_begin, rows = row_end - row_begin;
  std::vector<std::shared_ptr<GridTile>> tiles(static_cast<std::size_t>(cols) * static_cast<std::size_t>(rows));
  for (int row = 0; row < num_rows_; ++row) {
    for (int col = 0; col < num_cols_; ++col) {
      const int to = (row + first_row_ - row_begin) * cols + col + first_col_ - col_begin;
      tiles[static_cast<std::size_t>(to)] = std::move(tiles_[static_cast<std::size_t>(row * num_cols_ + col)]);
    }
  }
  tiles_ = std::move(tiles);
  first_col_ = col_begin, first_row_ = row_begin, num_cols_ = cols, num_rows_ = rows;
}

std::size_t GridMap::num_tiles() const {
  return static_cast<std::size_t>(
      std::count_if(tiles_.begin(), tiles_.end(), [](const auto& tile) { return tile != nullptr; }));
}

std::size_t GridMap::num_unshared_tiles() const {
  return static_cast<std::size_t>(
      std::count_if(tiles_.begin(), tiles_.end(), [](const auto& tile) { return tile && tile.use_count() == 1; }));
}

}  // namespace patrol::slam
