#include "inspect/lining/surface_cloud.h"

#include <algorithm>
#include <cmath>
#include <compare>
#include <numbers>
#include <utility>

#include <Eigen/Eigenvalues>
#include <fmt/format.h>
#include <nanoflann.hpp>

#include "core/error.h"
#include "core/geometry/linear_algebra.h"

namespace patrol::inspect {
namespace {

constexpr double kMinRange_m = 0.01, kMaxRange_m = 1e4;
// Limits on the principal variances of a surface. Smallest over middle: at most kThickness. Middle over largest: at
// least kNarrowness, because a row of points is not a surface.
constexpr double kThickness = 0.1, kNarrowness = 0.01;

struct Cloud {
  std::vector<DownsampledPoint> points;

  std::size_t kdtree_get_point_count() const { return points.size(); }
  double kdtree_get_pt(std::size_t index, std::size_t axis) const {
    return points[index].p[static_cast<Eigen::Index>(axis)];
  }
  template <typename Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Cloud>, Cloud, 3, std::uint32_t>;

/// Direction cell of a beam, about one spacing wide at the range of the point. Spatial cells would assign points by
/// their noise where a wall runs along a cell boundary. This would bias the means by up to half the standard deviation
/// of the noise.
struct Beam {
  std::uint64_t cell = 0;
  float range_m = 0.0F;
  std::uint32_t point = 0;
  auto operator<=>(const Beam&) const = default;  // NOLINT(modernize-use-nullptr): no pointer here
};

Beam beam_of(const ScannerPoint& point, std::uint32_t index, double spacing_m) {
  const double across = std::hypot(static_cast<double>(point.x), static_cast<double>(point.y)),
               range = std::hypot(across, static_cast<double>(point.z));
  const int octave = std::clamp(static_cast<int>(std::lround(std::log2(std::max(range, kMinRange_m)))), -8, 14);
  const double angle = spacing_m / std::exp2(octave);
  const double row = std::floor((std::atan2(static_cast<double>(point.z), across) + 0.5 * std::numbers::pi) / angle);
  const double columns =
      std::max(1.0, std::ceil(2.0 * std::numbers::pi * std::cos((row + 0.5) * angle - 0.5 * std::numbers::pi) / angle));
  const double turn =
      (std::atan2(static_cast<double>(point.y), static_cast<double>(point.x)) / std::numbers::pi + 1.0) / 2.0;
  const auto bits = [](double value) { return static_cast<std::uint64_t>(value); };
  return {.cell = bits(octave + 8) << 56U | bits(row) << 28U | bits(turn * columns),
          .range_m = static_cast<float>(range),
          .point = index};
}

void check(const ScannerPoint& point) {
  for (const float value : {point.x, point.y, point.z}) {
    if (!(std::abs(value) <= kMaxRange_m)) {
      throw InputError(fmt::format("scan point ({}, {}, {}): must be finite and within {} m", point.x, point.y, point.z,
                                   kMaxRange_m));
    }
  }
}

}  // namespace

std::vector<DownsampledPoint> downsample(const std::vector<ScannerPoint>& points, double spacing_m,
                                         double min_range_m) {
  std::vector<Beam> beams;
  beams.reserve(points.size());
  for (const ScannerPoint& point : points) {
    check(point);
    const Beam beam = beam_of(point, static_cast<std::uint32_t>(&point - points.data()), spacing_m);
    if (static_cast<double>(beam.range_m) >= min_range_m) beams.push_back(beam);
  }
  std::ranges::sort(beams);
  std::vector<DownsampledPoint> downsampled;
  for (std::size_t begin = 0, end = 0; begin < beams.size(); begin = end) {
    DownsampledPoint mean;
    for (; end < beams.size() && beams[end].cell == beams[begin].cell &&
           beams[end].range_m - beams[begin].range_m <= static_cast<float>(spacing_m);
         ++end) {
      const ScannerPoint& point = points[beams[end].point];
      mean.p += Eigen::Vector3d(point.x, point.y, point.z);
      mean.intensity += point.intensity;
      ++mean.count;
    }
    mean.p /= mean.count;
    mean.intensity /= mean.count;
    downsampled.push_back(mean);
  }
  return downsampled;
}

struct SurfaceCloud::Index {
  explicit Index(std::vector<DownsampledPoint> points) : cloud{std::move(points)}, tree(3, cloud) {}
  Cloud cloud;
  Tree tree;
};

namespace {

SurfaceCloud::Surface surface_of(const std::vector<DownsampledPoint>& points, const SurfaceCloud::Neighbors& near) {
  SurfaceCloud::Surface surface;
  for (std::size_t i = 0; i < near.count; ++i)
    surface.mean += points[near.index[i]].p / static_cast<double>(near.count);
  if (near.count < 5) return surface;
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < near.count; ++i) {
    const Eigen::Vector3d offset = points[near.index[i]].p - surface.mean;
    scatter += offset * offset.transpose();
  }
  const SymmetricEigen<3> axes = symmetric_eigen_direct(scatter);
  const Eigen::Vector3d& spread = axes.values;
  if (spread[0] < kThickness * spread[1] && spread[1] > kNarrowness * spread[2]) surface.normal = axes.vectors.col(0);
  return surface;
}

}  // namespace

SurfaceCloud::SurfaceCloud(std::vector<DownsampledPoint> points) : index_(std::make_unique<Index>(std::move(points))) {
  surfaces_.reserve(this->points().size());
  for (const DownsampledPoint& point : this->points())
    surfaces_.push_back(surface_of(this->points(), nearest(point.p, kNumNeighbors)));
}
SurfaceCloud::~SurfaceCloud() = default;
SurfaceCloud::SurfaceCloud(SurfaceCloud&&) noexcept = default;
SurfaceCloud& SurfaceCloud::operator=(SurfaceCloud&&) noexcept = default;

const std::vector<DownsampledPoint>& SurfaceCloud::points() const { return index_->cloud.points; }

SurfaceCloud::Neighbors SurfaceCloud::nearest(const Eigen::Vector3d& p, std::size_t count) const {
  Neighbors found;
  if (points().empty()) return found;
  found.count =
      index_->tree.knnSearch(p.data(), std::min(count, kNumNeighbors), found.index.data(), found.squared_m2.data());
  return found;
}

}  // namespace patrol::inspect
