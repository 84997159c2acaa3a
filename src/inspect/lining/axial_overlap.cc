#include "inspect/lining/axial_overlap.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <vector>

namespace patrol::inspect {
namespace {

constexpr double kMinAxialCosine = 0.7;  // minimum cosine between a normal and the axis
constexpr double kOverlapPairDistance_m = 0.15, kOverlapBand_m = 0.03;
constexpr double kMinExcessRange_m = 0.3;  // a beam that is longer by this has passed the point
constexpr int kColumns = 180, kRows = 90;

/// Minimum range of a scan per direction cell of 2 x 2 degrees.
class NearestRanges {
 public:
  explicit NearestRanges(const ScanView& view) : p_scanner_(view.p_scanner), ranges_m_(kColumns * kRows, kNothing) {
    for (const DownsampledPoint& point : view.cloud.points()) {
      double& nearest_m = ranges_m_[cell_of(point.p)];
      nearest_m = std::min(nearest_m, (point.p - p_scanner_).norm());
    }
  }
  bool looks_through(const Eigen::Vector3d& p) const {
    const double nearest_m = ranges_m_[cell_of(p)];
    return nearest_m < kNothing && nearest_m > (p - p_scanner_).norm() + kMinExcessRange_m;
  }

 private:
  static constexpr double kNothing = std::numeric_limits<double>::infinity();

  std::size_t cell_of(const Eigen::Vector3d& p) const {
    const Eigen::Vector3d arm = p - p_scanner_;
    const double turn = std::atan2(arm.y(), arm.x()) / (2.0 * std::numbers::pi) + 0.5;
    const double rise = std::atan2(arm.z(), arm.head<2>().norm()) / std::numbers::pi + 0.5;
    const auto column = std::min<std::size_t>(kColumns - 1, static_cast<std::size_t>(turn * kColumns));
    return std::min<std::size_t>(kRows - 1, static_cast<std::size_t>(rise * kRows)) * kColumns + column;
  }

  Eigen::Vector3d p_scanner_;
  std::vector<double> ranges_m_;
};

}  // namespace

AxialOverlap axial_overlap(const ScanView& one, const ScanView& other, const Pose3& T_other_one,
                           const Eigen::Vector3d& axis_one) {
  const NearestRanges ranges(other);
  AxialOverlap found;
  for (std::size_t i = 0; i < one.cloud.points().size(); ++i) {
    const Eigen::Vector3d& p_one = one.cloud.points()[i].p;
    const Eigen::Vector3d& normal = one.cloud.surfaces()[i].normal;
    const Eigen::Vector3d p = T_other_one * p_one;
    if (std::abs(normal.dot(axis_one)) < kMinAxialCosine) continue;
    const auto near = other.cloud.nearest(p, 1);
    if (near.count > 0 && near.squared_m2[0] < kOverlapPairDistance_m * kOverlapPairDistance_m) {
      const SurfaceCloud::Surface& surface = other.cloud.surfaces()[near.index[0]];
      const bool is_same = std::abs(surface.normal.dot(T_other_one.rotation * normal)) > kMinAxialCosine &&
                           std::abs(surface.normal.dot(p - surface.mean)) < kOverlapBand_m;
      found.num_common += is_same ? 1 : 0;
    } else if (ranges.looks_through(p)) {
      ++found.num_missing;
    }
  }
  return found;
}

}  // namespace patrol::inspect
