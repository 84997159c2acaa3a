#pragma once

#include <vector>

#include "importer/site/sdf_world.h"

namespace patrol::importer {

/// Checks all elements of a world. Returns a row for each kind of element that is ignored or left out, with the number
/// and the place of the first. Throws InputError with file, line and element for elements that are refused:
/// <population>, <image>, gravity other than downward, and insertions of <state>.
std::vector<Assumption> check_elements(const SdfWorld& world);

}  // namespace patrol::importer
