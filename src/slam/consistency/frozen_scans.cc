#include "slam/consistency/frozen_scans.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>

namespace patrol::slam {
namespace {

constexpr std::size_t kMinRepeats = 4;
constexpr double kMinOdometry_m = 0.2, kMinOdometryRad = 0.2;
constexpr int kMinFrozenReturns = 3;

/// Whether the bits are the same: ranges that are not a number are equal to themselves.
bool are_same_bits(const std::vector<float>& a, const std::vector<float>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0);
}

bool has_enough_returns(const std::vector<float>& ranges_m) {
  return std::ranges::count_if(ranges_m, [](float range_m) { return std::isfinite(range_m); }) >= kMinFrozenReturns;
}

}  // namespace

bool FrozenScans::is_frozen(const Repetition& repetition) {
  return repetition.num_repeats >= kMinRepeats && repetition.has_moved;
}

void FrozenScans::add(const RecordedScan& recorded) {
  const std::size_t scan = num_scans_++;
  const std::vector<float>& ranges_m = recorded.scan.ranges_m;
  if (scan > 0 && are_same_bits(ranges_m, last_ranges_m_) && has_enough_returns(ranges_m)) {
    ++newest_.num_repeats;
    const Pose2 moved = newest_.T_odom_first.inverse() * recorded.T_odom_body;
    newest_.has_moved =
        newest_.has_moved || moved.position().norm() >= kMinOdometry_m || std::abs(moved.yaw) >= kMinOdometryRad;
    return;
  }
  if (is_frozen(newest_)) frozen_.push_back(newest_);
  newest_ = {.first_scan = scan, .T_odom_first = recorded.T_odom_body};
  last_ranges_m_ = ranges_m;
}

std::vector<UnmatchedSegment> FrozenScans::find(const std::vector<Pose2>& T_map_body) const {
  std::vector<Repetition> all = frozen_;
  if (is_frozen(newest_)) all.push_back(newest_);
  std::vector<UnmatchedSegment> segments;
  for (const Repetition& repetition : all) {
    const std::size_t first = repetition.first_scan + 1;
    segments.push_back(
        {.first_scan = first, .num_scans = repetition.num_repeats, .p_map = T_map_body[first].position()});
  }
  std::ranges::stable_sort(segments, std::ranges::greater{}, &UnmatchedSegment::num_scans);
  return segments;
}

std::size_t num_scans_of(const std::vector<UnmatchedSegment>& segments) {
  std::size_t num_scans = 0;
  for (const UnmatchedSegment& segment : segments) num_scans += segment.num_scans;
  return num_scans;
}

}  // namespace patrol::slam
