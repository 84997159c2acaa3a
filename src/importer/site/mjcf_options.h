#pragma once

#include <filesystem>
#include <vector>

#include <tinyxml2.h>

#include "importer/assumptions.h"

namespace patrol::importer {

/// Replaces or removes the options of a MuJoCo model that contradict the physics of a site, and returns a row for each
/// element that has such options. The robot becomes part of the model: time step, flags, limits of memory and rules for
/// masses would apply to it, too. `root` is the root element of `file` without its includes. Throws InputError
/// "file:line: <element>: what" for gravity other than that of the earth.
std::vector<Assumption> replace_options(const std::filesystem::path& file, tinyxml2::XMLElement& root);

}  // namespace patrol::importer
