#pragma once

#include <filesystem>
#include <functional>
#include <optional>

#include "core/frames.h"
#include "core/grid.h"
#include "core/time.h"
#include "render/camera.h"
#include "render/film/moment.h"
#include "render/film/shot_plan.h"
#include "render/gl_context.h"
#include "render/light.h"
#include "sim/dust.h"
#include "sim/gas_plume.h"
#include "sim/model_assembly.h"

namespace patrol::render {

struct ReplaySettings {
  Cut cut = Cut::kStory;
  CameraKind camera = CameraKind::kChase;  ///< that follows the robot where the cut has no other
  SpeedSettings speed = {};
  int width = 1280;
  int height = 720;
  double frames_per_second = 30.0;
  Renderer renderer = Renderer::kAuto;
  std::optional<OccupancyGrid> map = {};  ///< that the robot was given, in map; none: it makes its own
  sim::DustSettings dust = {};  ///< in the air of that run
  std::vector<sim::LeakSettings> leaks = {};  ///< likewise
  sim::WindSettings wind = {};
  LightSettings light = {};
  std::vector<Moment> announced = {};  ///< what is notable and only the scenario knows, e.g. the faults that it switched on
};

/// Called with the share that is done, 0 ... 1; false: no more.
using ReplayProgress = std::function<bool(double done)>;

struct ReplaySummary {
  int num_frames = 0;
  Time end{};  ///< of the run, as logged
  int num_chapters = 0;
  bool log_is_complete = true;
  bool is_interrupted = false;  ///< by the one who is told the progress: there is no film
};

/// Films a logged run, read twice: once for its moments, once for the film. `T_world_map` is the start pose: map and world are
/// joined there. The model's render quality is set to what a replay can afford. Throws InputError when the log cannot be read, has no states
/// or is of another world.
ReplaySummary replay(const std::filesystem::path& log_mcap, sim::AssembledModel model,
                     const Pose2& T_world_map, const ReplaySettings& settings,
                     const std::filesystem::path& out_mp4, const ReplayProgress& progress = {});

/// One picture, of the last state up to `at`.
void still(const std::filesystem::path& log_mcap, sim::AssembledModel model, const Pose2& T_world_map,
           const ReplaySettings& settings, Time at, const std::filesystem::path& out_png);

}  // namespace patrol::render
