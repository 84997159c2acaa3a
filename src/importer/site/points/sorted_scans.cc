#include "importer/site/points/sorted_scans.h"

#include <algorithm>

#include <fmt/format.h>

namespace patrol::importer {

void transform(std::vector<ScannerPoint>& points, const Eigen::Matrix3d& A) {
  if (A.isIdentity()) return;
  for (ScannerPoint& point : points) {
    const Eigen::Vector3f p = (A * Eigen::Vector3f(point.x, point.y, point.z).cast<double>()).cast<float>();
    point.x = p.x();
    point.y = p.y();
    point.z = p.z();
  }
}

SortedScans sort_scans(std::vector<io::StationScan>& scans, const Eigen::Matrix3d& R_site_file, double unit_m,
                       const std::function<void(std::size_t)>& on_scan) {
  constexpr double kMaxHiddenPart = 0.05;
  SortedScans sorted;
  for (io::StationScan& scan : scans) {
    on_scan(sorted.panoramas.size());
    transform(scan.points, unit_m * R_site_file);
    Pose3& T = scan.T_map_scanner;
    T.position = unit_m * R_site_file * T.position;
    T.rotation = Eigen::Quaterniond(R_site_file * T.rotation.toRotationMatrix() * R_site_file.transpose());
    for (const ScannerPoint& point : scan.points)
      sorted.max_intensity = std::max(sorted.max_intensity, point.intensity);
    const Panorama& panorama = sorted.panoramas.emplace_back(scan);
    scan.points = {};
    if (panorama.hidden_part() > kMaxHiddenPart) {
      sorted.problem = fmt::format("{:.0f} % of the points of {} are behind others, as seen from its pose",
                                   100.0 * panorama.hidden_part(), scan.station);
      break;
    }
  }
  return sorted;
}

}  // namespace patrol::importer
