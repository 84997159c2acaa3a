#pragma once

namespace patrol {

/// 95 % quantile of the chi-squared distribution with three degrees of freedom.
inline constexpr double kChiSquared95Of3 = 7.814728;

}  // namespace patrol
