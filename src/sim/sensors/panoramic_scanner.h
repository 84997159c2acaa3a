#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/messages.h"
#include "core/random.h"
#include "core/settings.h"
#include "sim/dust.h"
#include "sim/lidar_scene.h"
#include "sim/sensors/surface_optics.h"

namespace patrol::sim {

/// A terrestrial laser scanner. Defaults are those of FARO's Focus S 70, by its technical sheet: 0.6 to 70 m (black, 2 %: to 50 m);
/// ranging noise on 90, 10 and 2 % of 0.3, 0.4 and 1.3 mm at 10 m and of 0.3, 0.5 and 2.0 mm at 25 m; ranging error +-1 mm (systematic);
/// angular accuracy 19"; compensator 19"; beam 2.12 mm wide at the exit, spread by 0.3 mrad; all round and 300 degrees up and down, in
/// steps of 0.009 degrees (here: every 40th). A stated "+-" is read as two standard deviations, a plain figure as one.
struct PanoramicScannerSettings {
  bool enabled = false;
  std::string epoch = "inspection";  ///< measurement epoch of a scan: "reference" or "inspection"; independent noise in each
  double step_deg = 0.36;            ///< from direction to direction, about and up: 1000 columns of 417
  double elevation_min_deg = -60.0;  ///< of the lowest direction; below it the instrument sees its own foot
  double duration_s = 30.0;          ///< of a scan
  double range_min_m = 0.6;
  double range_max_m = 70.0;
  double black_range_m = 50.0;     ///< range on a surface of 2 % reflectivity
  double range_noise_m = 0.0003;   ///< standard deviation on a bright surface
  double grey_noise_m = 0.000255;  ///< and what 10 % at 10 m adds to it, in squares: with the root of the range, and one over the light
  double range_offset_std_m = 0.0005;  ///< of an error that is the same for all of a scan
  double angle_noise_deg = 0.0053;     ///< standard deviation of each beam's azimuth, and of its elevation
  double tilt_error_deg = 0.0053;      ///< standard deviation of the tilt that the compensator leaves, about each of two axes
  double beam_exit_m = 0.00212;        ///< width
  double beam_spread_rad = 0.0003;     ///< half angle; 0, and a beam has no width: no mixed pixels
  double grazing_deg = 85.0;  ///< beams that meet a surface flatter than this are lost
  double dropout = 0.001;     ///< share of beams that are lost for no reason
  double latency_s = 0.5;     ///< from the last point to the message

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("enabled", self.enabled);
    visit("epoch", self.epoch, one_of({"reference", "inspection"}));
    visit("step_deg", self.step_deg, between(0.09, 10.0));
    visit("elevation_min_deg", self.elevation_min_deg, between(-90.0, 80.0));
    visit("duration_s", self.duration_s, between(0.1, 3600.0));
    visit("range_min_m", self.range_min_m, at_least(0.0));
    visit("range_max_m", self.range_max_m, between(1.0, 400.0));
    visit("black_range_m", self.black_range_m, between(1.0, 400.0));
    visit("range_noise_m", self.range_noise_m, between(0.0, 1.0));
    visit("grey_noise_m", self.grey_noise_m, between(0.0, 1.0));
    visit("range_offset_std_m", self.range_offset_std_m, between(0.0, 1.0));
    visit("angle_noise_deg", self.angle_noise_deg, between(0.0, 1.0));
    visit("tilt_error_deg", self.tilt_error_deg, between(0.0, 1.0));
    visit("beam_exit_m", self.beam_exit_m, between(0.0, 0.1));
    visit("beam_spread_rad", self.beam_spread_rad, between(0.0, 0.01));
    visit("grazing_deg", self.grazing_deg, between(0.0, 90.0));
    visit("dropout", self.dropout, between(0.0, 1.0));
    visit("latency_s", self.latency_s, between(0.0, 60.0));
  }
};

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
