#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace patrol::importer {

/// Kinds of files that become a site.
enum class SiteFormat : std::uint8_t { kPlan, kLog, kMesh, kSdf, kMjcf, kCloud, kScans };

/// Returns the format of a file by its extension, in any case. A folder and an E57 file have scans; a PLY file with
/// faces is a mesh, one without is a cloud. Throws InputError with the known extensions.
SiteFormat site_format(const std::filesystem::path& file);

/// Throws InputError for an option of the command line, such as "--scale", that has no effect on files of the format of
/// `file`. Options that are not specific to a format are accepted.
void refuse_unused_options(const std::filesystem::path& file, const std::vector<std::string>& options);

}  // namespace patrol::importer
