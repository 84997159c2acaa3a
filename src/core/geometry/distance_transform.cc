#include "core/geometry/distance_transform.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace patrol {
namespace {

/// Squared distances along one row; `square(d)` is the value of a distance of d cells, `far` the largest distance that
/// counts.
template <typename Value, typename Square>
void transform_row(const std::uint8_t* is_obstacle, int width, int far, const Square& square, Value* squared) {
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

/// Lower envelope of parabolas over one row [Felzenszwalb12]. The parabolas of the envelope are the vertices of the
/// lower convex hull of the points (x, x^2 + squared distance along the column at x). All numbers are integers.
class LowerEnvelope {
 public:
  explicit LowerEnvelope(std::size_t length) : column_(length), height_(length) {}

  /// `squared[i]` becomes the minimum over j of along[j]^2 + (i - j)^2. Cells with `far` have no parabola.
  template <typename Value>
  void apply(const std::vector<std::int32_t>& along, std::int32_t far, Value* squared) {
    build(along, far);
    if (size_ == 0) {
      std::fill_n(squared, along.size(), static_cast<Value>(kNoObstacle));
      return;
    }
    std::size_t k = 0;
    for (std::size_t i = 0; i < along.size(); ++i) {
      const auto x = static_cast<std::int64_t>(i);
      while (k + 1 < size_ && height_[k + 1] - height_[k] <= 2 * x * (column_[k + 1] - column_[k])) ++k;
      squared[i] = static_cast<Value>(x * x - 2 * x * column_[k] + height_[k]);
    }
  }

 private:
  void build(const std::vector<std::int32_t>& along, std::int32_t far) {
    size_ = 0;
    for (std::size_t i = 0; i < along.size(); ++i) {
      if (along[i] == far) continue;
      const auto x = static_cast<std::int64_t>(i), distance = static_cast<std::int64_t>(along[i]);
      const std::int64_t height = x * x + distance * distance;
      while (size_ > 1 && !is_below(x, height)) --size_;
      column_[size_] = x;
      height_[size_++] = height;
    }
  }

  /// True if the last vertex is below the line from the one before it to the point.
  bool is_below(std::int64_t x, std::int64_t height) const {
    const std::size_t last = size_ - 1;
    return (height_[last] - height_[last - 1]) * (x - column_[last]) <
           (height - height_[last]) * (column_[last] - column_[last - 1]);
  }

  std::vector<std::int64_t> column_, height_;  ///< columns and heights of the vertices
  std::size_t size_ = 0;                       ///< number of vertices
};

/// Sweeps down and up the columns, whole rows at a time. The distances to the obstacles below wait in the result.
template <typename Value>
std::vector<Value> transform_without_cap(const std::vector<std::uint8_t>& is_obstacle, int width, int height) {
  const auto columns = static_cast<std::size_t>(width), rows = static_cast<std::size_t>(height);
  assert(is_obstacle.size() == columns * rows);
  std::vector<Value> squared(columns * rows);
  const std::int32_t far = height;
  std::vector<std::int32_t> along(columns, far), above(columns, far);
  for (std::size_t row = 0; row < rows; ++row) {
    const std::uint8_t* obstacles = is_obstacle.data() + row * columns;
    Value* below = squared.data() + row * columns;
    for (std::size_t col = 0; col < columns; ++col) {
      along[col] = obstacles[col] != 0 ? 0 : std::min(far, along[col] + 1);
      below[col] = static_cast<Value>(along[col]);
    }
  }
  LowerEnvelope envelope(columns);
  for (std::size_t row = rows; row-- > 0;) {
    const std::uint8_t* obstacles = is_obstacle.data() + row * columns;
    Value* result = squared.data() + row * columns;
    for (std::size_t col = 0; col < columns; ++col) {
      above[col] = obstacles[col] != 0 ? 0 : std::min(far, above[col] + 1);
      along[col] = std::min(above[col], static_cast<std::int32_t>(result[col]));
    }
    envelope.apply(along, far, result);
  }
  return squared;
}

}  // namespace

DistanceTransform::DistanceTransform(int cap_cells) : cap_(cap_cells) { assert(cap_ >= 1 && cap_ <= kMaxCap_cells); }

void DistanceTransform::compute(const std::vector<std::uint8_t>& is_obstacle, int width, int height,
                                const Window& target, SquaredDistances& result) {
  constexpr std::size_t kBlock = 16;  // columns in two vector registers
  using Block = std::array<std::int16_t, kBlock>;
  const auto columns = static_cast<std::size_t>(width), rows = static_cast<std::size_t>(height),
             cap = static_cast<std::size_t>(cap_);
  assert(is_obstacle.size() == columns * rows);
  assert(target.col >= 0 && target.row >= 0 && target.col + target.width <= width &&
         target.row + target.height <= height);
  along_rows_.resize(columns * rows + kBlock);  // the last block of a row may extend beyond it
  rows_.clear();
  const auto square = [this](int distance) {
    return distance > cap_ ? beyond() : static_cast<std::int16_t>(distance * distance);
  };
  for (std::size_t row = 0; row < rows; ++row) {
    const std::uint8_t* obstacles = is_obstacle.data() + row * columns;
    if (std::find(obstacles, obstacles + columns, 1) == obstacles + columns) continue;
    transform_row(obstacles, width, cap_ + 1, square, along_rows_.data() + row * columns);
    rows_.push_back(row);
  }

  const auto target_columns = static_cast<std::size_t>(target.width), first_row = static_cast<std::size_t>(target.row);
  result.resize(target_columns * static_cast<std::size_t>(target.height));
  std::int16_t* out = result.data();
  std::size_t begin = 0, end = 0;  // of the rows within the cap, in rows_
  for (std::size_t row = first_row; row < first_row + static_cast<std::size_t>(target.height); ++row) {
    while (begin < rows_.size() && rows_[begin] + cap < row) ++begin;
    while (end < rows_.size() && rows_[end] <= row + cap) ++end;
    for (std::size_t first = 0; first < target_columns; first += kBlock) {
      Block nearest;
      nearest.fill(beyond());
      for (std::size_t i = begin; i < end; ++i) {
        const int apart = static_cast<int>(rows_[i]) - static_cast<int>(row);
        const auto parabola = static_cast<std::int16_t>(apart * apart);
        Block squared;
        std::memcpy(squared.data(), &along_rows_[rows_[i] * columns + static_cast<std::size_t>(target.col) + first],
                    sizeof(squared));
        for (std::size_t col = 0; col < kBlock; ++col)
          nearest[col] = std::min(nearest[col], static_cast<std::int16_t>(squared[col] + parabola));
      }
      out = std::copy_n(nearest.begin(), std::min(kBlock, target_columns - first), out);
    }
  }
}

std::vector<double> squared_distances(const std::vector<std::uint8_t>& is_obstacle, int width, int height) {
  return transform_without_cap<double>(is_obstacle, width, height);
}

std::vector<float> squared_distances_float(const std::vector<std::uint8_t>& is_obstacle, int width, int height) {
  return transform_without_cap<float>(is_obstacle, width, height);
}

}  // namespace patrol
