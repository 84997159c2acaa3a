#pragma once

#include <filesystem>
#include <functional>
#include <optional>

#include "core/frames.h"
#include "core/grid.h"
#include "core/time.h"
#include "render/film/highlight.h"
#include "render/film/shot_plan.h"
#include "render/scene/camera.h"
#include "render/scene/gl_context.h"
#include "render/scene/light.h"
#include "sim/dust.h"
#include "sim/gas_plume.h"
#include "sim/model_assembly.h"

namespace patrol::render {

/// Settings of a film or a still picture.
struct ReplaySettings {
  FilmStyle style = FilmStyle::kHighlights;
  CameraKind camera = CameraKind::kChase;  ///< camera outside of planned shots
  SpeedSettings speed = {};
  int width = 1280;
  int height = 720;
  double frames_per_second = 30.0;
  Renderer renderer = Renderer::kAuto;
  std::optional<OccupancyGrid> map = {};      ///< map that the robot was given, in map; none for a mapping run
  sim::DustSettings dust = {};                ///< dust of the run
  std::vector<sim::LeakSettings> leaks = {};  ///< gas leaks of the run
  sim::WindSettings wind = {};
  LightSettings light = {};
  std::vector<Highlight> announced = {};  ///< events known only to the scenario, e.g. injected faults
};

/// Called with the completed fraction, 0 ... 1. Returns false to interrupt the replay.
using ReplayProgress = std::function<bool(double done)>;

/// Result of a replay.
struct ReplaySummary {
  int num_frames = 0;
  Time end{};  ///< end of the logged run
  int num_chapters = 0;
  bool log_is_complete = true;
  bool is_interrupted = false;  ///< interrupted by the progress callback; no film is written
};

/// Renders a film of a logged run. Reads the log twice: once for the highlights, once for the frames. `T_world_map` is
/// the start pose, at which map and world are aligned. Sets the model's render quality. Throws InputError when the log
/// cannot be read, has no states, or belongs to another world.
ReplaySummary replay(const std::filesystem::path& log_mcap, sim::AssembledModel model, const Pose2& T_world_map,
                     const ReplaySettings& settings, const std::filesystem::path& out_mp4,
                     const ReplayProgress& progress = {});

/// Renders one picture of the last state up to `at`.
void still(const std::filesystem::path& log_mcap, sim::AssembledModel model, const Pose2& T_world_map,
           const ReplaySettings& settings, Time at, const std::filesystem::path& out_png);

}  // namespace patrol::render
