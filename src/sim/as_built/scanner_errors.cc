#include "sim/as_built/scanner_errors.h"

#include <cmath>
#include <numbers>
#include <string>

#include "core/geometry/angles.h"
#include "core/random.h"

namespace patrol::sim {
namespace {

constexpr double kArcSecond = kDegree / 3600.0;

Eigen::Vector4d harmonics(double angle_rad) {
  return {std::sin(angle_rad), std::cos(angle_rad), std::sin(2.0 * angle_rad), std::cos(2.0 * angle_rad)};
}

}  // namespace

// Collimation and trunnion errors deflect the beam by c and i sin(elevation) perpendicular to the vertical plane; an
// error of the head's azimuth by its product with cos(elevation). The elevation of the mirror is that of the beam at
// the front face and its supplement at the back face, where an increase lowers the beam.
BeamDeviation ScannerErrors::deviation(double head_azimuth_rad, double elevation_rad, bool is_front) const {
  const double face = is_front ? 1.0 : -1.0;
  const double mirror_rad = is_front ? elevation_rad : std::numbers::pi - elevation_rad;
  return {.left_rad = face * (collimation_rad + trunnion_rad * std::sin(elevation_rad)) +
                      std::cos(elevation_rad) * horizontal_encoder_rad.dot(harmonics(head_azimuth_rad)),
          .up_rad = face * (vertical_index_rad + vertical_encoder_rad.dot(harmonics(mirror_rad))),
          .left_m = face * beam_left_m,
          .up_m = face * beam_up_m};
}

double ScannerErrors::range_error_m(double range_m) const {
  const double phase = 2.0 * std::numbers::pi * range_m / cyclic_wavelength_m;
  return range_scale * range_m + cyclic_sine_m * std::sin(phase) + cyclic_cosine_m * std::cos(phase);
}

ScannerErrors sample_scanner_errors(const ScannerTolerances& tolerances, std::uint64_t seed) {
  const auto sample = [seed](const char* term, double std, std::uint64_t index = 0) {
    return std * RandomStream(seed, std::string("as_built/scanner/") + term).normal(0, index);
  };
  const auto encoder = [&](const char* term) {
    const double first = tolerances.eccentricity_std_arcsec * kArcSecond,
                 second = tolerances.encoder_harmonic_std_arcsec * kArcSecond;
    return Eigen::Vector4d(sample(term, first, 0), sample(term, first, 1), sample(term, second, 2),
                           sample(term, second, 3));
  };
  return {.angle_noise_ratio = tolerances.angle_noise_ratio,
          .range_offset_ratio = tolerances.range_offset_ratio,
          .collimation_rad = sample("collimation", tolerances.collimation_std_arcsec * kArcSecond),
          .trunnion_rad = sample("trunnion", tolerances.trunnion_std_arcsec * kArcSecond),
          .vertical_index_rad = sample("vertical_index", tolerances.vertical_index_std_arcsec * kArcSecond),
          .horizontal_encoder_rad = encoder("horizontal_encoder"),
          .vertical_encoder_rad = encoder("vertical_encoder"),
          .beam_left_m = sample("beam_offset", tolerances.beam_offset_std_m, 0),
          .beam_up_m = sample("beam_offset", tolerances.beam_offset_std_m, 1),
          .range_scale = sample("range_scale", tolerances.range_scale_std),
          .cyclic_sine_m = sample("cyclic_range", tolerances.cyclic_range_std_m, 0),
          .cyclic_cosine_m = sample("cyclic_range", tolerances.cyclic_range_std_m, 1),
          .cyclic_wavelength_m = tolerances.cyclic_wavelength_m};
}

}  // namespace patrol::sim
