#pragma once

#include "app/study/study.h"

namespace patrol::app {

/// Study of [Cui21, table 1]: particle filters of the univariate growth model, compared with the exact Bayes filter as
/// a bound.
Study growth_study();

}  // namespace patrol::app
