#include "app/study/study.h"

#include <array>
#include <utility>

#include <fmt/format.h>

#include "app/study/growth_study.h"
#include "app/study/landmark_study.h"
#include "app/study/planner_study.h"
#include "app/study/street_study.h"
#include "app/study/substation_study.h"
#include "core/error.h"

namespace patrol::app {
namespace {

constexpr std::array<std::pair<const char*, Study (*)()>, 8> kStudies = {{{"ungm", growth_study},
                                                                         {"landmarks-circle", circle_study},
                                                                         {"landmarks-noncircular", noncircular_study},
                                                                         {"landmarks-100x80", campus_study},
                                                                         {"street-map", street_study},
                                                                         {"substation", substation_study},
                                                                         {"substation-row", row_study},
                                                                         {"planners", planner_study}}};

}  // namespace

Study make_study(const std::string& name) {
  for (const auto& [known, make] : kStudies) {
    if (name == known) return make();
  }
  throw InputError(fmt::format("there is no study '{}' (known: {})", name, fmt::join(study_names(), ", ")));
}

std::vector<std::string> study_names() {
  std::vector<std::string> names;
  for (const auto& study : kStudies) names.emplace_back(study.first);
  return names;
}

}  // namespace patrol::app
