#include "plan/distance_field.h"

#include <algorithm>
#include <cassert>

namespace patrol::plan {

DistanceTransform::DistanceTransform(int cap_cells) : cap_(cap_cells) { assert(cap_ >= 1 && cap_ <= 100); }

void DistanceTransform::compute(const std::vector<std::uint8_t>& is_obstacle, int width, int height,
                                SquaredDistances& result) {
  const auto columns = static_cast<std::size_t>(width);
  const auto rows = static_cast<std::size_t>(height);
  assert(is_obstacle.size() == columns * rows);
  along_rows_.resize(columns * rows);
  row_is_empty_.resize(rows);
  for (std::size_t row = 0; row < rows; ++row) {
    const std::uint8_t* obstacles = is_obstacle.data() + row * columns;
    row_is_empty_[row] = std::find(obstacles, obstacles + columns, 1) == obstacles + columns;
    if (!row_is_empty_[row]) scan_row(obstacles, width, along_rows_.data() + row * columns);
  }

  result.assign(columns * rows, beyond());
  for (std::size_t row = 0; row < rows; ++row) {
    std::int16_t* nearest = result.data() + row * columns;
    const std::size_t first = row - std::min(row, static_cast<std::size_t>(cap_));
    const std::size_t last = std::min(rows - 1, row + static_cast<std::size_t>(cap_));
    for (std::size_t other = first; other <= last; ++other) {
      if (row_is_empty_[other]) continue;
      const int apart = static_cast<int>(other) - static_cast<int>(row);
      const auto parabola = static_cast<std::int16_t>(apart * apart);
      const std::int16_t* squared = along_rows_.data() + other * columns;
      for (std::size_t col = 0; col < columns; ++col) {
        nearest[col] = std::min(nearest[col], static_cast<std::int16_t>(squared[col] + parabola));
      }
    }
  }
}

void DistanceTransform::scan_row(const std::uint8_t* is_obstacle, int width, std::int16_t* squared) const {
  const int far = cap_ + 1;
  const auto square = [this](int distance) {
    return static_cast<std::int16_t>(distance > cap_ ? cap_ * cap_ + 1 : distance * distance);
  };
  int distance = far;
  for (int col = 0; col < width; ++col) {
    distance = is_obstacle[col] ? 0 : std::min(far, distance + 1);
    squared[col] = square(distance);
  }
  distance = far;
  for (int col = width - 1; col >= 0; --col) {
    distance = is_obstacle[col] ? 0 : std::min(far, distance + 1);
    squared[col] = std::min(squared[col], square(distance));
  }
}

}  // namespace patrol::plan
