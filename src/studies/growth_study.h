#pragma once

#include "studies/study.h"

namespace patrol::studies {

/// Study of [Cui21, table 1]: particle filters of the univariate growth model, compared with the exact Bayes filter as
/// a bound.
Study growth_study();

}  // namespace patrol::studies
