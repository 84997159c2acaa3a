#pragma once

#include <utility>
#include <vector>

#include "slam/submaps/pair_features.h"
#include "slam/submaps/submap_rbpf.h"
#include "tests/slam/graph/office_world.h"

namespace patrol::test {

/// Votes that need no training: whatever the matching lays together well, near to where it was predicted, are
/// neighbors.
inline BoostedStumps agreeing_neighbors() {
  return {.features = slam::pair_feature_names(),
          .stumps = {{.feature = 13, .threshold = 0.8, .sign_above = 1, .weight = 2.0},
                     {.feature = 12, .threshold = 3.0, .sign_above = -1, .weight = 2.0},
                     {.feature = 11, .threshold = 0.3, .sign_above = 1, .weight = 1.0}}};
}

struct SubmapDrive {
  std::vector<DriveStep> drive;
  slam::SubmapRbpf slam;

  double rms_error_m() const {
    const std::vector<Pose2> path = slam.path();
    double sum = 0.0;
    for (std::size_t k = 0; k < path.size(); ++k)
      sum += (path[k].position() - (drive[0].T_world_body.inverse() * drive[k].T_world_body).position()).squaredNorm();
    return std::sqrt(sum / static_cast<double>(path.size()));
  }
  std::vector<Pose2> T_world_submap() const {
    std::vector<Pose2> poses;
    for (const std::size_t first : slam.first_scans()) poses.push_back(drive[first].T_world_body);
    return poses;
  }
};

inline SubmapDrive map_by_submaps(const RoomWorld& world, std::vector<DriveStep> drive,
                                  const RoomWorld::ScanOptions& lidar, const slam::SubmapRbpfSettings& settings,
                                  const BoostedStumps& neighbors, std::uint64_t seed) {
  SubmapDrive mapped{.drive = std::move(drive), .slam = slam::SubmapRbpf(settings, neighbors, seed)};
  const RandomStream noise(seed, "test/submaps");
  for (std::size_t k = 0; k < mapped.drive.size(); ++k) {
    const DriveStep& step = mapped.drive[k];
    mapped.slam.update(world.scan(step.T_world_body, step.stamp, lidar, noise, k), step.T_odom_body);
  }
  mapped.slam.finish();
  return mapped;
}

inline SubmapDrive map_by_submaps(const RoomWorld& world, const std::vector<Eigen::Vector2d>& corners,
                                  const DriveOptions& options, const slam::SubmapRbpfSettings& settings,
                                  const BoostedStumps& neighbors, std::uint64_t seed = 1) {
  return map_by_submaps(world, drive_along(corners, options), kOldLidar, settings, neighbors, seed);
}

}  // namespace patrol::test
