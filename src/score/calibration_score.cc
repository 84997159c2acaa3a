#include "score/calibration_score.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include "core/geometry/angles.h"
#include "core/geometry/linear_algebra.h"

namespace patrol::score {
namespace {

constexpr double kSegment_m = 1.0, kSegment_rad = 0.5, kSegment_s = 10.0;
constexpr double kTurnStep_s = 0.2;  // interval of the motion that shows the center of rotation
constexpr double kTurnCorrelation_rad = 2.0;
constexpr double kMinTurn_rad2 = 0.05;  // minimum weighted sum of squared rotations that gives a center
constexpr double kQuantile95 = 1.959964;
constexpr double kMinDeterminant = 1e-6;  ///< minimum determinant of the normal equations scaled to a diagonal of 1

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

/// Weighted normal equations of the center of rotation: forward = ticks k + rotation y, left = -rotation x.
struct TurnCenterFit {
  Eigen::Matrix2d A = Eigen::Matrix2d::Zero();
  Eigen::Vector2d b = Eigen::Vector2d::Zero();
  double left_rad_m = 0.0, rad2 = 0.0;

  void fade(double turn_rad) {
    const double factor = std::exp(-turn_rad / kTurnCorrelation_rad);
    A *= factor, b *= factor, left_rad_m *= factor, rad2 *= factor;
  }
  void add(const Pose2& moved, double ticks) {
    const Eigen::Vector2d along = Eigen::Rotation2Dd(-0.5 * moved.yaw) * moved.position();
    const Eigen::Vector2d row(ticks, moved.yaw);
    A += row * row.transpose();
    b += row * along.x();
    left_rad_m += moved.yaw * along.y();
    rad2 += moved.yaw * moved.yaw;
  }
};

/// Fits the center of rotation of a tracked robot up to an instant; none if it has not turned.
std::optional<Eigen::Vector2d> turn_center(const CalibrationRecord& record, Time until) {
  TurnCenterFit fit;
  const TrackReading* from = nullptr;
  for (const TrackReading& to : record.tracks) {
    if (to.stamp > until) break;
    if (from && to_seconds(to.stamp - from->stamp) < kTurnStep_s) continue;
    const TrackReading* const begin = std::exchange(from, &to);
    if (!begin || is_crossed(record.kidnaps, begin->stamp, to.stamp)) continue;
    const std::optional<Pose3> T_world_from = pose_at(record.T_world_body, begin->stamp);
    const std::optional<Pose3> T_world_to = pose_at(record.T_world_body, to.stamp);
    if (!T_world_from || !T_world_to) continue;
    const Pose2 moved = motion(*T_world_from, *T_world_to);
    fit.fade(std::abs(moved.yaw));
    fit.add(moved, 0.5 * (to.left - begin->left + to.right - begin->right));
  }
  if (fit.rad2 < kMinTurn_rad2 || !(fit.A.determinant() > kMinDeterminant * fit.A(0, 0) * fit.A(1, 1)))
    return std::nullopt;
  return Eigen::Vector2d(-fit.left_rad_m / fit.rad2, solve_symmetric(fit.A, fit.b)[1]);
}

/// Value of a name; none if it is missing.
std::optional<double> value_of(const std::vector<std::pair<std::string, double>>& values, std::string_view name) {
  const auto found = std::ranges::find(values, name, [](const auto& entry) { return std::string_view(entry.first); });
  if (found == values.end()) return std::nullopt;
  return found->second;
}

/// Yaw of the lidar about the vertical of the body; the angles of `as_built` are about the axes of its nominal mount.
std::optional<double> lidar_yaw_rad(const AsBuiltTruth& as_built, const Eigen::Quaterniond& R_body_lidar) {
  const std::optional<double> yaw_rad = value_of(as_built.values, name_of(CalibrationParameter::kLidarYaw));
  if (!yaw_rad) return std::nullopt;
  const Eigen::Vector3d angles_rad(value_of(as_built.values, "lidar.roll_rad").value_or(0.0),
                                   value_of(as_built.values, "lidar.pitch_rad").value_or(0.0), *yaw_rad);
  return (R_body_lidar * angles_rad).z();
}

/// True values of a record, without those that it does not determine.
class TrueValues {
 public:
  explicit TrueValues(const CalibrationRecord& record) : record_(record) {}

  const std::vector<TrueParameter>& values() const { return values_; }

  void add_lidar(const CalibrationReferences& references, Time stamp) {
    const std::optional<double> offset_s = drawn(name_of(kLidarTimeOffset)), drift = drawn(name_of(kLidarClockDrift));
    if (offset_s && drift) {
      const double fault_s = references.lidar_clock_fault_s ? references.lidar_clock_fault_s(stamp) : 0.0;
      add(kLidarTimeOffset, *offset_s + *drift * to_seconds(stamp) + fault_s);
    }
    add(kLidarClockDrift, drift);
    add(kLidarYaw, lidar_yaw_rad(record_.as_built, references.R_body_lidar));
  }

  void add_uwb() {
    for (const auto& [name, value] : record_.as_built.values)
      if (name.starts_with("uwb.")) values_.push_back({.name = name, .value = value, .drawn = std::nullopt});
  }

  /// Adds the scales of odometry, and bias and scale of the gyro about z, fitted to the true motion.
  void add_fits(const Eigen::Quaterniond& R_body_imu) {
    const GyroYaw gyro(record_, R_body_imu);
    double odom_m2 = 0.0, along_m2 = 0.0, odom_rad2 = 0.0, along_rad2 = 0.0;
    Eigen::Matrix2d A = Eigen::Matrix2d::Zero();
    Eigen::Vector2d b = Eigen::Vector2d::Zero();
    for (const Segment& segment : segments_of(record_)) {
      odom_m2 += segment.T_from_to_odom.position().squaredNorm();
      along_m2 += segment.T_from_to_odom.position().dot(segment.T_from_to_true.position());
      odom_rad2 += segment.T_from_to_odom.yaw * segment.T_from_to_odom.yaw;
      along_rad2 += segment.T_from_to_odom.yaw * segment.T_from_to_true.yaw;
      const Time from = record_.T_odom_body[segment.from].stamp, to = record_.T_odom_body[segment.to].stamp;
      const std::optional<double> from_rad = gyro.at(from), to_rad = gyro.at(to);
      if (!from_rad || !to_rad) continue;
      const Eigen::Vector2d row(-to_seconds(to - from), *to_rad - *from_rad);
      A += row * row.transpose();
      b += row * wrap_angle(segment.T_from_to_true.yaw - row[1]);
    }
    const std::optional<double> left = drawn("tracks.left_sprocket_scale"),
                                right = drawn("tracks.right_sprocket_scale");
    add(kOdometryDistanceScale, along_m2 / odom_m2, 0.0,
        left && right ? std::optional(0.5 * (*left + *right)) : std::nullopt);
    add(kOdometryRotationScale, along_rad2 / odom_rad2);
    if (!(A.determinant() > kMinDeterminant * A(0, 0) * A(1, 1))) return;
    const Eigen::Vector2d fit = solve_symmetric(A, b);
    add(kGyroZBias, fit[0]);
    add(kGyroZScale, 1.0 + fit[1]);
  }

  /// Adds the biases of the other axes: at power-on, by warming, by gravity on level ground.
  void add_biases(Time stamp) {
    const double gyro_walk = drawn("imu.gyro_bias_walk_radps_per_sqrt_s").value_or(0.0);
    const double accel_walk = drawn("imu.accel_bias_walk_mps2_per_sqrt_s").value_or(0.0);
    add_bias(kGyroXBias, "imu.gyro_x", "radps", gyro_walk, stamp);
    add_bias(kGyroYBias, "imu.gyro_y", "radps", gyro_walk, stamp);
    add_bias(kAccelXBias, "imu.accel_x", "mps2", accel_walk, stamp);
    add_bias(kAccelYBias, "imu.accel_y", "mps2", accel_walk, stamp);
    add_bias(kAccelZBias, "imu.accel_z", "mps2", accel_walk, stamp);
  }

  void add_turn_center(Time stamp) {
    const std::optional<Eigen::Vector2d> center = turn_center(record_, stamp);
    if (!center) return;
    add(kTurnCenterX, center->x());
    add(kTurnCenterY, center->y());
  }

 private:
  using enum CalibrationParameter;

  std::optional<double> drawn(std::string_view name) const { return value_of(record_.as_built.values, name); }

  void add(CalibrationParameter parameter, std::optional<double> value, double std = 0.0,
           std::optional<double> related = std::nullopt) {
    if (value && std::isfinite(*value))
      values_.push_back({.name = std::string(name_of(parameter)), .value = *value, .std = std, .drawn = related});
  }

  void add_bias(CalibrationParameter parameter, const std::string& axis, const char* unit, double walk, Time stamp) {
    const std::optional<double> turn_on = drawn(name_of(parameter));
    const std::optional<double> warm = drawn(axis + "_warming_" + unit);
    if (!turn_on || !warm) return;
    const double elapsed_s = std::max(0.0, to_seconds(stamp));
    const double warming = 1.0 - std::exp(-elapsed_s / drawn("imu.warming_time_s").value_or(1.0));
    const double by_gravity = drawn(axis + "_by_gravity_" + unit).value_or(0.0);
    add(parameter, *turn_on + warming * *warm + by_gravity, walk * std::sqrt(elapsed_s));
  }

  const CalibrationRecord& record_;
  std::vector<TrueParameter> values_;
};

}  // namespace

bool ScoredParameter::holds() const { return std::abs(error()) <= kQuantile95 * std::hypot(std, truth_std); }

std::vector<TrueParameter> calibration_truth(const CalibrationRecord& record, const CalibrationReferences& references,
                                             Time stamp) {
  TrueValues truth(record);
  truth.add_lidar(references, stamp);
  truth.add_uwb();
  truth.add_fits(references.R_body_imu);
  truth.add_biases(stamp);
  truth.add_turn_center(stamp);
  return truth.values();
}

std::vector<ScoredParameter> calibration_score(const CalibrationEstimate& estimate,
                                               const std::vector<TrueParameter>& truth) {
  std::vector<ScoredParameter> scored;
  for (const CalibrationValue& entry : estimate.values) {
    const auto found = std::ranges::find(truth, entry.name, &TrueParameter::name);
    if (found == truth.end()) continue;
    scored.push_back({.name = entry.name,
                      .value = entry.value,
                      .std = entry.std,
                      .truth = found->value,
                      .truth_std = found->std,
                      .drawn = found->drawn});
  }
  return scored;
}

}  // namespace patrol::score
