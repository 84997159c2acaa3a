#include "inspect/lining/lining_inspection.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "inspect/lining/adjustment.h"
#include "inspect/lining/lining_grid.h"
#include "inspect/lining/reference_lining.h"
#include "inspect/lining/registration.h"
#include "inspect/lining/ring_findings.h"
#include "inspect/lining/surface_cloud.h"

namespace patrol::inspect {
namespace {

constexpr double kFacesAlong = 0.7;      // cosine between a normal and the tunnel's axis
constexpr std::size_t kMinGrip = 40;     // fewer points that face along the tunnel say nothing
constexpr double kPartner_m = 0.15, kGripBand_m = 0.03;

std::vector<ThinPoint> thin_points(const LiningReference& reference) {
  std::vector<ThinPoint> points;
  points.reserve(reference.points.size());
  for (const ScannerPoint& point : reference.points) points.push_back({{point.x, point.y, point.z}, point.intensity, 1});
  return points;
}

/// Of a cloud's surfaces that face along the tunnel and lie within reach of the other's scanner, the share that the other has too; 1 where there are
/// too few to say.
double grip_share(const SurfaceCloud& cloud, const SurfaceCloud& other, const Pose3& T_other_cloud, const Eigen::Vector3d& axis_cloud,
                  const Eigen::Vector3d& p_cloud_other, double reach_m) {
  std::size_t count = 0, kept = 0;
  for (std::size_t i = 0; i < cloud.points().size(); ++i) {
    const Eigen::Vector3d& p_cloud = cloud.points()[i].p;
    const Eigen::Vector3d& normal = cloud.surfaces()[i].normal;
    if (std::abs(normal.dot(axis_cloud)) < kFacesAlong || (p_cloud - p_cloud_other).norm() > reach_m) continue;
    ++count;
    const Eigen::Vector3d p = T_other_cloud * p_cloud;
    const auto near = other.nearest(p, 1);
    if (near.count == 0 || near.squared_m2[0] > kPartner_m * kPartner_m) continue;
    const SurfaceCloud::Surface& surface = other.surfaces()[near.index[0]];
    const bool is_same = std::abs(surface.normal.dot(T_other_cloud.rotation * normal)) > kFacesAlong;
    kept += is_same && std::abs(surface.normal.dot(p - surface.mean)) < kGripBand_m ? 1 : 0;
  }
  return count < kMinGrip ? 1.0 : static_cast<double>(kept) / static_cast<double>(count);
}

}  // namespace

LiningInspection::LiningInspection(const LiningSettings& settings, const TunnelLining& design_in_map, const Pose3& T_body_scanner)
    : settings_(settings), design_(design_in_map), T_scanner_body_(to_planar(T_body_scanner).inverse()) {
  validate(settings, "lining");
}

LiningResult LiningInspection::inspect(Time stamp, const std::string& station, const PanoramicScan& scan, const LiningReference& reference,
                                       const Pose3& T_map_scanner_guess) const {
  LiningResult result;
  result.stamp = stamp;
  result.station = station;
  result.T_map_body = to_planar(T_map_scanner_guess) * T_scanner_body_;
  const SurfaceCloud target(thin_points(reference)), source(thin(scan.points, settings_.spacing_m));
  const auto lining = fit_design(design_, target.points(), reference.T_map_scanner.position, settings_);
  if (!lining) return result;

  const Registration coarse = register_cloud(target, source, T_map_scanner_guess, settings_.registration);
  result.registration_share = coarse.share;
  result.registration_rms_m = coarse.rms_m;
  if (!coarse.converged || coarse.share < settings_.min_share) return result;

  const LiningGrid grid(*lining, coarse.T_target_source.position, settings_);
  const ReferenceLining surface(*lining, grid, target.points(), settings_);
  const Adjustment fine = adjust(*lining, grid, surface, target, source, coarse.T_target_source, T_map_scanner_guess, settings_);

  // One of the two scans may show a truck that the other does not, so the better share counts.
  const double heading = lining->design.heading_at(lining->design.place_of(fine.T_map_scanner.position).chainage_m);
  const Eigen::Vector3d axis_map(std::cos(heading), std::sin(heading), 0.0);
  const Pose3 T_scanner_map = fine.T_map_scanner.inverse();
  const double grip = std::max(
      grip_share(source, target, fine.T_map_scanner, T_scanner_map.rotation * axis_map, T_scanner_map * reference.T_map_scanner.position, settings_.reach_m),
      grip_share(target, source, T_scanner_map, axis_map, fine.T_map_scanner.position, settings_.reach_m));
  result.registration_rms_m = fine.rms_m;
  result.correction_m = (fine.T_map_scanner.position - T_map_scanner_guess.position).norm();
  if (grip < settings_.min_grip_share) return result;

  result.is_registered = true;
  result.T_map_body = to_planar(fine.T_map_scanner) * T_scanner_body_;
  result.cells = lining_cells(grid, fine);
  result.lines = convergence_lines(*lining, grid, fine);
  result.findings = ring_findings(*lining, grid, fine, settings_);
  return result;
}

}  // namespace patrol::inspect
