#pragma once

#include <vector>

#include "core/frames.h"
#include "core/messages.h"

namespace patrol::localize {

/// How well a scan fits to each of many poses.
struct ScanLikelihoods {
  /// [pose] mean over the beams of log(likelihood / largest likelihood): 0 the best, at every beam.
  std::vector<double> mean_log;
  int num_beams = 0;  ///< that were looked at; 0: the scan says nothing, all poses fit alike
};

/// p(z | x, m) of a 2D scan (Thrun, Burgard, Fox, Probabilistic Robotics, 2005, chapter 6).
class SensorModel {
 public:
  virtual ~SensorModel() = default;
  virtual ScanLikelihoods evaluate(const LevelScan& scan, const std::vector<Pose2>& T_map_body) const = 0;
};

}  // namespace patrol::localize
