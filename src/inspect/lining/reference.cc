#include "inspect/lining/reference.h"

#include "inspect/lining/surface_cloud.h"

namespace patrol::inspect {

LiningReference make_reference(const PanoramicScan& scan, const Pose3& T_map_scanner,
                               const ReferenceSettings& settings) {
  LiningReference reference{.T_map_scanner = T_map_scanner, .points = {}};
  for (const DownsampledPoint& point : downsample(scan.points, settings.spacing_m, settings.min_range_m)) {
    if (point.p.norm() > settings.max_range_m) continue;
    const Eigen::Vector3f p = (T_map_scanner * point.p).cast<float>();
    reference.points.push_back({p.x(), p.y(), p.z(), static_cast<float>(point.intensity)});
  }
  return reference;
}

}  // namespace patrol::inspect
