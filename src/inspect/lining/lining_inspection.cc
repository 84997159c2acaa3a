#include "inspect/lining/lining_inspection.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "inspect/lining/adjustment.h"
#include "inspect/lining/axial_overlap.h"
#include "inspect/lining/lining_grid.h"
#include "inspect/lining/reference_lining.h"
#include "inspect/lining/registration.h"
#include "inspect/lining/ring_findings.h"
#include "inspect/lining/surface_cloud.h"

namespace patrol::inspect {
namespace {

std::vector<DownsampledPoint> to_downsampled(const LiningReference& reference) {
  std::vector<DownsampledPoint> points;
  points.reserve(reference.points.size());
  for (const ScannerPoint& point : reference.points)
    points.push_back({{point.x, point.y, point.z}, point.intensity, 1});
  return points;
}

/// Returns whether the two scans are of one position: the position along the tunnel is constrained, and axial surfaces
/// overlap. One scan may contain a truck that the other does not, so the larger of both overlap ratios is tested.
bool is_same_position(const ScanView& source, const ScanView& target_map, const Adjustment& fine,
                      const Eigen::Vector3d& axis_map, const LiningSettings& settings) {
  const Eigen::Matrix3d covariance_m2 = fine.covariance.topLeftCorner<3, 3>();
  if (std::sqrt(axis_map.dot(covariance_m2 * axis_map)) > settings.max_along_std_m) return false;
  const Pose3 T_source_map = fine.T_map_scanner.inverse();
  const AxialOverlap there = axial_overlap(source, target_map, fine.T_map_scanner, T_source_map.rotation * axis_map);
  const AxialOverlap back = axial_overlap(target_map, source, T_source_map, axis_map);
  return std::max(there.ratio(), back.ratio()) >= settings.min_axial_overlap;
}

}  // namespace

LiningInspection::LiningInspection(const LiningSettings& settings, TunnelLining design_in_map,
                                   const Pose3& T_body_scanner)
    : settings_(settings), design_(std::move(design_in_map)), T_scanner_body_(to_pose2(T_body_scanner).inverse()) {
  validate(settings, "lining");
}

LiningResult LiningInspection::inspect(Time stamp, const std::string& station, const PanoramicScan& scan,
                                       const LiningReference& reference, const Pose3& T_map_scanner_guess) const {
  LiningResult result;
  result.stamp = stamp;
  result.station = station;
  result.T_map_body = to_pose2(T_map_scanner_guess) * T_scanner_body_;
  const SurfaceCloud target(to_downsampled(reference)),
      source(downsample(scan.points, settings_.spacing_m, settings_.min_range_m));
  const auto lining = fit_design(design_, target.points(), reference.T_map_scanner.position, settings_);
  if (!lining) return result;

  const Registration coarse = register_cloud(target, source, T_map_scanner_guess, settings_.registration);
  result.registration_inlier_ratio = coarse.inlier_ratio;
  result.registration_rms_m = coarse.rms_m;
  if (!coarse.converged || coarse.inlier_ratio < settings_.min_inlier_ratio) return result;

  const LiningGrid grid(*lining, coarse.T_target_source.position, settings_);
  const ReferenceLining surface(*lining, grid, target.points(), settings_);
  const Adjustment fine =
      adjust(*lining, grid, surface, target, source, coarse.T_target_source, T_map_scanner_guess, settings_);

  const double heading =
      lining->design.heading_at(lining->design.to_tunnel_coordinates(fine.T_map_scanner.position).chainage_m);
  result.registration_rms_m = fine.rms_m;
  result.correction_m = (fine.T_map_scanner.position - T_map_scanner_guess.position).norm();
  if (result.correction_m > settings_.max_correction_m) return result;
  if (!is_same_position({source}, {target, reference.T_map_scanner.position}, fine,
                        {std::cos(heading), std::sin(heading), 0.0}, settings_))
    return result;

  result.is_registered = true;
  result.T_map_body = to_pose2(fine.T_map_scanner) * T_scanner_body_;
  result.cells = lining_cells(grid, fine);
  result.lines = convergence_lines(*lining, grid, fine);
  result.findings = ring_findings(*lining, grid, fine, settings_);
  return result;
}

}  // namespace patrol::inspect
