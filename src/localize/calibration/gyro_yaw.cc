#include "localize/calibration/gyro_yaw.h"

#include <algorithm>
#include <chrono>

namespace patrol::localize {
namespace {

constexpr Time kLength = std::chrono::seconds(2);
constexpr Time kMaxGap = std::chrono::milliseconds(50);

}  // namespace

void GyroYaw::add(const Imu& imu, const Eigen::Quaterniond& R_odom_body) {
  if (!imu.angular_velocity_radps.allFinite() || (!samples_.empty() && imu.stamp <= samples_.back().stamp)) return;
  Sample sample{.stamp = imu.stamp, .rate_radps = (R_odom_body * (R_body_imu_ * imu.angular_velocity_radps)).z()};
  if (!samples_.empty() && imu.stamp - samples_.back().stamp > kMaxGap) samples_.clear();
  if (!samples_.empty()) {
    const Sample& last = samples_.back();
    sample.yaw_rad = last.yaw_rad + 0.5 * (last.rate_radps + sample.rate_radps) * to_seconds(sample.stamp - last.stamp);
  }
  samples_.push_back(sample);
  while (samples_.front().stamp < imu.stamp - kLength) samples_.pop_front();
}

std::optional<double> GyroYaw::at(Time stamp) const {
  const auto after = std::lower_bound(samples_.begin(), samples_.end(), stamp,
                                      [](const Sample& sample, Time value) { return sample.stamp < value; });
  if (after == samples_.end() || (after == samples_.begin() && after->stamp != stamp)) return std::nullopt;
  return after->yaw_rad - to_seconds(after->stamp - stamp) * after->rate_radps;
}

}  // namespace patrol::localize
