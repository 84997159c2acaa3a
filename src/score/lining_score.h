#pragma once

#include <Eigen/Core>

#include <functional>
#include <string>
#include <vector>

#include "core/frames.h"
#include "core/inspection_result.h"
#include "core/tunnel_lining.h"

namespace patrol::score {

/// What was really there. Inwards is positive, along the radius, as in LiningCell.
struct TrueLining {
  TunnelLining design;     ///< in world
  double invert_m = 0.0;   ///< height of the design's invert in world
  std::function<double(int ring, double clock_deg)> inward_m;
};

/// A ring that has really moved, as one station saw it; or a finding where nothing has.
struct RingScore {
  std::string station;
  int ring = 0;
  double true_peak_m = 0.0;      ///< the largest move anywhere on the ring, with its sign
  bool is_found = false;         ///< what follows is said only then
  double reported_m = 0.0;
  double error_m = 0.0;          ///< reported less the true move at the reported clock position
  double peak_error_m = 0.0;     ///< reported less the true peak
  double place_error_m = 0.0;    ///< from the reported place to the true intrados at the ring's middle and the reported clock position
};

struct LiningScore {
  int stations = 0;
  int registered = 0;            ///< of those
  int moved_rings = 0;           ///< that a registered station had in view
  int found = 0;
  int missed = 0;
  int false_findings = 0;
  double max_error_m = 0.0;      ///< largest |error| of found rings; likewise
  double max_peak_error_m = 0.0;
  double max_place_error_m = 0.0;
  int cells = 0;
  double cell_rmse_m = 0.0;
  double cell_coverage_95 = 0.0; ///< share of cells whose 95 % interval holds the true move at their middle
  std::vector<RingScore> rings;  ///< moved ones and false findings
};

/// A ring must be found that has moved by `moved_m` or more somewhere; a finding is false where nothing has moved by `still_m`. In between either is right.
LiningScore lining_score(const std::vector<LiningResult>& results, const TrueLining& truth, const Pose3& T_world_map, double moved_m = 0.0025,
                         double still_m = 0.0015);

}  // namespace patrol::score
