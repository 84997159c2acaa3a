#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "app/study/scanned_worlds.h"
#include "io/points/station_scans.h"
#include "sim/lidar_scene.h"
#include "sim/mujoco.h"

namespace patrol::app {

/// Height of the scanner above the ground.
inline constexpr double kScannerHeight_m = 1.7;

/// Returns the file of the world.
std::string world_xml(const ScannedWorld& world);

/// World for ray casting, optionally with the person and the truck.
class RayWorld {
 public:
  RayWorld(const std::string& xml, const ScannedWorld* guests = nullptr);

  const sim::LidarScene& scene() const { return *scene_; }
  /// Returns the height of the highest surface below `from_m` at a position; NaN without one.
  double ground_m(const Eigen::Vector2d& p_m, double from_m = 1.2) const;

 private:
  sim::ModelPtr model_;
  std::unique_ptr<sim::LidarScene> scene_;
};

/// Takes panoramic scans at the positions of the world. Noise as in the data sheet of the
/// scanner (core/sensors/scanner.h), of the seed; poses are exact.
std::vector<io::StationScan> take_scans(const ScannedWorld& world, std::uint64_t seed);

/// Takes scans and writes them to `folder`. Returns the number of points.
std::size_t save_scans(const ScannedWorld& world, std::uint64_t seed, const std::filesystem::path& folder);

/// Adds the UWB anchors of the world to the MJCF of its site. They are surveyed; scans cannot identify them.
void add_anchors(const ScannedWorld& world, const std::filesystem::path& site_xml);

}  // namespace patrol::app
