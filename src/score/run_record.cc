#include "score/run_record.h"

#include <algorithm>

namespace patrol::score {

std::size_t RunRecord::num_events(EventKind kind) const {
  return static_cast<std::size_t>(std::ranges::count(events, kind, &Event::kind));
}

bool RunRecord::has_estimate() const {
  constexpr std::size_t kMinPoses = 3;  // a trajectory can be fitted to them
  return T_map_body.size() >= kMinPoses;
}

bool RunRecord::has_map() const { return !map.values().empty(); }

}  // namespace patrol::score
