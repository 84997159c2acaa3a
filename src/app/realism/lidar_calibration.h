#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/realism/realism_check.h"
#include "app/scenario/lidar_preset.h"
#include "realism/lidar_fit.h"

namespace patrol::app {

/// Settings of `patrol calibrate --sensor lidar --set`.
struct LidarCalibrationSettings {
  RealismSettings realism;
  realism::LidarFitSettings fit;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    RealismSettings::fields(self.realism, visit);
    visit("fit", self.fit);
  }
};

/// Fit on the first half of a log, and its comparison with the preset on the second half.
struct LidarCalibration {
  realism::LidarFit fit;
  realism::LidarDevice fitted;
  RealismResult by_preset, by_fit;  ///< comparisons on the second half
  double ks_ratio() const { return by_fit.ks() / by_preset.ks(); }
};

/// Fits on the first half and evaluates on the second; none if interrupted.
std::optional<LidarCalibration> calibrate_lidar(const RealismInput& input, const LidarCalibrationSettings& settings);

/// Preset of the fitted device for scenarios, with field of view, beams and range limits of the log.
LidarPreset preset_of(const LidarCalibration& calibration, const RealismInput& input);

/// Sentence for a fit that does not explain the log: its Kolmogorov-Smirnov distance on the held-out half is above 0.03
/// and above half of the preset's. Empty for other fits.
std::string misfit_warning(double ks_preset, double ks_fit);

/// Parameters with intervals, in YAML.
std::string calibration_yaml(const LidarCalibration& calibration, const std::string& comment);
io::Metrics metrics_of(const LidarCalibration& calibration);
std::string table_text(const LidarCalibration& calibration);
report::Section parameter_section(const LidarCalibration& calibration);

}  // namespace patrol::app
