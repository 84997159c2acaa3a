#include "slam/graph/scan_group.h"

#include <utility>

namespace patrol::slam {

ScanGroup::ScanGroup(LevelScan scan) { add(std::move(scan), {}); }

ScanGroup::ScanGroup(std::vector<LevelScan> scans) {
  for (LevelScan& scan : scans) members_.push_back({std::move(scan), {}});
}

void ScanGroup::add(LevelScan scan, const Pose2& T_before_now) {
  const Pose2 T_now_before = T_before_now.inverse();
  for (Member& member : members_) member.T_group_scan = T_now_before * member.T_group_scan;
  members_.push_back({std::move(scan), {}});
}

void ScanGroup::replace_newest(LevelScan scan, const Pose2& T_before_now) {
  add(std::move(scan), T_before_now);
  members_.erase(members_.end() - 2);
}

std::vector<LevelScan> ScanGroup::scans() const {
  std::vector<LevelScan> scans;
  for (const Member& member : members_) {
    LevelScan scan = member.scan;
    scan.origin_m = member.T_group_scan * scan.origin_m;
    for (LevelScan::Beam& beam : scan.beams)
      beam.end_m = (member.T_group_scan * Eigen::Vector2d(beam.end_m.cast<double>())).cast<float>();
    scans.push_back(std::move(scan));
  }
  return scans;
}

std::vector<MatchPoint> ScanGroup::match_points(double spacing_m, int max_points) const {
  if (members_.size() == 1) return downsample_scan(members_.front().scan, spacing_m, max_points);
  std::vector<MatchPoint> points;
  for (const Member& member : members_) {
    for (const MatchPoint& point : downsample_scan(member.scan, spacing_m, max_points))
      points.push_back({member.T_group_scan * point.p_body, point.range_m});
  }
  return points;
}

void ScanGroup::integrate(const Pose2& T_map_group, const ScanIntegrationSettings& settings, GridMap& map) const {
  for (const Member& member : members_) integrate_scan(member.scan, T_map_group * member.T_group_scan, settings, map);
}

}  // namespace patrol::slam
