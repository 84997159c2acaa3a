#include "io/logs/no_return_detector.h"

#include <algorithm>
#include <cmath>

namespace patrol::io {
namespace {

constexpr double kMove_m = 0.2, kTurnRad = 0.2;  ///< motion to a new position
constexpr std::uint64_t kMaxPositions = 500, kMaxReadings = 1'000'000;
constexpr float kMinCodeRatio = 0.98F;      ///< codes for no return are above this fraction of the maximum range
constexpr float kMinComparedRatio = 0.75F;  ///< lower bound of the ranges compared with the codes
constexpr std::uint64_t kMinPositions = 10, kMinReadings = 20, kMinCountRatio = 5;

}  // namespace

void NoReturnDetector::add(const RecordedScan& recorded) {
  if (T_odom_examined_) {
    const Pose2 moved = T_odom_examined_->inverse() * recorded.T_odom_body;
    if (moved.position().norm() < kMove_m && std::abs(moved.yaw) < kTurnRad) return;
  }
  T_odom_examined_ = recorded.T_odom_body;
  ++num_positions_;
  for (const float range_m : recorded.scan.ranges_m) {
    if (!std::isfinite(range_m) || range_m <= 0.0F) continue;
    ++num_readings_;
    if (!counts_.empty() && range_m < kMinComparedRatio * counts_.rbegin()->first) continue;
    Count& count = counts_[range_m];
    ++count.readings;
    if (count.last_position != num_positions_) ++count.positions;
    count.last_position = num_positions_;
  }
  if (!counts_.empty())
    counts_.erase(counts_.begin(), counts_.lower_bound(kMinComparedRatio * counts_.rbegin()->first));
}

bool NoReturnDetector::is_conclusive() const {
  return num_positions_ >= kMaxPositions || num_readings_ >= kMaxReadings;
}

std::optional<NoReturnValue> NoReturnDetector::find() const {
  if (counts_.empty()) return std::nullopt;
  const auto top = counts_.lower_bound(kMinCodeRatio * counts_.rbegin()->first);
  std::uint64_t max_below = 0;
  for (auto below = counts_.begin(); below != top; ++below) max_below = std::max(max_below, below->second.readings);
  const std::uint64_t enough = std::max(kMinReadings, kMinCountRatio * max_below);
  for (auto value = top; value != counts_.end(); ++value) {
    const Count& count = value->second;
    if (count.positions >= kMinPositions && count.readings >= enough)
      return NoReturnValue{.range_m = value->first, .num_readings = count.readings, .num_positions = count.positions};
  }
  return std::nullopt;
}

}  // namespace patrol::io
