#pragma once

#include "core/settings.h"

namespace patrol::sim {

/// Systematic errors of the panoramic scanner that no motion of the scan and no range offset reproduces, after the
/// geometric models of [Muralikrishnan15] and [Medic19] and, for the ranges, [Lichti07].
///
/// FARO's Focus S 70 sheet states an angular accuracy of 19" and a systematic ranging error of +-1 mm. The sheet bounds
/// noise and systematic errors together. The 19" are split here into systematic errors of 12" of each of azimuth and
/// elevation (root mean square over the sphere) and noise of 14.7". The 1 mm, read as two standard deviations, is split
/// into the offset of each scan (0.42 mm), the cyclic error (0.2 mm) and the scale (0.15 mm at 15 m). The shares are
/// assumptions; all values are standard deviations over instruments.
struct ScannerTolerances {
  static constexpr const char* kSource = "FARO Focus S 70 technical sheet: 19 arc seconds, 1 mm; split: assumption";

  double angle_noise_ratio = 0.775;  ///< noise of the angles relative to that of sensors.scanner
  double range_offset_ratio = 0.84;  ///< range offset of a scan relative to that of sensors.scanner
  /// Standard deviation of the angle between the line of sight and the normal of the horizontal axis.
  double collimation_std_arcsec = 8.0;
  /// Standard deviation of the angle between the horizontal axis and the normal of the vertical axis.
  double trunnion_std_arcsec = 8.0;
  double vertical_index_std_arcsec = 8.0;  ///< standard deviation of the zero of the vertical encoder
  double eccentricity_std_arcsec = 8.0;    ///< standard deviation of each of the sine and cosine terms of both encoders
  double encoder_harmonic_std_arcsec = 4.0;  ///< standard deviation of each of the second-order terms of both encoders
  double beam_offset_std_m = 0.0001;         ///< distance of the beam from the center of rotation, horizontal and
                                             ///< vertical
  double range_scale_std = 1e-5;             ///< relative range error
  /// Standard deviation of each of the sine and cosine terms of the phase measurement.
  double cyclic_range_std_m = 0.0002;
  double cyclic_wavelength_m = 0.6;  ///< half of the shortest modulation wavelength, 1.2 m

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("angle_noise_ratio", self.angle_noise_ratio, between(0.0, 1.0));
    visit("range_offset_ratio", self.range_offset_ratio, between(0.0, 1.0));
    visit("collimation_std_arcsec", self.collimation_std_arcsec, between(0.0, 3600.0));
    visit("trunnion_std_arcsec", self.trunnion_std_arcsec, between(0.0, 3600.0));
    visit("vertical_index_std_arcsec", self.vertical_index_std_arcsec, between(0.0, 3600.0));
    visit("eccentricity_std_arcsec", self.eccentricity_std_arcsec, between(0.0, 3600.0));
    visit("encoder_harmonic_std_arcsec", self.encoder_harmonic_std_arcsec, between(0.0, 3600.0));
    visit("beam_offset_std_m", self.beam_offset_std_m, between(0.0, 0.1));
    visit("range_scale_std", self.range_scale_std, between(0.0, 0.01));
    visit("cyclic_range_std_m", self.cyclic_range_std_m, between(0.0, 0.1));
    visit("cyclic_wavelength_m", self.cyclic_wavelength_m, between(0.01, 100.0));
  }
};

}  // namespace patrol::sim
