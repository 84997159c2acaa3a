#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "importer/site/imported_site.h"
#include "io/points/station_scans.h"
#include "sim/lidar_scene.h"
#include "sim/mujoco.h"

namespace patrol::app {

/// World with positions for panoramic scans, and with roads on which its site is compared.
struct ScannedWorld {
  std::string name;                  ///< of the world in worlds/
  std::string scenario;              ///< navigation in the world, below the data root
  double step_deg = 0.0;             ///< of the scanner; the 12 scans together have about 19 million points
  double elevation_min_deg = -60.0;  ///< lowest elevation of the beams of the scanner
  std::vector<Eigen::Vector2d> scanners_m;
  std::vector<std::vector<Eigen::Vector2d>> roads_m;  ///< center lines
  double half_road_m = 1.5;                           ///< half the width of the roads
  std::size_t guest_scan = 0;                         ///< scan in which a person and a truck are present
  Eigen::Vector2d person_m, truck_m;
  double truck_yaw_deg = 0.0;
};

const std::vector<ScannedWorld>& scanned_worlds();

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

/// Takes panoramic scans 1.7 m above the ground at the positions of the world. Noise as in the data sheet of the
/// scanner (core/sensors/scanner.h), of the seed; poses are exact.
std::vector<io::StationScan> take_scans(const ScannedWorld& world, std::uint64_t seed);

/// Takes scans and writes them to `folder`. Returns the number of points.
std::size_t save_scans(const ScannedWorld& world, std::uint64_t seed, const std::filesystem::path& folder);

/// Adds the UWB anchors of the world to the MJCF of its site. They are surveyed; scans cannot identify them.
void add_anchors(const ScannedWorld& world, const std::filesystem::path& site_xml);

/// Differences of ranges at held-out poses. A beam returns up to an incidence of 85 degrees. Its difference is that of
/// the first surfaces; it is infinite if the world returns it and the site has no surface, or if the site returns it
/// and the world has no surface within 0.1 m of that range. A scanner sees a surface if the line to it is free, at most
/// 70 m long, not below the scanner's lowest elevation and at most at an incidence of 85 degrees. Beams past all
/// surfaces of the world count as seen.
struct RangeDifferences {
  double median_m = 0.0, p95_m = 0.0;
  double within_10cm = 0.0;       ///< fraction of beams
  double seen = 0.0;              ///< fraction of beams whose first surface in the world is seen by a scanner
  double seen_within_10cm = 0.0;  ///< fraction of these
  std::size_t num_beams = 0;
};

/// Comparison of a site with the true world.
struct SiteComparison {
  RangeDifferences planar, spatial;  ///< 2D: 720 beams to 30 m; 3D: 16 rings within 15 degrees, 360 beams to 100 m
  double ground_median_m = 0.0, ground_p95_m = 0.0;  ///< height of the ground for contact on the roads
  double person_hits = 0.0;      ///< fraction of beams to the removed person that hit a surface there only in the site
  double truck_hits = 0.0;       ///< fraction of beams to the removed truck that hit a surface there only in the site
  std::size_t num_phantoms = 0;  ///< held-out poses that are free in the world but touch a box of the site
};

/// Compares the site at `num_poses` poses on the roads with a clearance of 0.6 m, drawn with the seed. A pose is on
/// the level of the center line within 0.15 m.
SiteComparison compare_site(const ScannedWorld& world, const importer::ImportedSite& site, const std::string& site_xml,
                            int num_poses, std::uint64_t seed);

}  // namespace patrol::app
