#pragma once

#include <optional>

#include "core/frames.h"
#include "core/site/geodetic_datum.h"

namespace patrol {

/// Survey of the frame `site`: pose at which the robot is put down, and geodetic datum.
struct SiteFrame {
  Pose2 T_site_start;                       ///< surveyed start, the nominal origin of map
  std::optional<GeodeticDatum> datum = {};  ///< none: GNSS positions cannot be related to the survey
};

}  // namespace patrol
