#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "sim/as_built/scanner_tolerances.h"

namespace patrol::sim {

/// Deviation of a beam from the direction that the scanner reports: angles and displacements to the left (increasing
/// azimuth) and upwards, perpendicular to the beam.
struct BeamDeviation {
  double left_rad = 0.0, up_rad = 0.0;
  double left_m = 0.0, up_m = 0.0;  ///< displacement of the beam's origin
};

/// Systematic errors of one panoramic scanner, constant over its scans. The defaults are those of a nominal instrument.
///
/// The mirror fires at both faces: front at the azimuth of the head and, past the zenith, back at the opposite azimuth.
/// Axis errors change their sign between the faces, so that the two halves of a scan disagree.
struct ScannerErrors {
  double angle_noise_ratio = 1.0;
  double range_offset_ratio = 1.0;
  double collimation_rad = 0.0;
  double trunnion_rad = 0.0;
  double vertical_index_rad = 0.0;
  Eigen::Vector4d horizontal_encoder_rad = Eigen::Vector4d::Zero();  ///< factors of sin, cos, sin 2 and cos 2 of the
                                                                     ///< azimuth of the head
  Eigen::Vector4d vertical_encoder_rad = Eigen::Vector4d::Zero();    ///< the same of the elevation of the mirror
  double beam_left_m = 0.0, beam_up_m = 0.0;                         ///< offset of the beam, at the front face
  double range_scale = 0.0;
  double cyclic_sine_m = 0.0, cyclic_cosine_m = 0.0;
  double cyclic_wavelength_m = 1.0;

  /// Returns the deviation of a beam. `head_azimuth_rad`: azimuth of the front face; `elevation_rad`: of the beam.
  BeamDeviation deviation(double head_azimuth_rad, double elevation_rad, bool is_front) const;
  /// Returns the range error of a distance.
  double range_error_m(double range_m) const;
};

/// Samples the instrument of a seed.
ScannerErrors sample_scanner_errors(const ScannerTolerances& tolerances, std::uint64_t seed);

}  // namespace patrol::sim
