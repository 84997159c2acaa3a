#pragma once

#include <string>

#include "importer/site/imported_site.h"

namespace patrol::importer {

/// Returns the path of the file of a mesh or a height field, below the folder of the site.
std::string shape_file(const SiteShape& shape);

/// Returns the content of that file: OBJ text of a mesh, or MuJoCo's binary form of a height field (rows, columns,
/// heights as little-endian int32 and float32).
std::string shape_content(const SiteShape& shape);

}  // namespace patrol::importer
