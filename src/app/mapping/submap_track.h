#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "app/common/progress_bar.h"
#include "core/time.h"
#include "slam/planar_scan.h"
#include "slam/submaps/submap_rbpf.h"

namespace patrol::app {

/// Submaps of a run's log with their ground-truth poses.
struct SubmapTrack {
  slam::SubmapRbpf slam;
  std::vector<Time> stamps = {};           ///< [scan]
  std::vector<Pose2> T_world_submap = {};  ///< [submap]
};

/// Builds the submaps of a run directory. None if interrupted. Throws InputError if there is no log, or the ground
/// truth does not cover all scans.
std::optional<SubmapTrack> build_submaps(const std::filesystem::path& run, const slam::PlanarScanSettings& scan,
                                         const slam::SubmapRbpfSettings& settings, const BoostedStumps& neighbors,
                                         std::uint64_t seed, ProgressBar& bar, const InterruptGuard& guard);

}  // namespace patrol::app
