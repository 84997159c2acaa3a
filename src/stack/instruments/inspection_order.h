#pragma once

#include <Eigen/Core>

#include <string>

#include "core/time.h"

namespace patrol::stack {

enum class InstrumentKind { kGas, kLining, kWater };

/// Work that a mission asks of an instrument at the place where the robot stands.
struct InspectionOrder {
  InstrumentKind instrument = InstrumentKind::kGas;
  std::string station;                                     ///< name under which the result is filed
  Time not_before{};                                       ///< readings with an earlier stamp are not used
  Eigen::Vector2d p_map_target = Eigen::Vector2d::Zero();  ///< place that is inspected, m; used by the methane meter

  bool operator==(const InspectionOrder&) const = default;
};

enum class InspectionFeedback { kUnderWay, kDone, kFailed };

/// State of an order after a control period.
struct InspectionProgress {
  InspectionFeedback feedback = InspectionFeedback::kUnderWay;
  std::string failure = {};  ///< one sentence with kFailed, from instruments that know the reason; else empty
};

}  // namespace patrol::stack
