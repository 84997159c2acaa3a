#include "slam/graph/scans_since_keyframe.h"

#include <cmath>
#include <utility>

namespace patrol::slam {
namespace {

/// Scans in different places are at least this far apart; a turn counts as the displacement at 1 m.
constexpr double kDistinct_m = 0.05;

}  // namespace

void ScansSinceKeyframe::add(const LevelScan& scan, const Pose2& T_local_body) {
  const Pose2 T_distinct_now = T_local_distinct_.inverse() * T_local_body,
              T_before_now = T_local_newest_.inverse() * T_local_body;
  const bool is_distinct =
      scans_.is_empty() || T_distinct_now.position().norm() + std::abs(T_distinct_now.yaw) > kDistinct_m;
  if (scans_.is_empty()) {
    scans_ = ScanGroup(scan);
  } else if (is_distinct) {
    scans_.add(scan, T_before_now);
  } else {
    scans_.replace_newest(scan, T_before_now);
  }
  if (is_distinct) T_local_distinct_ = T_local_body;
  T_local_newest_ = T_local_body;
}

ScanGroup ScansSinceKeyframe::take() { return std::exchange(scans_, {}); }

}  // namespace patrol::slam
