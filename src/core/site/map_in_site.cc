#include "core/site/map_in_site.h"

#include <algorithm>
#include <iterator>

namespace patrol {

const SiteRegistration& MapInSite::at(Time stamp) const {
  const auto after = std::upper_bound(registrations_.begin(), registrations_.end(), stamp,
                                      [](Time time, const SiteRegistration& entry) { return time < entry.stamp; });
  return after == registrations_.begin() ? start_ : *std::prev(after);
}

Trajectory MapInSite::place(const Trajectory& T_map_body) const {
  Trajectory path;
  path.reserve(T_map_body.size());
  for (const StampedPose& entry : T_map_body)
    path.push_back({entry.stamp, to_pose3(at(entry.stamp).T_site_map) * entry.pose});
  return path;
}

}  // namespace patrol
