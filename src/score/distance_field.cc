#include "score/distance_field.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace patrol::score {
namespace {

constexpr std::int8_t kOccupiedPercent = 65;
constexpr float kFar = 1e20f;

/// One-dimensional pass of the exact squared distance transform: lower envelope of parabolas [Felzenszwalb12].
class LineTransform {
 public:
  explicit LineTransform(std::size_t length) : vertex_(length), boundary_(length + 1) {}

  /// Replaces `line[i]` by the minimum over j of line[j] + (i - j)^2.
  void apply(std::vector<float>& line) {
    std::size_t last = 0;
    vertex_[0] = 0;
    boundary_[0] = -kInfinity;
    boundary_[1] = kInfinity;
    for (std::size_t q = 1; q < line.size(); ++q) {
      double meet = intersection(line, vertex_[last], q);
      while (meet <= boundary_[last]) meet = intersection(line, vertex_[--last], q);
      vertex_[++last] = q;
      boundary_[last] = meet;
      boundary_[last + 1] = kInfinity;
    }
    input_ = line;
    for (std::size_t q = 0, k = 0; q < line.size(); ++q) {
      while (boundary_[k + 1] < static_cast<double>(q)) ++k;
      const auto step = static_cast<double>(q) - static_cast<double>(vertex_[k]);
      line[q] = static_cast<float>(step * step + input_[vertex_[k]]);
    }
  }

 private:
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();

  static double intersection(const std::vector<float>& line, std::size_t p, std::size_t q) {
    const auto x_p = static_cast<double>(p), x_q = static_cast<double>(q);
    return ((line[q] + x_q * x_q) - (line[p] + x_p * x_p)) / (2.0 * (x_q - x_p));
  }

  std::vector<std::size_t> vertex_;
  std::vector<double> boundary_;
  std::vector<float> input_;
};

}  // namespace

DistanceField::DistanceField(const Grid<std::uint8_t>& occupied)
    : geometry_(occupied.geometry()),
      distance_m_(geometry_.size()),
      is_empty_(std::all_of(occupied.values().begin(), occupied.values().end(), [](auto value) { return value == 0; })) {
  const auto width = static_cast<std::size_t>(geometry_.width), height = static_cast<std::size_t>(geometry_.height);
  std::transform(occupied.values().begin(), occupied.values().end(), distance_m_.begin(),
                 [](std::uint8_t is_occupied) { return is_occupied != 0 ? 0.0f : kFar; });
  std::vector<float> line(height);
  LineTransform column_transform(height), row_transform(width);
  for (std::size_t col = 0; col < width; ++col) {
    for (std::size_t row = 0; row < height; ++row) line[row] = distance_m_[row * width + col];
    column_transform.apply(line);
    for (std::size_t row = 0; row < height; ++row) distance_m_[row * width + col] = line[row];
  }
  line.resize(width);
  const auto resolution_m = static_cast<float>(geometry_.resolution_m);
  for (std::size_t row = 0; row < height; ++row) {
    const auto begin = distance_m_.begin() + static_cast<std::ptrdiff_t>(row * width);
    std::copy_n(begin, width, line.begin());
    row_transform.apply(line);
    std::transform(line.begin(), line.end(), begin,
                   [resolution_m](float squared_cells) { return resolution_m * std::sqrt(squared_cells); });
  }
}

DistanceField::Place DistanceField::place_of(const Eigen::Vector2d& p_m) const {
  const Eigen::Vector2d last(geometry_.width - 1, geometry_.height - 1);
  const Eigen::Vector2d q = (p_m - geometry_.origin_m) / geometry_.resolution_m - Eigen::Vector2d(0.5, 0.5);
  const Eigen::Vector2d inside = q.cwiseMax(0.0).cwiseMin(last);
  const auto col = std::min(static_cast<std::size_t>(inside.x()), static_cast<std::size_t>(std::max(0, geometry_.width - 2)));
  const auto row = std::min(static_cast<std::size_t>(inside.y()), static_cast<std::size_t>(std::max(0, geometry_.height - 2)));
  const auto width = static_cast<std::size_t>(geometry_.width);
  const std::size_t right = geometry_.width > 1 ? 1 : 0, up = geometry_.height > 1 ? width : 0;
  const std::size_t at = row * width + col;
  return {.corners = {distance_m_[at], distance_m_[at + right], distance_m_[at + up], distance_m_[at + up + right]},
          .fraction = inside - Eigen::Vector2d(static_cast<double>(col), static_cast<double>(row)),
          .way_to_grid = q - inside};
}

double DistanceField::distance_m(const Eigen::Vector2d& p_m) const {
  if (is_empty_) return std::numeric_limits<double>::infinity();
  const auto [corners, f, way_to_grid] = place_of(p_m);
  const double low = (1.0 - f.x()) * corners[0] + f.x() * corners[1];
  const double high = (1.0 - f.x()) * corners[2] + f.x() * corners[3];
  return (1.0 - f.y()) * low + f.y() * high + geometry_.resolution_m * way_to_grid.norm();
}

// Derivative of the bilinear piece itself: a finite difference would be too small within one step of an occupied cell,
// where the distance has a kink.
Eigen::Vector2d DistanceField::gradient(const Eigen::Vector2d& p_m) const {
  if (is_empty_) return Eigen::Vector2d::Zero();
  const auto [corners, f, way_to_grid] = place_of(p_m);
  const Eigen::Vector2d rise((1.0 - f.y()) * (corners[1] - corners[0]) + f.y() * (corners[3] - corners[2]),
                             (1.0 - f.x()) * (corners[2] - corners[0]) + f.x() * (corners[3] - corners[1]));
  const Eigen::Vector2d is_inside = (way_to_grid.array() == 0.0).cast<double>();
  return rise.cwiseProduct(is_inside) / geometry_.resolution_m + way_to_grid.stableNormalized();
}

Grid<std::uint8_t> occupied_cells(const OccupancyGrid& map) {
  Grid<std::uint8_t> occupied(map.geometry());
  std::transform(map.values().begin(), map.values().end(), occupied.values().begin(),
                 [](std::int8_t percent) { return static_cast<std::uint8_t>(percent >= kOccupiedPercent); });
  return occupied;
}

}  // namespace patrol::score
