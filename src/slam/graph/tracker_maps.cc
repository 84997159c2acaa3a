#include "slam/graph/tracker_maps.h"

#include <utility>

namespace patrol::slam {

TrackerMaps::TrackerMaps(const ScanTrackerSettings& settings)
    : older_(settings.resolution_m, settings.max_extent_m), newer_(settings.resolution_m, settings.max_extent_m) {}

bool TrackerMaps::integrate(const ScanGroup& scans, const Pose2& T_local_body, const ScanTrackerSettings& settings) {
  bool is_start = keyframes_ == 0;
  if (older_keyframes_ >= settings.submap_keyframes) {
    older_ = std::move(newer_);
    older_keyframes_ = newer_keyframes_;
    newer_ = GridMap(settings.resolution_m, settings.max_extent_m);
    newer_keyframes_ = 0;
    ++submap_;
  }
  scans.integrate(T_local_body, settings.integration, older_);
  ++older_keyframes_;
  if (newer_keyframes_ > 0 || older_keyframes_ > settings.submap_keyframes / 2) {
    is_start = is_start || newer_keyframes_ == 0;
    scans.integrate(T_local_body, settings.integration, newer_);
    ++newer_keyframes_;
  }
  ++keyframes_;
  return is_start;
}

}  // namespace patrol::slam
