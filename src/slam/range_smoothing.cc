#include "slam/range_smoothing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

namespace patrol::slam {
namespace {

constexpr double kHalfWidth = 2.5;  ///< half width of the neighborhood along the arc, in standard deviations
constexpr std::size_t kMinNeighbors = 2, kMaxNeighbors = 12;  ///< numbers of neighbors on each side
constexpr double kBiweight = 3.5;                             ///< residual of weight zero, in standard deviations
constexpr double kInitialScale = 4.0;                         ///< scale of the first weights, in standard deviations
constexpr int kInitialIterations = 2, kMaxIterations = 8;
constexpr double kConverged_m = 1e-3;
constexpr double kMinWeight = 0.3;  ///< minimum weight of a range on the surface
constexpr int kMinOnSurface = 3;
constexpr double kMinInverse_per_m = 0.01;

struct Neighbor {
  double cosine = 1.0, sine = 0.0;  ///< cosine and sine of the angle from the beam in the middle
  double range_m = 0.0;
  double weight = 0.0;
};

/// Straight surface: 1 / range = ahead * cosine + across * sine.
struct Surface {
  double ahead_per_m = 0.0, across_per_m = 0.0;

  double inverse_per_m(const Neighbor& at) const {
    return std::max(kMinInverse_per_m, ahead_per_m * at.cosine + across_per_m * at.sine);
  }
  double middle_m() const { return 1.0 / inverse_per_m(Neighbor{}); }
};

bool is_return(float range_m) { return std::isfinite(range_m) && range_m > 0.0F; }

/// Median of the returns of a beam and its two neighbors on each side.
double median_around(const std::vector<float>& ranges_m, std::size_t beam) {
  std::array<double, 2 * kMinNeighbors + 1> around{};
  std::ptrdiff_t count = 0;
  const std::size_t last = std::min(beam + kMinNeighbors, ranges_m.size() - 1);
  for (std::size_t i = beam - std::min(beam, kMinNeighbors); i <= last; ++i) {
    if (is_return(ranges_m[i])) around[static_cast<std::size_t>(count++)] = ranges_m[i];
  }
  const auto middle = around.begin() + count / 2;
  std::nth_element(around.begin(), middle, around.begin() + count);
  return *middle;
}

/// A Gauss-Newton step of the weighted residuals of the ranges; none if one beam alone has weight.
std::optional<Surface> improved(const Surface& surface, const std::vector<Neighbor>& neighbors) {
  double cc = 0.0, cs = 0.0, ss = 0.0, ct = 0.0, st = 0.0;
  for (const Neighbor& neighbor : neighbors) {
    const double inverse = surface.inverse_per_m(neighbor), squared = 1.0 / (inverse * inverse);
    const double target = inverse - (neighbor.range_m - 1.0 / inverse) / squared,
                 weight = neighbor.weight * squared * squared;
    cc += weight * neighbor.cosine * neighbor.cosine;
    cs += weight * neighbor.cosine * neighbor.sine;
    ss += weight * neighbor.sine * neighbor.sine;
    ct += weight * neighbor.cosine * target;
    st += weight * neighbor.sine * target;
  }
  const double determinant = cc * ss - cs * cs;
  if (!(determinant > 1e-9 * cc * ss)) return std::nullopt;
  return Surface{.ahead_per_m = (ss * ct - cs * st) / determinant, .across_per_m = (cc * st - cs * ct) / determinant};
}

/// Range of the surface in the middle of the neighbors; none if too few of them are on one.
std::optional<double> fitted_range(double start_m, double range_std_m, std::vector<Neighbor>& neighbors) {
  Surface surface{.ahead_per_m = 1.0 / start_m};
  for (Neighbor& neighbor : neighbors) {
    const double scaled = (neighbor.range_m - start_m) / (kInitialScale * range_std_m);
    neighbor.weight = std::exp(-0.5 * scaled * scaled);
  }
  int num_on_surface = 0;
  for (int iteration = 1; iteration <= kMaxIterations; ++iteration) {
    const std::optional<Surface> next = improved(surface, neighbors);
    if (!next) return std::nullopt;
    const double change_m = std::abs(next->middle_m() - surface.middle_m());
    surface = *next;
    if (iteration < kInitialIterations) continue;
    num_on_surface = 0;
    for (Neighbor& neighbor : neighbors) {
      const double residual_m = neighbor.range_m - 1.0 / surface.inverse_per_m(neighbor),
                   scaled = residual_m / (kBiweight * range_std_m), inside = std::max(0.0, 1.0 - scaled * scaled);
      neighbor.weight = inside * inside;
      num_on_surface += neighbor.weight > kMinWeight ? 1 : 0;
    }
    if (iteration > kInitialIterations && change_m < kConverged_m) break;
  }
  return num_on_surface >= kMinOnSurface ? std::optional(surface.middle_m()) : std::nullopt;
}

}  // namespace

std::vector<float> smoothed_ranges(const LaserScan& scan, double range_std_m) {
  const std::vector<float>& measured_m = scan.ranges_m;
  const double step_rad = std::abs(scan.angle_increment_rad);
  std::array<double, kMaxNeighbors + 1> cosines{}, sines{};  // of the angles between beams, [number of beams apart]
  for (std::size_t apart = 0; apart < cosines.size(); ++apart) {
    cosines[apart] = std::cos(static_cast<double>(apart) * step_rad);
    sines[apart] = std::sin(static_cast<double>(apart) * step_rad);
  }
  std::vector<float> smoothed_m = measured_m;
  std::vector<Neighbor> neighbors;
  for (std::size_t beam = 0; beam < measured_m.size(); ++beam) {
    if (!is_return(measured_m[beam])) continue;
    const double start_m = median_around(measured_m, beam), reach = kHalfWidth * range_std_m / (start_m * step_rad);
    if (!(reach >= static_cast<double>(kMinNeighbors))) continue;
    const auto num_neighbors = static_cast<std::size_t>(std::min(reach, static_cast<double>(kMaxNeighbors)));
    const std::size_t last = std::min(beam + num_neighbors, measured_m.size() - 1);
    neighbors.clear();
    for (std::size_t i = beam - std::min(beam, num_neighbors); i <= last; ++i) {
      if (!is_return(measured_m[i])) continue;
      const std::size_t apart = i < beam ? beam - i : i - beam;
      neighbors.push_back(
          {.cosine = cosines[apart], .sine = i < beam ? -sines[apart] : sines[apart], .range_m = measured_m[i]});
    }
    const std::optional<double> fitted_m = fitted_range(start_m, range_std_m, neighbors);
    if (fitted_m && std::abs(*fitted_m - static_cast<double>(measured_m[beam])) < kBiweight * range_std_m)
      smoothed_m[beam] = static_cast<float>(*fitted_m);
  }
  return smoothed_m;
}

}  // namespace patrol::slam
