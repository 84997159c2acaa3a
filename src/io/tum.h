#pragma once

#include <filesystem>

#include "core/trajectory.h"

namespace patrol::io {

/// What to do with a pose of the stamp of the one before: a log may have several scans of one stamp (io/scan_log.h).
enum class SameStamps { kRefuse, kKeepFirst };

/// TUM trajectories: "seconds x y z qx qy qz qw", one pose a line, stamps growing; '#' begins a comment. Stamps are exact to the
/// nanosecond, those since 1970 too. Throws InputError with file and line for anything else.
Trajectory load_tum(const std::filesystem::path& file, SameStamps same_stamps = SameStamps::kRefuse);
void save_tum(const std::filesystem::path& file, const Trajectory& trajectory, const std::string& comment);

}  // namespace patrol::io
