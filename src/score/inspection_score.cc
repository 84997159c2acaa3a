#include "score/inspection_score.h"

#include <set>

namespace patrol::score {

InspectionScore inspection_score(const std::vector<Event>& events, const MapInSite& map,
                                 const std::vector<LeakGroundTruth>& leaks, double max_distance_m) {
  InspectionScore score;
  score.leaks = static_cast<int>(leaks.size());
  std::set<std::string> found;
  for (const Event& event : events) {
    if (event.kind != EventKind::kGasAlarm) continue;
    ScoredAlarm finding{.station = event.subject,
                        .column_ppm_m = event.value,
                        .p_world_m = map.at(event.stamp).T_site_map * event.p_map_target,
                        .leak = "",
                        .error_m = max_distance_m};
    for (const LeakGroundTruth& leak : leaks) {
      const double distance_m = (finding.p_world_m - leak.p_world_m).norm();
      if (distance_m > finding.error_m) continue;
      finding.leak = leak.name;
      finding.error_m = distance_m;
    }
    if (finding.leak.empty()) ++score.false_alarms;
    else found.insert(finding.leak);
    score.findings.push_back(finding);
  }
  score.leaks_found = static_cast<int>(found.size());
  return score;
}

}  // namespace patrol::score
