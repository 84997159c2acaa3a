#include "score/distance_field.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace patrol::score {
namespace {

constexpr std::int8_t kOccupiedPercent = 65;
constexpr float kFar = 1e20f;

/// One line of the exact squared distance transform: the lower envelope of parabolas (Felzenszwalb & Huttenlocher 2012).
class LineTransform {
 public:
  explicit LineTransform(std::size_t length) : vertex_(length), boundary_(length + 1) {}

  /// `line[i]` becomes min over j of line[j] + (i - j)^2.
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
    : geometry_(occupied.geometry()), distance_m_(geometry_.size()) {
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
    std::transform(line.begin(), line.end(), begin, [resolution_m](float squared_cells) {
      return squared_cells < kFar / 2 ? resolution_m * std::sqrt(squared_cells)
                                      : std::numeric_limits<float>::infinity();
    });
  }
}

double DistanceField::distance_m(const Eigen::Vector2d& p_m) const {
  if (distance_m_.empty()) return std::numeric_limits<double>::infinity();
  const Eigen::Vector2d last(geometry_.width - 1, geometry_.height - 1);
  const Eigen::Vector2d q = (p_m - geometry_.origin_m) / geometry_.resolution_m - Eigen::Vector2d(0.5, 0.5);
  const Eigen::Vector2d inside = q.cwiseMax(0.0).cwiseMin(last);
  const auto col = std::min(static_cast<std::size_t>(inside.x()), static_cast<std::size_t>(std::max(0, geometry_.width - 2)));
  const auto row = std::min(static_cast<std::size_t>(inside.y()), static_cast<std::size_t>(std::max(0, geometry_.height - 2)));
  const auto width = static_cast<std::size_t>(geometry_.width);
  const std::size_t right = geometry_.width > 1 ? 1 : 0, up = geometry_.height > 1 ? width : 0;
  const std::size_t at = row * width + col;
  const double fx = inside.x() - static_cast<double>(col), fy = inside.y() - static_cast<double>(row);
  const double low = (1.0 - fx) * distance_m_[at] + fx * distance_m_[at + right];
  const double high = (1.0 - fx) * distance_m_[at + up] + fx * distance_m_[at + up + right];
  return (1.0 - fy) * low + fy * high + geometry_.resolution_m * (q - inside).norm();
}

Eigen::Vector2d DistanceField::gradient(const Eigen::Vector2d& p_m) const {
  const double h = 0.5 * geometry_.resolution_m;
  const Eigen::Vector2d dx(h, 0.0), dy(0.0, h);
  return Eigen::Vector2d(distance_m(p_m + dx) - distance_m(p_m - dx), distance_m(p_m + dy) - distance_m(p_m - dy)) /
         (2.0 * h);
}

Grid<std::uint8_t> occupied_cells(const OccupancyGrid& map) {
  Grid<std::uint8_t> occupied(map.geometry());
  std::transform(map.values().begin(), map.values().end(), occupied.values().begin(),
                 [](std::int8_t percent) { return static_cast<std::uint8_t>(percent >= kOccupiedPercent); });
  return occupied;
}

}  // namespace patrol::score
