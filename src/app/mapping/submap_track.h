#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "app/progress_bar.h"
#include "core/time.h"
#include "slam/planar_scan.h"
#include "slam/submaps/submap_rbpf.h"

namespace patrol::app {

/// A run's log mapped by submaps, and where they truly lie.
struct SubmapTrack {
  slam::SubmapRbpf slam;
  std::vector<Time> stamps = {};            ///< [scan]
  std::vector<Pose2> T_world_submap = {};   ///< [submap]
};

/// Of a run directory. None when interrupted. Throws InputError when there is no log, or the truth does not reach from its first scan to its last.
std::optional<SubmapTrack> build_submaps(const std::filesystem::path& run, const slam::PlanarScanSettings& scan, const slam::SubmapRbpfSettings& settings,
                                         const BoostedStumps& neighbours, std::uint64_t seed, ProgressBar& bar, const InterruptGuard& guard);

}  // namespace patrol::app
