#pragma once

#include <filesystem>

#include "core/site/site_registration.h"

namespace patrol::io {

/// Reads registration.json, the registration of a saved map to the site. Format: {"position": [x, y, 0.0] in m,
/// "orientation": unit quaternion [x, y, z, w] of map in site, "covariance": 9 numbers, row by row, of x, y, yaw}.
/// Throws InputError with file and key if the file is invalid; the covariance must be symmetric and positive definite.
SiteRegistration load_registration(const std::filesystem::path& file);
/// Writes registration.json. Throws std::runtime_error if the file cannot be written.
void save_registration(const std::filesystem::path& file, const SiteRegistration& registration);

}  // namespace patrol::io
