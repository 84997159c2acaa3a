#include "slam/match_points.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace patrol::slam {
namespace {

std::vector<MatchPoint> average_neighbors(const LevelScan& scan, double spacing_m) {
  std::vector<MatchPoint> points;
  Eigen::Vector2d first = Eigen::Vector2d::Zero(), sum = Eigen::Vector2d::Zero();
  int count = 0;
  const auto close = [&] {
    if (count == 0) return;
    const Eigen::Vector2d mean = sum / count;
    points.push_back({mean, (mean - scan.origin_m).norm()});
    count = 0;
  };
  for (const LevelScan::Beam& beam : scan.beams) {
    if (!beam.is_hit) continue;
    const Eigen::Vector2d end = beam.end_m.cast<double>();
    if (!end.allFinite()) continue;
    if (count > 0 && (end - first).squaredNorm() > spacing_m * spacing_m) close();
    if (count == 0) first = end, sum.setZero();
    sum += end;
    ++count;
  }
  close();
  return points;
}

}  // namespace

std::vector<MatchPoint> downsample_scan(const LevelScan& scan, double spacing_m, int max_points) {
  std::vector<MatchPoint> points = average_neighbors(scan, spacing_m);
  const auto limit = static_cast<std::size_t>(max_points);
  if (points.size() <= limit) return points;
  std::vector<MatchPoint> chosen;
  chosen.reserve(limit);
  for (std::size_t i = 0; i < limit; ++i) chosen.push_back(points[i * points.size() / limit]);
  return chosen;
}

std::vector<Eigen::Vector2d> positions_of(const std::vector<MatchPoint>& points, int max_points) {
  const std::size_t count = std::min(points.size(), static_cast<std::size_t>(max_points));
  std::vector<Eigen::Vector2d> positions;
  positions.reserve(count);
  for (std::size_t i = 0; i < count; ++i) positions.push_back(points[i * points.size() / count].p_body);
  return positions;
}

}  // namespace patrol::slam
