#include "core/geometry/distance_transform.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <cstring>
#include <limits>

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

/// Lower envelope of parabolas over one column [Felzenszwalb12].
class LowerEnvelope {
 public:
  explicit LowerEnvelope(std::size_t length) : vertex_(length), boundary_(length + 1), input_(length) {}

  /// `line[i]` becomes the minimum over j of line[j] + (i - j)^2.
  void apply(double* line) {
    std::copy_n(line, input_.size(), input_.begin());
    build();
    for (std::size_t q = 0, k = 0; q < input_.size(); ++q) {
      while (boundary_[k + 1] < static_cast<double>(q)) ++k;
      const double step = static_cast<double>(q) - static_cast<double>(vertex_[k]);
      line[q] = step * step + input_[vertex_[k]];
    }
  }

 private:
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();

  void build() {
    std::size_t last = 0;
    vertex_[0] = 0;
    boundary_[0] = -kInfinity;
    boundary_[1] = kInfinity;
    for (std::size_t q = 1; q < input_.size(); ++q) {
      double meet = intersection(vertex_[last], q);
      while (meet <= boundary_[last]) meet = intersection(vertex_[--last], q);
      vertex_[++last] = q;
      boundary_[last] = meet;
      boundary_[last + 1] = kInfinity;
    }
  }

  /// Abscissa at which the parabolas with the vertices p < q intersect.
  double intersection(std::size_t p, std::size_t q) const {
    const auto x_p = static_cast<double>(p), x_q = static_cast<double>(q);
    return ((input_[q] + x_q * x_q) - (input_[p] + x_p * x_p)) / (2.0 * (x_q - x_p));
  }

  std::vector<std::size_t> vertex_;  ///< of the envelope's parabolas
  std::vector<double> boundary_;     ///< between neighboring parabolas
  std::vector<double> input_;
};

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
  const auto columns = static_cast<std::size_t>(width), rows = static_cast<std::size_t>(height);
  assert(is_obstacle.size() == columns * rows);
  std::vector<double> squared(columns * rows);
  if (squared.empty()) return squared;
  const auto square = [width](int distance) {
    return distance > width ? kNoObstacle : static_cast<double>(distance) * distance;
  };
  for (std::size_t row = 0; row < rows; ++row) {
    transform_row(is_obstacle.data() + row * columns, width, width + 1, square, squared.data() + row * columns);
  }
  // Columns are copied in blocks of a cache line, because a step from row to row leaves the cache.
  constexpr std::size_t kBlock = 8;
  std::vector<double> block(kBlock * rows);
  LowerEnvelope envelope(rows);
  for (std::size_t first = 0; first < columns; first += kBlock) {
    const std::size_t num_columns = std::min(kBlock, columns - first);
    for (std::size_t row = 0; row < rows; ++row)
      for (std::size_t i = 0; i < num_columns; ++i) block[i * rows + row] = squared[row * columns + first + i];
    for (std::size_t i = 0; i < num_columns; ++i) envelope.apply(block.data() + i * rows);
    for (std::size_t row = 0; row < rows; ++row)
      for (std::size_t i = 0; i < num_columns; ++i) squared[row * columns + first + i] = block[i * rows + row];
  }
  return squared;
}

}  // namespace patrol
