#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "core/frames.h"
#include "core/site/site_registration.h"
#include "core/time.h"
#include "core/trajectory.h"

namespace patrol {

/// Pose of `map` in the survey frame `site` as the robot knew it at each time: the newest registration, the surveyed
/// start before the first one. The estimates and findings of a robot are placed in site with it.
class MapInSite {
 public:
  /// `registrations` in ascending time order; without any the map is fixed.
  MapInSite(const Pose2& T_site_start = {}, std::vector<SiteRegistration> registrations = {})
      : registrations_(std::move(registrations)),
        start_{.stamp = {}, .T_site_map = T_site_start, .covariance = Eigen::Matrix3d::Zero()} {}

  /// Newest registration that is not later than `stamp`. The surveyed start has a covariance of zero.
  const SiteRegistration& at(Time stamp) const;
  const SiteRegistration& last() const { return registrations_.empty() ? start_ : registrations_.back(); }
  std::size_t num_registrations() const { return registrations_.size(); }
  /// Returns the path in site.
  Trajectory place(const Trajectory& T_map_body) const;

 private:
  std::vector<SiteRegistration> registrations_;
  SiteRegistration start_;
};

}  // namespace patrol
