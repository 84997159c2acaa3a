#pragma once

#include <functional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/frames.h"
#include "core/inspection_result.h"
#include "core/site/map_in_site.h"
#include "core/tunnel_lining.h"

namespace patrol::score {

/// Ground truth of the lining deformation. Inward displacement along the radius is positive, as in LiningCell.
struct LiningGroundTruth {
  TunnelLining design;    ///< design geometry, in world
  double invert_m = 0.0;  ///< height of the design's invert, in world
  /// true inward displacement at a clock position, 0 at the crown
  std::function<double(int ring, double clock_deg)> inward_m;
};

/// Evaluation of one ring at one station: a ring that has moved, or a ring with a finding.
struct RingScore {
  std::string station;
  int ring = 0;
  double true_peak_m = 0.0;  ///< displacement with the largest magnitude on the ring, signed
  bool is_found = false;     ///< the fields below are set only for a finding
  double reported_m = 0.0;
  double error_m = 0.0;       ///< reported minus true displacement at the reported clock position
  double peak_error_m = 0.0;  ///< reported displacement minus true peak
  /// distance from the reported position to the true intrados at the ring's middle and the reported clock position
  double position_error_m = 0.0;
};

/// Evaluation of all stations against the true deformation. A moved ring is found or missed
/// at each registered station that has it in view.
struct LiningScore {
  int stations = 0;
  int registered = 0;   ///< stations whose scan was registered to the reference
  int moved_rings = 0;  ///< moved rings observed at registered stations
  int found = 0;
  int missed = 0;
  int false_findings = 0;
  double max_error_m = 0.0;  ///< maximum |error_m| of the found rings
  double max_peak_error_m = 0.0;
  double max_position_error_m = 0.0;
  int cells = 0;             ///< number of evaluated cells
  double cell_rmse_m = 0.0;  ///< RMS error of the cells' displacement
  /// fraction of cells whose 95 % interval contains the true displacement at the cell's middle
  double cell_coverage_95 = 0.0;
  std::vector<RingScore> rings;  ///< moved rings and rings with a finding
};

/// Evaluates the findings of all stations, placed in site as the robot places them. A ring counts as moved when its
/// peak displacement is at least `displacement_m`, and a finding is false when it is below `still_m`. Between the two
/// limits, a finding and its absence are both correct. A result without the name of a station is evaluated, but not
/// counted as one.
LiningScore lining_score(const std::vector<LiningResult>& results, const LiningGroundTruth& truth, const MapInSite& map,
                         double displacement_m = 0.0025, double still_m = 0.0015);

}  // namespace patrol::score
