#include "localize/scan_leveler.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <utility>

namespace patrol::localize {
namespace {

constexpr std::size_t kNumKnots = 33;  // poses over a scan; the lidar pose is interpolated linearly between them

/// Lidar pose as a matrix, which is interpolated linearly: the error over 3 ms at 1 rad/s is 1e-6.
struct Knot {
  Eigen::Matrix3d R;
  Eigen::Vector3d p;
};

/// Returns the pose with its xy plane level. A lidar that is upside down stays so.
Pose3 with_level_plane(const Pose3& T_level_lidar) {
  const bool is_upside_down = (T_level_lidar.rotation * Eigen::Vector3d::UnitZ()).z() < 0.0;
  const Pose3 level = remove_tilt(T_level_lidar);
  return is_upside_down ? level * Pose3{Eigen::Vector3d::Zero(), quaternion_from_rpy(std::numbers::pi, 0.0, 0.0)}
                        : level;
}

Time beam_time(const LaserScan& scan, double beam) { return scan.stamp + from_seconds(beam * scan.time_increment_s); }

}  // namespace

ScanLeveler::ScanLeveler(Pose3 T_body_lidar, const ScanLevelerSettings& settings)
    : T_body_lidar_(std::move(T_body_lidar)), settings_(settings) {
  validate(settings, "scan_leveling");
}

std::optional<LevelScan> ScanLeveler::level(const LaserScan& scan, const LeggedOdometry& odometry) const {
  return level(
      scan, [&odometry](Time stamp) { return odometry.T_odom_body_at(stamp); }, odometry.height_above_ground_m());
}

std::optional<LevelScan> ScanLeveler::level(const LaserScan& scan, const PoseLookup& T_odom_body_at,
                                            double body_height_m) const {
  const std::size_t num_beams = scan.ranges_m.size();
  if (num_beams == 0) return std::nullopt;
  const auto last_beam = static_cast<double>(num_beams - 1);
  const std::optional<Pose3> T_odom_body = T_odom_body_at(beam_time(scan, last_beam));
  if (!T_odom_body) return std::nullopt;
  const Pose3 T_level_odom = Pose3{T_odom_body->position, quaternion_from_yaw(to_yaw(T_odom_body->rotation))}.inverse();

  const auto mounted = [this](const Pose3& T_level_lidar) {
    return settings_.gimbal_stabilized ? with_level_plane(T_level_lidar) : T_level_lidar;
  };
  const std::size_t num_segments = std::min(kNumKnots - 1, num_beams);
  const auto knot_at = [&](std::size_t beam) -> std::optional<Knot> {
    const std::optional<Pose3> T = T_odom_body_at(beam_time(scan, static_cast<double>(beam)));
    if (!T) return std::nullopt;
    const Pose3 T_level_lidar = mounted(T_level_odom * *T * T_body_lidar_);
    return Knot{T_level_lidar.rotation.toRotationMatrix(), T_level_lidar.position};
  };

  LevelScan level;
  level.stamp = beam_time(scan, last_beam);
  const Pose3 T_level_lidar = mounted(T_level_odom * *T_odom_body * T_body_lidar_);
  level.origin_m = T_level_lidar.position.head<2>();
  level.tilt_rad = std::acos(std::min(std::abs(T_level_lidar.rotation.toRotationMatrix()(2, 2)), 1.0));
  level.beams.reserve(num_beams);
  const std::complex<double> step = std::polar(1.0, scan.angle_increment_rad);
  std::optional<Knot> before = knot_at(0);
  for (std::size_t segment = 0; segment < num_segments; ++segment) {
    const std::size_t first = segment * (num_beams - 1) / num_segments,
                      next = (segment + 1) * (num_beams - 1) / num_segments;
    const std::optional<Knot> after = knot_at(next);
    if (!before || !after) return std::nullopt;
    const std::size_t end = segment + 1 == num_segments ? num_beams : next;
    std::complex<double> azimuth =
        std::polar(1.0, scan.angle_min_rad + static_cast<double>(first) * scan.angle_increment_rad);
    for (std::size_t beam = first; beam < end; ++beam, azimuth *= step) {
      const double fraction =
          next > first ? static_cast<double>(beam - first) / static_cast<double>(next - first) : 0.0;
      const Eigen::Vector3d from_before = before->R.col(0) * azimuth.real() + before->R.col(1) * azimuth.imag();
      const Eigen::Vector3d from_after = after->R.col(0) * azimuth.real() + after->R.col(1) * azimuth.imag();
      const Ray ray{before->p + fraction * (after->p - before->p), from_before + fraction * (from_after - from_before)};
      add_beam(ray, scan.ranges_m[beam], body_height_m, level);
    }
    before = after;
  }
  return level;
}

void ScanLeveler::add_beam(const Ray& ray, float range_m, double body_height_m, LevelScan& level) const {
  if (std::isnan(range_m) || range_m < 0.0F) return;  // invalid, or -Inf: too close to measure
  const bool has_return = std::isfinite(range_m);
  const double in_band_m = length_in_band(ray, body_height_m);
  const double range = has_return ? static_cast<double>(range_m) : settings_.no_return_clearing_range_m;
  const bool is_hit = has_return && range <= in_band_m;
  if (is_hit && range > settings_.max_range_m) return;
  const Eigen::Vector2d end = (ray.start + std::min(range, in_band_m) * ray.direction).head<2>();
  if (end.squaredNorm() < settings_.self_filter_radius_m * settings_.self_filter_radius_m) return;
  level.beams.push_back({end.cast<float>(), is_hit});
}

double ScanLeveler::length_in_band(const Ray& ray, double body_height_m) const {
  const double height_m = body_height_m + ray.start.z();
  const double rise = ray.direction.z();
  // The lower edge of the band rises with the distance s, as min + margin s; the beam height is height + rise s.
  const double sink = settings_.tilt_margin_rad - rise;
  const double until_low =
      sink > 0.0 ? (height_m - settings_.min_height_m) / sink : std::numeric_limits<double>::infinity();
  const double until_high =
      rise > 0.0 ? (settings_.max_height_m - height_m) / rise : std::numeric_limits<double>::infinity();
  return std::max(0.0, std::min(until_low, until_high));
}

}  // namespace patrol::localize
