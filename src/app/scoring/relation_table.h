#pragma once

#include <string>

#include "score/relation_error.h"

namespace patrol::app {

/// The benchmark's figures for a terminal, in the digits in which they are published.
std::string relation_table(const score::RelationError& error);

}  // namespace patrol::app
