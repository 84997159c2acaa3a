#include "localize/stationary_gyro_bias.h"

#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include "core/geometry/linear_algebra.h"
#include "localize/inertial_motion.h"

namespace patrol::localize {
namespace {

constexpr double kEndFraction = 0.2;       // fraction of the window that is averaged at each end
constexpr double kMaxGap_s = 0.02;         // maximum time between samples
constexpr double kMaxSlip_m = 0.001;       // maximum residual of the rigid fit per foot
constexpr double kMaxRotation_rad = 0.02;  // maximum rotation of a standing trunk

struct SmallRotation {
  Eigen::Vector3d angle_rad;
  Eigen::Matrix3d information;  ///< information of the angle for a foot standard deviation of 1 m
  double max_residual_m;
};

// Rotation of the trunk by theta over stationary feet: q - p = -theta x p = [p]x theta, relative to the mean of the
// feet.
SmallRotation fit_rotation(const std::array<Eigen::Vector3d, kNumLegs>& before,
                           const std::array<Eigen::Vector3d, kNumLegs>& after) {
  Eigen::Vector3d before_mean = Eigen::Vector3d::Zero(), after_mean = Eigen::Vector3d::Zero();
  for (std::size_t leg = 0; leg < kNumLegs; ++leg) {
    before_mean += before[leg] / kNumLegs;
    after_mean += after[leg] / kNumLegs;
  }
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (std::size_t leg = 0; leg < kNumLegs; ++leg) {
    const Eigen::Matrix3d lever = cross_matrix(before[leg] - before_mean);
    normal += lever.transpose() * lever;
    right += lever.transpose() * ((after[leg] - after_mean) - (before[leg] - before_mean));
  }
  const Eigen::Vector3d angle = solve_symmetric(normal, right);
  double worst = 0.0;
  for (std::size_t leg = 0; leg < kNumLegs; ++leg) {
    const Eigen::Vector3d p = before[leg] - before_mean;
    worst = std::max(worst, ((after[leg] - after_mean) - p - cross_matrix(p) * angle).norm());
  }
  return {angle, normal, worst};
}

}  // namespace

void StationaryGyroBiasEstimator::End::add(const StanceFeet& feet, const Eigen::Vector3d& gyro_angle, double time) {
  for (const StanceFoot& foot : feet) {
    Eigen::Vector3d& sum = foot_m[static_cast<std::size_t>(foot.leg)];
    sum = count == 0 ? foot.p_contact : Eigen::Vector3d(sum + foot.p_contact);
  }
  gyro_angle_rad += gyro_angle;
  time_s += time;
  ++count;
}

void StationaryGyroBiasEstimator::End::divide() {
  for (Eigen::Vector3d& foot : foot_m) foot /= count;
  gyro_angle_rad /= count;
  time_s /= count;
}

std::optional<GyroBiasMeasurement> StationaryGyroBiasEstimator::add(Time stamp, const StanceFeet& all_feet,
                                                                    const Eigen::Vector3d& gyro_radps) {
  if (all_feet.count != kNumLegs || (is_open_ && (stamp <= last_ || to_seconds(stamp - last_) > kMaxGap_s))) reset();
  if (all_feet.count != kNumLegs) return std::nullopt;
  if (!is_open_) {
    is_open_ = true;
    start_ = last_ = stamp;
    gyro_angle_rad_.setZero();
    first_ = final_ = End{};
  } else {
    gyro_angle_rad_ += to_seconds(stamp - last_) * 0.5 * (gyro_radps + last_gyro_);
  }
  last_ = stamp;
  last_gyro_ = gyro_radps;

  const double age_s = to_seconds(stamp - start_);
  if (age_s < kEndFraction * settings_.window_s) first_.add(all_feet, gyro_angle_rad_, age_s);
  if (age_s > (1.0 - kEndFraction) * settings_.window_s) final_.add(all_feet, gyro_angle_rad_, age_s);
  if (age_s < settings_.window_s) return std::nullopt;
  return close();
}

std::optional<GyroBiasMeasurement> StationaryGyroBiasEstimator::close() {
  is_open_ = false;
  first_.divide();
  final_.divide();
  const SmallRotation rotation = fit_rotation(first_.foot_m, final_.foot_m);
  if (rotation.max_residual_m > kMaxSlip_m || rotation.angle_rad.norm() > kMaxRotation_rad) return std::nullopt;

  const double span_s = final_.time_s - first_.time_s;
  const Eigen::Vector3d angle_var =
      2.0 * settings_.foot_std_m * settings_.foot_std_m * rotation.information.inverse().diagonal();
  const double gyro_var = std::pow(settings_.gyro_noise_density_radps_per_sqrt_hz, 2) / span_s;
  return GyroBiasMeasurement{.bias_radps =
                                 (final_.gyro_angle_rad - first_.gyro_angle_rad - rotation.angle_rad) / span_s,
                             .variance = (angle_var / (span_s * span_s)).array() + gyro_var};
}

}  // namespace patrol::localize
