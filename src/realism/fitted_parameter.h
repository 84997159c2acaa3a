#pragma once

#include <string>

namespace patrol::realism {

/// Parameter of a lidar by the fit to a log.
struct FittedParameter {
  std::string name;              ///< key of sensors.lidar, or of as_built.lidar for a systematic error
  double value = 0.0;            ///< maximum of the likelihood
  double low = 0.0, high = 0.0;  ///< 95 % interval
  bool is_seen = false;          ///< whether the log constrains the parameter
  std::string reason = {};       ///< reason for which the log does not constrain it; empty if it does

  bool contains(double truth) const { return low <= truth && truth <= high; }
};

}  // namespace patrol::realism
