#include "slam/submaps/submap_descriptor.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include <fmt/format.h>

#include "core/error.h"
#include "slam/submaps/point_tree.h"

namespace patrol::slam {
namespace {

Eigen::Vector2d mean_of(const std::vector<Eigen::Vector2d>& points) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& p : points) sum += p;
  return sum / static_cast<double>(points.size());
}

double radius_about(const Eigen::Vector2d& center, const std::vector<Eigen::Vector2d>& points) {
  double squared = 0.0;
  for (const Eigen::Vector2d& p : points) squared += (p - center).squaredNorm();
  return std::sqrt(squared / static_cast<double>(points.size()));
}

void normalize(std::vector<double>& histogram) {
  const double sum = std::accumulate(histogram.begin(), histogram.end(), 0.0);
  for (double& bin : histogram) bin = sum > 0.0 ? bin / sum : 1.0 / static_cast<double>(histogram.size());
}

/// Distributes `weight` linearly over the two bins around `position`, which is in bins from the center of the first
/// bin.
void add_around_circle(std::vector<double>& histogram, double position, double weight) {
  const auto count = static_cast<double>(histogram.size());
  const double wrapped = position - count * std::floor(position / count);
  const auto bin = static_cast<std::size_t>(wrapped);
  const double fraction = wrapped - static_cast<double>(bin);
  histogram[bin % histogram.size()] += (1.0 - fraction) * weight;
  histogram[(bin + 1) % histogram.size()] += fraction * weight;
}

std::vector<double> distance_histogram(const std::vector<Eigen::Vector2d>& points,
                                       const SubmapDescriptorSettings& settings) {
  std::vector<double> histogram(static_cast<std::size_t>(settings.distance_bins), 0.0);
  const auto last = static_cast<double>(settings.distance_bins - 1);
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      // Linear distribution over two bins avoids jumps of whole counts by rounding.
      const double position = std::min(last, (points[i] - points[j]).norm() / settings.distance_bin_m);
      const auto bin = static_cast<std::size_t>(position);
      const double fraction = position - static_cast<double>(bin);
      histogram[bin] += 1.0 - fraction;
      if (fraction > 0.0) histogram[bin + 1] += fraction;
    }
  }
  normalize(histogram);
  return histogram;
}

std::vector<double> direction_histogram(const std::vector<Eigen::Vector2d>& points,
                                        const SubmapDescriptorSettings& settings) {
  std::vector<double> histogram(static_cast<std::size_t>(settings.direction_bins), 0.0);
  for (const SurfaceNormal& surface : surface_normals(PointTree(points), settings.normal_radius_m)) {
    const double direction = std::atan2(surface.normal.y(), surface.normal.x()) + 0.5 * std::numbers::pi;
    add_around_circle(histogram, direction / std::numbers::pi * settings.direction_bins,
                      surface.linearity * surface.linearity);
  }
  normalize(histogram);
  return histogram;
}

}  // namespace

SubmapDescriptor describe_submap(const std::vector<Eigen::Vector2d>& points_submap, const GridMap& map,
                                 const SubmapDescriptorSettings& settings) {
  if (points_submap.size() < 3)
    throw InputError(fmt::format("submap: {} surface points: must be at least 3", points_submap.size()));
  const Eigen::Vector2d center = mean_of(points_submap);
  std::vector<Eigen::Vector2d> points = subsample(points_submap, settings.max_points);
  std::vector<double> distances = distance_histogram(points, settings);
  return {.points = std::move(points),
          .num_points = points_submap.size(),
          .center = center,
          .radius_m = radius_about(center, points_submap),
          .hull = convex_hull(points_submap),
          .distances = std::move(distances),
          .directions = direction_histogram(points_submap, settings),
          .observed = ObservedCells(map, settings.observed_cell_m),
          .ndt = make_ndt(points_submap, settings.ndt)};
}

double histogram_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t bin = 0; bin < a.size(); ++bin) sum += std::abs(a[bin] - b[bin]);
  return 0.5 * sum;
}

double circular_correlation(const std::vector<double>& a, const std::vector<double>& b, int shift) {
  const int bins = static_cast<int>(a.size());
  const double mean_a = std::accumulate(a.begin(), a.end(), 0.0) / bins,
               mean_b = std::accumulate(b.begin(), b.end(), 0.0) / bins;
  double aa = 0.0, ab = 0.0, bb = 0.0;
  for (int bin = 0; bin < bins; ++bin) {
    const double u = a[static_cast<std::size_t>(bin)] - mean_a,
                 v = b[static_cast<std::size_t>(((bin - shift) % bins + bins) % bins)] - mean_b;
    aa += u * u;
    ab += u * v;
    bb += v * v;
  }
  constexpr double kEven = 1e-24;  // rounding tolerance of a uniform histogram
  return aa > kEven && bb > kEven ? ab / std::sqrt(aa * bb) : 0.0;
}

}  // namespace patrol::slam
