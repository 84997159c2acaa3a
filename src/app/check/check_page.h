#pragma once

#include <vector>

#include "app/check/check_pictures.h"
#include "app/check/run_check.h"
#include "report/blocks.h"

namespace patrol::app {

/// Report page of a check drive: the verdict, pictures, figures with their limits, paths, and motors over time.
report::Page check_page(const CheckResult& result, const std::vector<CheckPicture>& pictures);

}  // namespace patrol::app
