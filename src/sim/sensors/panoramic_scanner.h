#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/random.h"
#include "core/sensors/registry.h"
#include "core/settings.h"
#include "sim/dust.h"
#include "sim/lidar_scene.h"
#include "sim/sensors/surface_optics.h"

namespace patrol::sim {

/// Takes panoramic scans, one when asked. The head makes half a turn, and its mirror a column ahead and one behind at each step; each
/// pair of columns is fired at its own instant, from where the robot is then. The instrument takes itself to stand still: it knows one
/// tilt, that which its compensator read at the start, and if the robot moves, walls bend.
///
/// A surface's light is its reflectivity times the cosine of the incidence. Range noise follows the sheet: its six figures are met to
/// its last digit by the variance noise^2 + grey_noise^2 (range / 10 m) (0.1 / light)^2. Every imperfection draws from its own random
/// stream, addressed by epoch, scan and beam: a reference scan has independent noise even under an inspection's seed. Where the range jumps, a beam is spread over its width and returns the mean of what it meets,
/// however far apart: the instrument measures the phase of its light. Not modelled: dust's own echoes, the compensator's limit of 2
/// degrees, colour.
class PanoramicScanner {
 public:
  /// Dust takes from the light.
  PanoramicScanner(const PanoramicScannerSettings& settings, const LidarScene& scene, const Pose3& T_body_scanner, std::uint64_t seed,
                   const DustSettings& dust = {});

  /// Starts a scan, the body being there; while one is under way nothing is started.
  void begin(Time now, const Pose3& T_world_body);
  bool is_busy() const { return scan_.has_value(); }

  /// Fires the columns whose instants lie in (from, to]; the body moves evenly in between.
  void advance(Time from, Time to, const Pose3& T_world_body_from, const Pose3& T_world_body_to);

  /// Scans completed since the last call.
  std::vector<PanoramicScan> take_scans() { return std::exchange(scans_, {}); }

  int columns() const { return 2 * static_cast<int>(azimuth_.size()); }
  int rows() const { return static_cast<int>(elevation_.size()); }

 private:
  /// What one beam sees.
  struct Echo {
    double range_m;  ///< +Inf: nothing
    double light;    ///< reflectivity times cosine
  };
  struct Scan {
    Time start;
    std::uint64_t number;               ///< from 0
    Eigen::Quaterniond R_level_scanner;  ///< as the compensator has it
    double range_offset_m;
    int next_pair = 0;
    std::array<std::array<std::vector<double>, 2>, 2> before_m;  ///< [ahead, behind][one, two columns ago][row]: ranges
    std::vector<ScannerPoint> points;
  };

  Time instant_of(int pair) const;
  void fire_column(int column, const Pose3& T_world_scanner);
  Eigen::Vector3d direction(int column, std::size_t row, double azimuth_error_rad, double elevation_error_rad) const;
  Echo look(const Pose3& T_world_scanner, const Eigen::Vector3d& direction) const;
  Echo mix_over_width(const Pose3& T_world_scanner, const Eigen::Vector3d& direction, double range_m) const;
  double range_std_m(const Echo& echo) const;

  PanoramicScannerSettings settings_;
  const LidarScene& scene_;
  Pose3 T_body_scanner_;
  DustSettings dust_;
  std::vector<SurfaceOptics> surfaces_;  ///< [geom] of the view model
  RandomStream range_noise_, range_offset_, angle_noise_, tilt_error_, dropout_;
  std::vector<Eigen::Vector2d> azimuth_;    ///< [column ahead]: cosine and sine; that behind looks the other way
  std::vector<Eigen::Vector2d> elevation_;  ///< [row]: cosine and sine, from below
  std::uint64_t num_begun_ = 0;
  std::optional<Scan> scan_;
  std::vector<PanoramicScan> scans_;
};

}  // namespace patrol::sim
