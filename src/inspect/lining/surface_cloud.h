#pragma once

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/sensors/registry.h"

namespace patrol::inspect {

/// The mean of neighbouring beams that hit the same surface. On a curved wall it lies within spacing^2 / (12 radius) of it.
struct ThinPoint {
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  double intensity = 0.0;
  int count = 0;  ///< of the scan's points
};

/// Points in the scanner's frame, averaged to about a spacing; never across a step in range of more than that. What is nearer than
/// `near_m` is left out. Throws InputError when a point is
/// not finite or farther than 10 km.
std::vector<ThinPoint> thin(const std::vector<ScannerPoint>& points, double spacing_m, double near_m = 0.0);

/// Thinned points that know their surfaces (nanoflann's k-d tree). Equal distances are settled the same way every time.
class SurfaceCloud {
 public:
  explicit SurfaceCloud(std::vector<ThinPoint> points);
  ~SurfaceCloud();
  SurfaceCloud(SurfaceCloud&&) noexcept;
  SurfaceCloud& operator=(SurfaceCloud&&) noexcept;

  static constexpr std::size_t kNeighbours = 10;
  struct Surface {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();    ///< of the nearest points
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< unit, either side; zero where they are no surface
  };

  const std::vector<ThinPoint>& points() const;
  /// [point]: the principal plane of its nearest points.
  const std::vector<Surface>& surfaces() const { return surfaces_; }

  struct Neighbours {
    std::size_t count = 0;
    std::array<std::uint32_t, kNeighbours> index{};  ///< nearest first
    std::array<double, kNeighbours> squared_m2{};
  };
  Neighbours nearest(const Eigen::Vector3d& p, std::size_t count) const;

 private:
  struct Index;
  std::unique_ptr<Index> index_;
  std::vector<Surface> surfaces_;
};

}  // namespace patrol::inspect
