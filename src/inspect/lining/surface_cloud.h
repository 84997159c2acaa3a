#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "core/sensors/registry.h"

namespace patrol::inspect {

/// Mean of neighboring beams on one surface. On a curved wall its distance to the wall is at most spacing^2 / (12
/// radius).
struct DownsampledPoint {
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  double intensity = 0.0;
  int count = 0;  ///< number of averaged scan points
};

/// Downsamples points, given in the scanner frame, to about the spacing, but never across a range step larger than the
/// spacing. Points closer than `min_range_m` are excluded. Throws InputError for points that are not finite or farther
/// than 10 km.
std::vector<DownsampledPoint> downsample(const std::vector<ScannerPoint>& points, double spacing_m,
                                         double min_range_m = 0.0);

/// Downsampled points with their local surfaces, in a k-d tree (nanoflann). Ties in distance are resolved
/// deterministically.
class SurfaceCloud {
 public:
  explicit SurfaceCloud(std::vector<DownsampledPoint> points);
  ~SurfaceCloud();
  SurfaceCloud(const SurfaceCloud&) = delete;
  SurfaceCloud& operator=(const SurfaceCloud&) = delete;
  SurfaceCloud(SurfaceCloud&&) noexcept;
  SurfaceCloud& operator=(SurfaceCloud&&) noexcept;

  static constexpr std::size_t kNumNeighbors = 10;
  struct Surface {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();  ///< mean of the nearest points
    /// Unit vector of either sign; zero if the points do not form a surface.
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  };

  const std::vector<DownsampledPoint>& points() const;
  /// [point]: principal plane of the nearest points.
  const std::vector<Surface>& surfaces() const { return surfaces_; }

  struct Neighbors {
    std::size_t count = 0;
    std::array<std::uint32_t, kNumNeighbors> index{};  ///< indices of the points by increasing distance
    std::array<double, kNumNeighbors> squared_m2{};
  };
  Neighbors nearest(const Eigen::Vector3d& p, std::size_t count) const;

 private:
  struct Index;
  std::unique_ptr<Index> index_;
  std::vector<Surface> surfaces_;
};

}  // namespace patrol::inspect
