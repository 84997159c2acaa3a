#pragma once

#include <string>

#include <Eigen/Core>

#include "core/time.h"

namespace patrol::stack {

enum class InstrumentKind { kGas, kLining, kWater };

/// Inspection that a mission requests from an instrument at the present robot pose.
struct InspectionOrder {
  InstrumentKind instrument = InstrumentKind::kGas;
  std::string station;                                     ///< name under which the result is stored
  Time not_before{};                                       ///< readings with an earlier stamp are not used
  Eigen::Vector2d p_map_target = Eigen::Vector2d::Zero();  ///< position of the inspected object, m; used by the methane
                                                           ///< meter

  bool operator==(const InspectionOrder&) const = default;
};

enum class InspectionFeedback { kInProgress, kDone, kFailed };

/// State of an order after a control period.
struct InspectionProgress {
  InspectionFeedback feedback = InspectionFeedback::kInProgress;
  std::string failure = {};  ///< one sentence with kFailed if the instrument reports a reason; otherwise empty
};

}  // namespace patrol::stack
