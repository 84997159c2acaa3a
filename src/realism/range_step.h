#pragma once

#include <vector>

#include "realism/fitted_parameter.h"

namespace patrol::realism {

/// Finds the quantization step of ranges: the largest step of which all ranges are multiples within the precision of
/// single floats. No site and no pose is needed. A step below 0.1 mm counts as none.
FittedParameter fit_range_step(const std::vector<float>& ranges_m);

}  // namespace patrol::realism
