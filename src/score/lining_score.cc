#include "score/lining_score.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace patrol::score {
namespace {

double true_peak_m(const LiningGroundTruth& truth, int ring) {
  double peak_m = 0.0;
  for (int clock_deg = 0; clock_deg < 360; ++clock_deg) {
    const double displacement_m = truth.inward_m(ring, clock_deg);
    if (std::abs(displacement_m) > std::abs(peak_m)) peak_m = displacement_m;
  }
  return peak_m;
}

RingScore found_ring(const RingFinding& finding, const LiningGroundTruth& truth, const Pose3& T_world_map,
                     const std::string& station, double peak_m) {
  const TunnelLining& design = truth.design;
  const Eigen::Vector3d p_world = design.intrados(design.middle_of_ring_m(finding.ring), finding.clock_deg) +
                                  Eigen::Vector3d(0.0, 0.0, truth.invert_m);
  return {.station = station,
          .ring = finding.ring,
          .true_peak_m = peak_m,
          .is_found = true,
          .reported_m = finding.inward_m,
          .error_m = finding.inward_m - truth.inward_m(finding.ring, finding.clock_deg),
          .peak_error_m = finding.inward_m - peak_m,
          .position_error_m = (T_world_map * finding.p_map - p_world).norm()};
}

void add_rings(const LiningResult& result, const LiningGroundTruth& truth, const Pose3& T_world_map,
               double displacement_m, double still_m, LiningScore& score) {
  std::set<int> in_view;
  for (const LiningCell& cell : result.cells) in_view.insert(cell.ring);
  for (const RingFinding& finding : result.findings) in_view.insert(finding.ring);
  for (const int ring : in_view) {
    const double peak_m = true_peak_m(truth, ring);
    const bool has_moved = std::abs(peak_m) >= displacement_m, is_still = std::abs(peak_m) < still_m;
    const auto finding = std::ranges::find(result.findings, ring, &RingFinding::ring);
    const bool is_found = finding != result.findings.end();
    score.moved_rings += has_moved ? 1 : 0;
    score.missed += has_moved && !is_found ? 1 : 0;
    score.false_findings += is_still && is_found ? 1 : 0;
    if (is_found) score.rings.push_back(found_ring(*finding, truth, T_world_map, result.station, peak_m));
    else if (has_moved) score.rings.push_back({.station = result.station, .ring = ring, .true_peak_m = peak_m});
    if (!is_found || !has_moved) continue;
    const RingScore& ring_score = score.rings.back();
    ++score.found;
    score.max_error_m = std::max(score.max_error_m, std::abs(ring_score.error_m));
    score.max_peak_error_m = std::max(score.max_peak_error_m, std::abs(ring_score.peak_error_m));
    score.max_position_error_m = std::max(score.max_position_error_m, ring_score.position_error_m);
  }
}

}  // namespace

LiningScore lining_score(const std::vector<LiningResult>& results, const LiningGroundTruth& truth, const MapInSite& map,
                         double displacement_m, double still_m) {
  LiningScore score;
  double squares = 0.0;
  int held = 0;
  for (const LiningResult& result : results) {
    const int num_stations = result.station.empty() ? 0 : 1;
    score.stations += num_stations;
    if (!result.is_registered) continue;
    score.registered += num_stations;
    add_rings(result, truth, to_pose3(map.at(result.stamp).T_site_map), displacement_m, still_m, score);
    for (const LiningCell& cell : result.cells) {
      const double error_m = cell.inward_m - truth.inward_m(cell.ring, cell.clock_deg);
      squares += error_m * error_m;
      held += std::abs(error_m) <= 1.96 * cell.std_m ? 1 : 0;
      ++score.cells;
    }
  }
  if (score.cells > 0) {
    score.cell_rmse_m = std::sqrt(squares / score.cells);
    score.cell_coverage_95 = static_cast<double>(held) / score.cells;
  }
  return score;
}

}  // namespace patrol::score
