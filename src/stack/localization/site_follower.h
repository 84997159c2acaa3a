#pragma once

#include <optional>
#include <utility>

#include "core/route.h"
#include "core/site/site_registration.h"

namespace patrol::stack {

/// Survey in `map`, moved with the registration of the map to the site.
class SiteFollower {
 public:
  /// `site_in_map`: survey for a map that begins at the surveyed start `T_site_start`. `min_shift_m`: minimum
  /// displacement of any point of the survey for which the survey is moved.
  SiteFollower(Route site_in_map, const Pose2& T_site_start, double min_shift_m)
      : site_in_start_(std::move(site_in_map)),
        T_start_site_(T_site_start.inverse()),
        min_shift_m_(min_shift_m),
        extent_(extent_of(site_in_start_)) {}

  /// Returns the survey in map by a new registration; none if no point has moved by the minimum.
  std::optional<Route> update(const SiteRegistration& registration);

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(T_start_map_);
  }

 private:
  static Eigen::AlignedBox2d extent_of(const Route& route);

  Route site_in_start_;
  Pose2 T_start_site_;
  double min_shift_m_;
  Eigen::AlignedBox2d extent_;  ///< bounding box of start, stations, keep-out lines, anchors and dock
  Pose2 T_start_map_;           ///< pose of map with which the last survey was moved
};

}  // namespace patrol::stack
