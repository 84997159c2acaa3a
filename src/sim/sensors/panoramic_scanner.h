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
#include "sim/as_built/scanner_errors.h"
#include "sim/dust.h"
#include "sim/lidar_scene.h"
#include "sim/sensors/surface_optics.h"

namespace patrol::sim {

/// Panoramic scanner, measuring on request.
///
/// The head makes half a revolution; at each step the mirror scans one column ahead and one behind. Each pair of
/// columns is fired at its own instant from the robot's pose at that instant. The instrument assumes that it is
/// stationary: it applies the tilt that its compensator measures at the start, so motion of the robot distorts the
/// scan.
///
/// The light of a surface is its reflectivity times the cosine of incidence. The variance of the range noise is noise^2
/// + grey_noise^2 (range / 10 m) (0.1 / light)^2; it reproduces all six values of the data sheet. Each error source has
/// its own random stream, indexed by epoch, scan and beam. So a reference scan has independent noise even with the seed
/// of an inspection.
///
/// At range discontinuities a beam is spread over its width and returns the mean range. The distance between the
/// surfaces does not matter, because the instrument measures phase. Not modeled: false returns of dust, the
/// compensator's limit of 2 degrees, color.
class PanoramicScanner {
 public:
  /// Dust reduces the light. `errors`: systematic errors of the instrument.
  PanoramicScanner(const PanoramicScannerSettings& settings, const LidarScene& scene, Pose3 T_body_scanner,
                   std::uint64_t seed, const DustSettings& dust = {}, const ScannerErrors& errors = {});

  /// Starts a scan at the given body pose; does nothing during a scan.
  void begin(Time now, const Pose3& T_world_body);
  bool is_busy() const { return scan_.has_value(); }

  /// Fires the columns whose instants are in (from, to]; the body pose is interpolated in between.
  void advance(Time from, Time to, const Pose3& T_world_body_from, const Pose3& T_world_body_to);

  /// Removes and returns the scans completed since the last call.
  std::vector<PanoramicScan> take_scans() { return std::exchange(scans_, {}); }

  int columns() const { return 2 * static_cast<int>(azimuth_.size()); }
  int rows() const { return static_cast<int>(elevation_.size()); }

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(num_begun_, scan_, scans_);
  }

 private:
  /// Return of one beam.
  struct Return {
    double range_m;  ///< +Inf: no return
    double light;    ///< reflectivity times cosine
  };
  /// Beam of one column and row. Unit vectors in `scanner`.
  struct Beam {
    Eigen::Vector3d nominal;   ///< reported direction
    Eigen::Vector3d left, up;  ///< perpendicular to it
    double cosine;             ///< cosine of the elevation
    BeamDeviation deviation;

    /// Returns the actual direction for random errors of the encoders; first order in the errors.
    Eigen::Vector3d aimed(double azimuth_error_rad, double elevation_error_rad) const;
  };
  struct Scan {
    Time start;
    std::uint64_t number;                ///< number of the scan, from 0
    Eigen::Quaterniond R_level_scanner;  ///< attitude measured by the compensator
    double range_offset_m;
    int next_pair = 0;
    std::array<std::array<std::vector<double>, 2>, 2> before_m;  ///< ranges, [ahead, behind][one, two columns ago][row]
    std::vector<ScannerPoint> points;
  };

  Time instant_of(int pair) const;
  void fire_column(int column, const Pose3& T_world_scanner);
  Beam beam_at(int column, std::size_t row) const;
  Pose3 beam_origin(const Pose3& T_world_scanner, const Beam& beam) const;
  void report(const Eigen::Vector3d& direction, const Return& beam_return, std::uint64_t index);
  Return trace(const Pose3& T_world_scanner, const Eigen::Vector3d& direction) const;
  Return mixed_pixel_return(const Pose3& T_world_scanner, const Eigen::Vector3d& direction, double range_m) const;
  double range_std_m(const Return& beam_return) const;

  PanoramicScannerSettings settings_;
  const LidarScene& scene_;
  Pose3 T_body_scanner_;
  DustSettings dust_;
  ScannerErrors errors_;
  std::vector<SurfaceOptics> surfaces_;  ///< [geom] of the view model
  RandomStream range_noise_, range_offset_, angle_noise_, tilt_error_, dropout_;
  std::vector<Eigen::Vector2d> azimuth_;    ///< [column ahead], cosine and sine; the column behind has the opposite
                                            ///< direction
  std::vector<Eigen::Vector2d> elevation_;  ///< [row], cosine and sine, from the lowest row
  std::uint64_t num_begun_ = 0;
  std::optional<Scan> scan_;
  std::vector<PanoramicScan> scans_;
};

}  // namespace patrol::sim
