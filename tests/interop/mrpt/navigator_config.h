#pragma once

#include <vector>

#include <Eigen/Core>
#include <mrpt/config/CConfigFileMemory.h>

#include "navigation_settings.h"

namespace mrpt_stack {

/// Sets every parameter of the reactive navigator that differs from MRPT's defaults.
void configure(mrpt::config::CConfigFileMemory& config, const std::vector<Eigen::Vector2d>& footprint_m,
               const NavigationSettings& settings);

}  // namespace mrpt_stack
