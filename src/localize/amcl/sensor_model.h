#pragma once

#include <vector>

#include "core/frames.h"
#include "core/messages.h"

namespace patrol::localize {

/// Likelihoods of a scan at many poses.
struct ScanLikelihoods {
  /// [pose], mean over the beams of log(likelihood / maximum likelihood); 0 is the maximum of every beam.
  std::vector<double> mean_log;
  int num_beams = 0;  ///< number of evaluated beams; 0: the scan has no information, all poses are equal
};

/// Interface of a sensor model p(z | x, m) of a 2D scan [Thrun05, chapter 6].
class SensorModel {
 public:
  virtual ~SensorModel() = default;
  virtual ScanLikelihoods evaluate(const LevelScan& scan, const std::vector<Pose2>& T_map_body) const = 0;
};

}  // namespace patrol::localize
