#include "app/study/study_table.h"

#include <array>
#include <utility>

#include <fmt/format.h>

#include "app/study/lidar_study.h"
#include "app/study/planner_study.h"
#include "app/study/scan_import_study.h"
#include "app/study/scan_navigation_study.h"
#include "app/study/street_study.h"
#include "app/study/substation_study.h"
#include "core/error.h"
#include "core/text.h"
#include "studies/growth_study.h"
#include "studies/landmark_study.h"

namespace patrol::app {
namespace {

constexpr std::array<std::pair<const char*, studies::Study (*)()>, 12> kStudies = {
    {{"ungm", studies::growth_study},
     {"landmarks-circle", studies::circle_study},
     {"landmarks-noncircular", studies::noncircular_study},
     {"landmarks-100x80", studies::campus_study},
     {"street-map", street_study},
     {"substation", substation_study},
     {"substation-row", row_study},
     {"planners", planner_study},
     {"lidar-calibration", lidar_study},
     {"scan-import", scan_import_study},
     {"scan-navigation", scan_navigation_study},
     {"scan-navigation-substation", scan_navigation_substation_study}}};

}  // namespace

studies::Study make_study(const std::string& name) {
  for (const auto& [study_name, make] : kStudies) {
    if (name == study_name) return make();
  }
  throw InputError(fmt::format("unknown study '{}' (known: {})", name, join(study_names(), ", ")));
}

std::vector<std::string> study_names() {
  std::vector<std::string> names;
  for (const auto& study : kStudies) names.emplace_back(study.first);
  return names;
}

}  // namespace patrol::app
