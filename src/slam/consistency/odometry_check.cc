#include "slam/consistency/odometry_check.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/upper_median.h"
#include "slam/calibration/calibrate.h"
#include "slam/rigid_motion.h"

namespace patrol::slam {
namespace {

constexpr double kOdometrySegment_m = 0.5, kOdometrySegmentRad = 0.35;
/// Steps of a segment are at least this long.
constexpr double kStep_m = 0.1, kStepRad = 0.1;
constexpr double kJump_m = 0.3, kJumpRad = 0.3;
/// Odometry is constant if it moves by less than this fraction of the segment.
constexpr double kConstantRatio = 0.1;
/// Opposite motions of at least this fraction of a segment are reversed.
constexpr double kReversedRatio = 0.4;
constexpr double kSlipRatio = 0.5;
/// Standard deviations of the motion of a segment by the map.
constexpr double kMapStd_m = 0.01, kMapStdRad = 0.005;
constexpr std::size_t kMaxCalibrated = 600;     ///< segments
constexpr int kMaxDelay = 3, kDelaySteps = 10;  ///< scans; steps per scan
/// Maximum ratio of the differences of the yaw changes with a delay to those without.
constexpr double kDelayGain = 0.7;
constexpr double kMaxTurnDifferenceRad = 0.1;  ///< maximum difference per scan; larger ones count as this
constexpr double kMinGap_s = 1.0, kGapRatio = 5.0;

/// Largest of distance and turn, in units of a segment.
double size_of(const Pose2& motion) {
  return std::max(motion.position().norm() / kOdometrySegment_m, std::abs(motion.yaw) / kOdometrySegmentRad);
}

bool are_opposite(double a, double b, double unit) {
  return a * b < 0.0 && std::min(std::abs(a), std::abs(b)) > kReversedRatio * unit;
}

/// Whether a step of odometry is larger than twice that of the map by more than `limit`.
bool exceeds(double odometry, double map, double limit) { return std::abs(odometry) > 2.0 * std::abs(map) + limit; }

struct OdometrySegment {
  std::size_t first_scan = 0, last_scan = 0;
  double distance_m = 0.0;
  MotionSegment motion;  ///< its lidar steps are those of the body by map
  bool has_jump = false;
};

std::vector<OdometrySegment> divide_odometry(const std::vector<Pose2>& T_odom_body,
                                             const std::vector<Pose2>& T_map_body, const std::vector<Time>& stamps) {
  std::vector<OdometrySegment> segments;
  OdometrySegment open;
  std::size_t step_begin = 0;
  for (std::size_t i = 1; i < T_map_body.size(); ++i) {
    const Pose2 odometry = T_odom_body[i - 1].inverse() * T_odom_body[i],
                map = T_map_body[i - 1].inverse() * T_map_body[i];
    open.distance_m += map.position().norm();
    open.has_jump = open.has_jump || exceeds(odometry.position().norm(), map.position().norm(), kJump_m) ||
                    exceeds(odometry.yaw, map.yaw, kJumpRad);
    const Pose2 whole_odometry = T_odom_body[open.first_scan].inverse() * T_odom_body[i],
                whole_map = T_map_body[open.first_scan].inverse() * T_map_body[i],
                step = T_map_body[step_begin].inverse() * T_map_body[i];
    const bool is_end = std::max(size_of(whole_odometry), size_of(whole_map)) >= 1.0;
    if (is_end || step.position().norm() > kStep_m || std::abs(step.yaw) > kStepRad) {
      open.motion.lidar_steps.push_back(step);
      step_begin = i;
    }
    if (!is_end) continue;
    open.last_scan = i;
    open.motion.begin = stamps[open.first_scan];
    open.motion.end = stamps[i];
    open.motion.odometry = whole_odometry;
    open.motion.lidar_covariance =
        Eigen::Vector3d(kMapStd_m * kMapStd_m, kMapStd_m * kMapStd_m, kMapStdRad * kMapStdRad).asDiagonal();
    segments.push_back(std::move(open));
    open = {};
    open.first_scan = i;
  }
  return segments;
}

/// Fault that is visible without scales.
std::optional<OdometryFault> obvious_fault(const OdometrySegment& segment) {
  const Pose2 map = segment.motion.lidar(), &odometry = segment.motion.odometry;
  if (segment.has_jump) return OdometryFault::kJumping;
  if (size_of(odometry) < kConstantRatio) return OdometryFault::kConstant;
  const double along = odometry.position().dot(map.position());
  if (are_opposite(std::copysign(odometry.position().norm(), along), map.position().norm(), kOdometrySegment_m) ||
      are_opposite(odometry.yaw, map.yaw, kOdometrySegmentRad))
    return OdometryFault::kReversed;
  return std::nullopt;
}

bool is_slipping(const OdometrySegment& segment, const Calibration& scales) {
  const Pose2 map = segment.motion.lidar(), odometry = corrected_step(segment.motion.odometry, scales);
  const Pose2 difference{odometry.x - map.x, odometry.y - map.y, wrap_angle(odometry.yaw - map.yaw)};
  return size_of(difference) > kSlipRatio * std::max(1.0, size_of(odometry));
}

/// Scales from at most kMaxCalibrated segments; none if there are too few.
std::optional<CalibrationResult> calibrate_on(const std::vector<OdometrySegment>& segments,
                                              const std::vector<std::optional<OdometryFault>>& faults) {
  std::vector<MotionSegment> usable;
  const std::size_t stride = segments.size() / kMaxCalibrated + 1;
  for (std::size_t s = 0; s < segments.size(); s += stride) {
    if (!faults[s]) usable.push_back(segments[s].motion);
  }
  CalibratorSettings settings;
  settings.max_std_lidar_m = settings.max_std_lidar_rad = 0.0;
  if (usable.size() < static_cast<std::size_t>(settings.min_segments)) return std::nullopt;
  return calibrate(usable, {}, settings);
}

std::optional<OdometryScale> to_scale(const CalibratedParameter& parameter) {
  if (!parameter.is_observable) return std::nullopt;
  return OdometryScale{.value = parameter.value, .std = parameter.std};
}

/// Yaw without wrapping, [scan].
std::vector<double> unwrapped_yaw(const std::vector<Pose2>& poses) {
  std::vector<double> yaw;
  for (const Pose2& pose : poses)
    yaw.push_back(yaw.empty() ? pose.yaw : yaw.back() + wrap_angle(pose.yaw - yaw.back()));
  return yaw;
}

/// Sum of the differences between the yaw changes of scans by map and those of odometry `delay` scans later.
double turn_difference(const std::vector<double>& map, const std::vector<double>& odometry, double delay) {
  const double whole = std::floor(delay), fraction = delay - whole;
  const auto odometry_at = [&](std::size_t scan) {
    const auto before = static_cast<std::size_t>(static_cast<double>(scan) + whole);
    return (1.0 - fraction) * odometry[before] + fraction * odometry[before + 1];
  };
  double sum = 0.0;
  for (std::size_t i = kMaxDelay + 1; i + kMaxDelay + 1 < map.size(); ++i) {
    sum += std::min(kMaxTurnDifferenceRad, std::abs(map[i] - map[i - 1] - odometry_at(i) + odometry_at(i - 1)));
  }
  return sum;
}

/// Delay of odometry in scans; 0 if none explains the yaw changes clearly better.
double find_delay(const std::vector<Pose2>& T_odom_body, const std::vector<Pose2>& T_map_body) {
  const std::vector<double> map = unwrapped_yaw(T_map_body), odometry = unwrapped_yaw(T_odom_body);
  double best = 0.0, min_difference = kDelayGain * turn_difference(map, odometry, 0.0);
  for (int step = -kDelaySteps * kMaxDelay; step <= kDelaySteps * kMaxDelay; ++step) {
    const double delay = static_cast<double>(step) / kDelaySteps, difference = turn_difference(map, odometry, delay);
    if (difference >= min_difference) continue;
    min_difference = difference;
    best = delay;
  }
  return best;
}

/// Odometry at the stamps of the scans, if it is late by `delay` scans.
std::vector<Pose2> without_delay(const std::vector<Pose2>& T_odom_body, double delay) {
  if (delay == 0.0) return T_odom_body;
  const double last = static_cast<double>(T_odom_body.size()) - 1.0;
  std::vector<Pose2> shifted;
  for (std::size_t i = 0; i < T_odom_body.size(); ++i) {
    const double at = std::clamp(static_cast<double>(i) + delay, 0.0, last), whole = std::floor(at),
                 fraction = at - whole;
    const auto before = static_cast<std::size_t>(whole);
    const Pose2 step = T_odom_body[before].inverse() * T_odom_body[std::min(before + 1, T_odom_body.size() - 1)];
    shifted.push_back(T_odom_body[before] * scaled_motion(step, fraction));
  }
  return shifted;
}

double median_interval_s(const std::vector<Time>& stamps) {
  std::vector<double> intervals;
  for (std::size_t i = 1; i < stamps.size(); ++i) intervals.push_back(to_seconds(stamps[i] - stamps[i - 1]));
  return intervals.empty() ? 0.0 : upper_median(std::move(intervals));
}

void find_gaps(const std::vector<Time>& stamps, double median_s, OdometryHealth& health) {
  for (std::size_t i = 1; i < stamps.size(); ++i) {
    const double interval_s = to_seconds(stamps[i] - stamps[i - 1]);
    if (interval_s <= std::max(kMinGap_s, kGapRatio * median_s)) continue;
    ++health.num_gaps;
    if (interval_s <= health.max_gap_s) continue;
    health.max_gap_s = interval_s;
    health.max_gap_scan = i - 1;
  }
}

void collect_faults(const std::vector<OdometrySegment>& segments,
                    const std::vector<std::optional<OdometryFault>>& faults, const std::vector<Pose2>& T_map_body,
                    OdometryHealth& health) {
  for (std::size_t s = 0; s < segments.size(); ++s) {
    health.distance_m += segments[s].distance_m;
    if (!faults[s]) continue;
    ++health.num_faulty;
    const bool continues = s > 0 && faults[s - 1] == faults[s] && *faults[s] != OdometryFault::kJumping;
    if (!continues) {
      health.faulty.push_back({.fault = *faults[s],
                               .first_scan = segments[s].first_scan,
                               .p_map = T_map_body[segments[s].first_scan].position()});
    }
    health.faulty.back().distance_m += segments[s].distance_m;
    health.faulty.back().last_scan = segments[s].last_scan;
  }
  std::stable_sort(health.faulty.begin(), health.faulty.end(),
                   [](const FaultyOdometry& a, const FaultyOdometry& b) { return a.distance_m > b.distance_m; });
}

}  // namespace

OdometryHealth check_odometry(const std::vector<Pose2>& T_odom_body, const std::vector<Pose2>& T_map_body,
                              const std::vector<Time>& stamps) {
  OdometryHealth health;
  const double delay = find_delay(T_odom_body, T_map_body), median_s = median_interval_s(stamps);
  health.delay_s = delay * median_s;
  find_gaps(stamps, median_s, health);
  const std::vector<OdometrySegment> segments = divide_odometry(without_delay(T_odom_body, delay), T_map_body, stamps);
  health.num_segments = static_cast<int>(segments.size());
  std::vector<std::optional<OdometryFault>> faults;
  for (const OdometrySegment& segment : segments) faults.push_back(obvious_fault(segment));
  if (const auto calibrated = calibrate_on(segments, faults)) {
    health.distance = to_scale(calibrated->parameters[3]);
    health.turn = to_scale(calibrated->parameters[4]);
    health.steering = to_scale(calibrated->parameters[5]);
    for (std::size_t s = 0; s < segments.size(); ++s) {
      if (!faults[s] && is_slipping(segments[s], calibrated->calibration())) faults[s] = OdometryFault::kSlipping;
    }
  }
  collect_faults(segments, faults, T_map_body, health);
  return health;
}

}  // namespace patrol::slam
