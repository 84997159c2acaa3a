#pragma once

#include <cstddef>
#include <filesystem>

#include "core/trajectory.h"

namespace patrol::io {

/// Treatment of a pose with the stamp of the previous one: a log may have several scans with one stamp
/// (io/logs/scan_log.h).
enum class SameStamps { kRefuse, kKeepFirst };

/// Read and write TUM trajectories [Sturm12]: "seconds x y z qx qy qz qw", one pose per line, increasing stamps; '#'
/// starts a comment. Stamps are exact to the nanosecond, also for seconds since 1970. `load_tum` throws InputError with
/// file and line for invalid lines, and for positions further than 100,000 km from the origin. `num_left_out`: number
/// of poses that kKeepFirst leaves out.
Trajectory load_tum(const std::filesystem::path& file, SameStamps same_stamps = SameStamps::kRefuse,
                    std::size_t* num_left_out = nullptr);
void save_tum(const std::filesystem::path& file, const Trajectory& trajectory, const std::string& comment);

}  // namespace patrol::io
