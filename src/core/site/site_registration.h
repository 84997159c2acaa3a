#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "core/frames.h"
#include "core/time.h"

namespace patrol {

namespace frame_id {
inline constexpr const char* kSite = "site";
}  // namespace frame_id

/// Estimated pose of `map` in the survey frame `site`. It is valid from its stamp until the next registration.
struct SiteRegistration {
  Time stamp{};
  Pose2 T_site_map;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< covariance of x, y, yaw in site; m, m, rad
};

}  // namespace patrol
