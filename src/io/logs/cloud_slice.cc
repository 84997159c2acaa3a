#include "io/logs/cloud_slice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include "core/geometry/angles.h"

namespace patrol::io {
namespace {

constexpr double kTurn_rad = 2.0 * std::numbers::pi;

/// Rotation of a spinning lidar during one cloud.
struct Rotation {
  double start_rad;   ///< azimuth of the earliest points
  double rate_radps;  ///< positive: counterclockwise
};

/// Returns the rotation from the mean azimuths of 36 parts of the time; nullopt unless the points of each part are seen
/// in about one direction, and nearly all parts follow each other one way, for between half a turn and one turn.
std::optional<Rotation> rotation_of(const std::vector<Eigen::Vector3d>& points, const PointCloud& cloud) {
  constexpr std::size_t kParts = 36;
  constexpr double kMinConcentration = 0.7;  // of the directions of a part: 1 if all are the same
  float duration_s = 0.0F;
  for (const CloudPoint& point : cloud.points) duration_s = std::max(duration_s, point.time_s);
  if (!(duration_s > 0.0F)) return std::nullopt;
  std::array<Eigen::Vector2d, kParts> sum;
  sum.fill(Eigen::Vector2d::Zero());
  std::array<double, kParts> count{};
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto part = std::min(static_cast<std::size_t>(cloud.points[i].time_s / duration_s * kParts), kParts - 1);
    sum[part] += points[i].head<2>().normalized();
    count[part] += 1.0;
  }
  double turned_rad = 0.0, turned_abs_rad = 0.0;
  std::optional<double> first_rad, last_rad;
  std::size_t first_part = 0, last_part = 0;
  for (std::size_t part = 0; part < kParts; ++part) {
    if (count[part] == 0.0) continue;
    if (sum[part].norm() < kMinConcentration * count[part]) return std::nullopt;
    const double azimuth_rad = std::atan2(sum[part].y(), sum[part].x());
    if (last_rad) {
      const double step_rad = wrap_angle(azimuth_rad - *last_rad);
      turned_rad += step_rad;
      turned_abs_rad += std::abs(step_rad);
    } else {
      first_rad = azimuth_rad;
      first_part = part;
    }
    last_rad = azimuth_rad;
    last_part = part;
  }
  const bool is_one_way = std::abs(turned_rad) > 0.9 * turned_abs_rad;
  const bool is_about_a_turn = std::abs(turned_rad) > 0.5 * kTurn_rad && std::abs(turned_rad) < 1.1 * kTurn_rad;
  if (!is_one_way || !is_about_a_turn) return std::nullopt;
  const double part_s = static_cast<double>(duration_s) / kParts;
  const double rate_radps = turned_rad / (part_s * static_cast<double>(last_part - first_part));
  return Rotation{.start_rad = *first_rad - rate_radps * part_s * (static_cast<double>(first_part) + 0.5),
                  .rate_radps = rate_radps};
}

}  // namespace

LaserScan planar_slice(const PointCloud& cloud, const Eigen::Quaterniond& R_level_lidar,
                       const CloudSliceSettings& settings) {
  std::vector<Eigen::Vector3d> points;
  points.reserve(cloud.points.size());
  for (const CloudPoint& point : cloud.points)
    points.push_back(R_level_lidar * Eigen::Vector3d(point.x, point.y, point.z));
  const std::optional<Rotation> rotation = rotation_of(points, cloud);
  const double beam_rad = kTurn_rad / settings.num_beams;
  LaserScan scan;
  scan.stamp = cloud.stamp;
  scan.angle_min_rad = rotation ? wrap_angle(rotation->start_rad) : -std::numbers::pi;
  scan.angle_increment_rad = rotation && rotation->rate_radps < 0.0 ? -beam_rad : beam_rad;
  scan.time_increment_s = rotation ? beam_rad / std::abs(rotation->rate_radps) : 0.0;
  scan.scan_time_s = scan.time_increment_s * settings.num_beams;
  scan.range_min_m = 0.0;
  scan.range_max_m = 0.0;  // unknown
  scan.ranges_m.assign(static_cast<std::size_t>(settings.num_beams), std::numeric_limits<float>::quiet_NaN());
  for (const Eigen::Vector3d& point : points) {
    if (point.z() < settings.min_height_m || point.z() > settings.max_height_m) continue;
    const auto distance_m = static_cast<float>(point.head<2>().norm());
    if (!(distance_m > 0.0F)) continue;
    const double turned = (std::atan2(point.y(), point.x()) - scan.angle_min_rad) / scan.angle_increment_rad;
    const long beam = std::lround(turned) % settings.num_beams;
    float& range_m = scan.ranges_m[static_cast<std::size_t>(beam < 0 ? beam + settings.num_beams : beam)];
    if (!(range_m <= distance_m)) range_m = distance_m;  // also if it is NaN
  }
  return scan;
}

}  // namespace patrol::io
