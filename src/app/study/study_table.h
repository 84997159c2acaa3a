#pragma once

#include <string>
#include <vector>

#include "studies/study.h"

namespace patrol::app {

/// Creates a study by name. Throws InputError with the known names.
studies::Study make_study(const std::string& name);
std::vector<std::string> study_names();

}  // namespace patrol::app
