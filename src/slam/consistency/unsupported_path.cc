#include "slam/consistency/unsupported_path.h"

#include <algorithm>
#include <cstddef>
#include <functional>

namespace patrol::slam {
namespace {

constexpr std::size_t kMinScans = 3;
constexpr double kMinContradiction_m = 2.0, kMaxInterval_s = 5.0;
constexpr double kMinUnsupportedGap_s = 5.0;

/// Time between two ranges of scans; 0 if they overlap.
double interval_s(const std::vector<Time>& stamps, std::size_t a_first, std::size_t a_last, std::size_t b_first,
                  std::size_t b_last) {
  return std::max(
      {0.0, to_seconds(stamps.at(b_first) - stamps.at(a_last)), to_seconds(stamps.at(a_first) - stamps.at(b_last))});
}

}  // namespace

std::vector<UnsupportedPath> find_unsupported_path(const std::vector<UnmatchedSegment>& unmatched,
                                                   const std::vector<FaultyOdometry>& faulty,
                                                   const std::vector<Time>& stamps) {
  std::vector<UnsupportedPath> unsupported;
  for (const UnmatchedSegment& segment : unmatched) {
    if (segment.num_scans < kMinScans) continue;
    const std::size_t last = std::min(segment.first_scan + segment.num_scans, stamps.size()) - 1;
    double contradiction_m = 0.0;
    for (const FaultyOdometry& entry : faulty) {
      if (interval_s(stamps, segment.first_scan, last, entry.first_scan, entry.last_scan) <= kMaxInterval_s)
        contradiction_m = std::max(contradiction_m, entry.distance_m);
    }
    if (contradiction_m >= kMinContradiction_m)
      unsupported.push_back({.scans = segment, .contradiction_m = contradiction_m});
  }
  std::ranges::stable_sort(unsupported, std::ranges::greater{},
                           [](const UnsupportedPath& entry) { return entry.scans.num_scans; });
  return unsupported;
}

std::vector<UnsupportedPath> find_unsupported_gaps(const std::vector<Pose2>& T_odom_body,
                                                   const std::vector<Pose2>& T_map_body,
                                                   const std::vector<Time>& stamps) {
  std::vector<UnsupportedPath> unsupported;
  for (std::size_t i = 1; i < stamps.size(); ++i) {
    const double gap_s = to_seconds(stamps[i] - stamps[i - 1]);
    if (gap_s < kMinUnsupportedGap_s) continue;
    const Pose2 odometry = T_odom_body[i - 1].inverse() * T_odom_body[i],
                map = T_map_body[i - 1].inverse() * T_map_body[i];
    const double contradiction_m = (odometry.position() - map.position()).norm();
    if (contradiction_m < kMinContradiction_m) continue;
    unsupported.push_back({.scans = {.first_scan = i, .p_map = T_map_body[i].position()},
                           .contradiction_m = contradiction_m,
                           .gap_s = gap_s});
  }
  std::ranges::stable_sort(unsupported, std::ranges::greater{},
                           [](const UnsupportedPath& entry) { return entry.gap_s; });
  return unsupported;
}

}  // namespace patrol::slam
