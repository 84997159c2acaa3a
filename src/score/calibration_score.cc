#include "score/calibration_score.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>

#include "core/geometry/angles.h"
#include "core/geometry/linear_algebra.h"

namespace patrol::score {
namespace {

constexpr double kSegment_m = 1.0, kSegment_rad = 0.5, kSegment_s = 10.0;
constexpr double kQuantile95 = 1.959964;
constexpr double kMinDeterminant = 1e-6;  ///< of the normal equations scaled to a diagonal of 1

/// Motion over a segment by odometry and by ground truth; `from` and `to` are indices of odometry.
struct Segment {
  std::size_t from = 0, to = 0;
  Pose2 T_from_to_odom, T_from_to_true;
};

Pose2 motion(const Pose3& from, const Pose3& to) { return to_pose2(from).inverse() * to_pose2(to); }

bool is_crossed(const std::vector<Time>& kidnaps, Time begin, Time end) {
  return std::ranges::any_of(kidnaps, [&](Time kidnap) { return kidnap >= begin && kidnap <= end; });
}

std::vector<Segment> segments_of(const CalibrationRecord& record) {
  std::vector<Segment> segments;
  const Trajectory& odometry = record.T_odom_body;
  std::size_t from = 0;
  for (std::size_t to = 1; to < odometry.size(); ++to) {
    const Pose2 moved = motion(odometry[from].pose, odometry[to].pose);
    if (moved.position().norm() < kSegment_m && std::abs(moved.yaw) < kSegment_rad &&
        to_seconds(odometry[to].stamp - odometry[from].stamp) < kSegment_s)
      continue;
    const std::optional<Pose3> T_world_from = pose_at(record.T_world_body, odometry[from].stamp);
    const std::optional<Pose3> T_world_to = pose_at(record.T_world_body, odometry[to].stamp);
    if (T_world_from && T_world_to && !is_crossed(record.kidnaps, odometry[from].stamp, odometry[to].stamp))
      segments.push_back({from, to, moved, motion(*T_world_from, *T_world_to)});
    from = to;
  }
  return segments;
}

/// Rate about the vertical by the gyro, integrated from the first reading on.
struct GyroYaw {
  std::vector<Time> stamps;
  std::vector<double> yaws_rad;

  GyroYaw(const CalibrationRecord& record, const Eigen::Quaterniond& R_body_imu) {
    double last_radps = 0.0;
    for (const GyroReading& reading : record.gyro) {
      const std::optional<Pose3> T_world_body = pose_at(record.T_world_body, reading.stamp);
      if (!T_world_body) continue;
      const double rate_radps = (T_world_body->rotation * (R_body_imu * reading.angular_velocity_radps)).z();
      yaws_rad.push_back(stamps.empty() ? 0.0
                                        : yaws_rad.back() + 0.5 * (last_radps + rate_radps) *
                                                                to_seconds(reading.stamp - stamps.back()));
      stamps.push_back(reading.stamp);
      last_radps = rate_radps;
    }
  }

  /// Returns the integral at the first reading not before a stamp.
  std::optional<double> at(Time stamp) const {
    const auto found = std::ranges::lower_bound(stamps, stamp);
    if (found == stamps.end()) return std::nullopt;
    return yaws_rad[static_cast<std::size_t>(found - stamps.begin())];
  }
};

/// Value of a name; none if it is missing.
std::optional<double> value_of(const std::vector<std::pair<std::string, double>>& values, std::string_view name) {
  const auto found = std::ranges::find(values, name, [](const auto& entry) { return std::string_view(entry.first); });
  if (found == values.end()) return std::nullopt;
  return found->second;
}

}  // namespace

bool ScoredParameter::holds() const { return std::abs(error()) <= kQuantile95 * std; }

std::vector<std::pair<std::string, double>> calibration_truth(const CalibrationRecord& record,
                                                              const CalibrationReferences& references, Time stamp) {
  using enum CalibrationParameter;
  std::vector<std::pair<std::string, double>> truth;
  const auto add = [&](CalibrationParameter parameter, std::optional<double> value) {
    if (value && std::isfinite(*value)) truth.emplace_back(name_of(parameter), *value);
  };
  const std::optional<double> offset_s = value_of(record.as_built.values, name_of(kLidarTimeOffset));
  const std::optional<double> drift = value_of(record.as_built.values, name_of(kLidarClockDrift));
  if (offset_s && drift) {
    const double fault_s = references.lidar_clock_fault_s ? references.lidar_clock_fault_s(stamp) : 0.0;
    add(kLidarTimeOffset, *offset_s + *drift * to_seconds(stamp) + fault_s);
  }
  add(kLidarClockDrift, drift);
  add(kLidarYaw, value_of(record.as_built.values, name_of(kLidarYaw)));
  for (const auto& [name, value] : record.as_built.values)
    if (name.starts_with("uwb.")) truth.emplace_back(name, value);

  const GyroYaw gyro(record, references.R_body_imu);
  double odom_m2 = 0.0, along_m2 = 0.0, odom_rad2 = 0.0, along_rad2 = 0.0;
  Eigen::Matrix2d A = Eigen::Matrix2d::Zero();
  Eigen::Vector2d b = Eigen::Vector2d::Zero();
  for (const Segment& segment : segments_of(record)) {
    odom_m2 += segment.T_from_to_odom.position().squaredNorm();
    along_m2 += segment.T_from_to_odom.position().dot(segment.T_from_to_true.position());
    odom_rad2 += segment.T_from_to_odom.yaw * segment.T_from_to_odom.yaw;
    along_rad2 += segment.T_from_to_odom.yaw * segment.T_from_to_true.yaw;
    const Time from = record.T_odom_body[segment.from].stamp, to = record.T_odom_body[segment.to].stamp;
    const std::optional<double> from_rad = gyro.at(from), to_rad = gyro.at(to);
    if (!from_rad || !to_rad) continue;
    const Eigen::Vector2d row(-to_seconds(to - from), *to_rad - *from_rad);
    A += row * row.transpose();
    b += row * wrap_angle(segment.T_from_to_true.yaw - row[1]);
  }
  add(kOdometryDistanceScale, along_m2 / odom_m2);
  add(kOdometryRotationScale, along_rad2 / odom_rad2);
  if (A.determinant() > kMinDeterminant * A(0, 0) * A(1, 1)) {
    const Eigen::Vector2d fit = solve_symmetric(A, b);
    add(kGyroZBias, fit[0]);
    add(kGyroZScale, 1.0 + fit[1]);
  }
  return truth;
}

std::vector<ScoredParameter> calibration_score(const CalibrationEstimate& estimate,
                                               const std::vector<std::pair<std::string, double>>& truth) {
  std::vector<ScoredParameter> scored;
  for (const CalibrationValue& entry : estimate.values) {
    if (const std::optional<double> value = value_of(truth, entry.name))
      scored.push_back({.name = entry.name, .value = entry.value, .std = entry.std, .truth = *value});
  }
  return scored;
}

}  // namespace patrol::score
