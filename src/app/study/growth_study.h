#pragma once

#include "app/study/study.h"

namespace patrol::app {

/// Paper 001, table 1: particle filters of the univariate growth model, beside the exact Bayes filter that bounds them all.
Study growth_study();

}  // namespace patrol::app
