#include "io/no_return.h"

#include <algorithm>
#include <cmath>

namespace patrol::io {
namespace {

constexpr double kMove_m = 0.2, kTurnRad = 0.2;  ///< motion to a new position
constexpr std::uint64_t kMostPlaces = 500, kMostReadings = 1'000'000;
constexpr float kTopShare = 0.98F;       ///< codes for no return are above this fraction of the maximum range
constexpr float kNeighbourShare = 0.75F; ///< lower bound of the ranges compared with the codes
constexpr std::uint64_t kFewestPlaces = 10, kFewestReadings = 20, kTimesAsOften = 5;

}  // namespace

void NoReturnFinder::add(const RecordedScan& recorded) {
  if (T_odom_place_) {
    const Pose2 moved = T_odom_place_->inverse() * recorded.T_odom_body;
    if (moved.position().norm() < kMove_m && std::abs(moved.yaw) < kTurnRad) return;
  }
  T_odom_place_ = recorded.T_odom_body;
  ++num_places_;
  for (const float range_m : recorded.scan.ranges_m) {
    if (!std::isfinite(range_m) || range_m <= 0.0F) continue;
    ++num_readings_;
    if (!counts_.empty() && range_m < kNeighbourShare * counts_.rbegin()->first) continue;
    Count& count = counts_[range_m];
    ++count.readings;
    if (count.last_place != num_places_) ++count.places;
    count.last_place = num_places_;
  }
  if (!counts_.empty()) counts_.erase(counts_.begin(), counts_.lower_bound(kNeighbourShare * counts_.rbegin()->first));
}

bool NoReturnFinder::has_seen_enough() const { return num_places_ >= kMostPlaces || num_readings_ >= kMostReadings; }

std::optional<NoReturnValue> NoReturnFinder::find() const {
  if (counts_.empty()) return std::nullopt;
  const auto top = counts_.lower_bound(kTopShare * counts_.rbegin()->first);
  std::uint64_t most_below = 0;
  for (auto below = counts_.begin(); below != top; ++below) most_below = std::max(most_below, below->second.readings);
  const std::uint64_t enough = std::max(kFewestReadings, kTimesAsOften * most_below);
  for (auto value = top; value != counts_.end(); ++value) {
    const Count& count = value->second;
    if (count.places >= kFewestPlaces && count.readings >= enough) return NoReturnValue{.range_m = value->first, .num_readings = count.readings, .num_places = count.places};
  }
  return std::nullopt;
}

}  // namespace patrol::io
