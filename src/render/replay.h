#pragma once

#include <filesystem>
#include <functional>
#include <optional>

#include "core/frames.h"
#include "core/grid.h"
#include "core/time.h"
#include "render/camera.h"
#include "render/light.h"
#include "sim/dust.h"
#include "sim/model_assembly.h"

namespace patrol::render {

struct ReplaySettings {
  CameraKind camera = CameraKind::kChase;
  double speed = 8.0;  ///< seconds of the run in a second of video
  int width = 1280;
  int height = 720;
  double frames_per_second = 30.0;
  std::optional<OccupancyGrid> map = {};  ///< that the robot was given, in map; none: it makes its own
  sim::DustSettings dust = {};  ///< in the air of that run
  LightSettings light = {};     ///< likewise
  int num_threads = 1;  ///< that draw, each a frame of its own; with two, OSMesa 22.3 has crashed once in 13 films
};

/// Called with the share that is done, 0 ... 1; never for a log that was cut off, whose end nobody knows.
using ReplayProgress = std::function<void(double done)>;

struct ReplaySummary {
  int num_frames = 0;
  Time end{};  ///< of the run, as logged
  bool log_is_complete = true;
};

/// Films a logged run. `T_world_map` is the start pose: map and world are joined there. The model's render
/// quality is set to what a replay can afford. Throws InputError when the log cannot be read, has no states
/// or is of another world.
ReplaySummary replay(const std::filesystem::path& log_mcap, sim::AssembledModel model,
                     const Pose2& T_world_map, const ReplaySettings& settings,
                     const std::filesystem::path& out_mp4, const ReplayProgress& progress = {});

/// One picture, of the last state up to `at`.
void still(const std::filesystem::path& log_mcap, sim::AssembledModel model, const Pose2& T_world_map,
           const ReplaySettings& settings, Time at, const std::filesystem::path& out_png);

}  // namespace patrol::render
