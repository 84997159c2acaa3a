#pragma once

#include <filesystem>
#include <functional>
#include <optional>

#include "core/frames.h"
#include "core/grid.h"
#include "core/time.h"
#include "render/film/film.h"
#include "render/film/highlight.h"
#include "render/film/run_history.h"
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
  int frames_per_segment = 0;  ///< frames that one process renders in a row; 0: as segment_size() gives
  Renderer renderer = Renderer::kAuto;
  std::optional<OccupancyGrid> map = {};      ///< map that the robot was given, in map; none for a mapping run
  sim::DustSettings dust = {};                ///< dust of the run
  std::vector<sim::LeakSettings> leaks = {};  ///< gas leaks of the run
  sim::WindSettings wind = {};
  LightSettings light = {};
  std::vector<Highlight> announced = {};  ///< events known only to the scenario, e.g. injected faults
};

/// Returns the number of frames of a segment, 30 to 300: sixteen segments, which several processes share evenly. It
/// does not depend on their number, because the bytes of the film depend on it.
int segment_size(int num_frames);

/// Called with the completed fraction, 0 ... 1. Returns false to interrupt the replay.
using ReplayProgress = std::function<bool(double done)>;

/// Film of a logged run. Planned once; its segments can be rendered by several processes that are forked afterwards.
class ReplayFilm {
 public:
  /// Reads the log for the highlights and plans the film. `T_world_map` is the start pose, at which map and world are
  /// aligned. Sets the model's render quality. Throws InputError when the log cannot be read, has no states, or belongs
  /// to another world.
  ReplayFilm(std::filesystem::path log_mcap, sim::AssembledModel model, const Pose2& T_world_map,
             ReplaySettings settings, std::filesystem::path out);

  /// Renders the segments of part `part` of `num_parts` into files beside the film. Returns false if the progress
  /// callback interrupted it.
  bool render(int part, int num_parts, const ReplayProgress& progress = {}) const;
  /// Joins the segments to the film when all parts are rendered. The same run and settings give the same bytes with any
  /// number of parts.
  void join() const;
  /// Removes the files of the segments.
  void remove_segments() const;

  /// Number of segments. Parts beyond this number have nothing to render.
  int num_segments() const;
  int num_frames() const { return num_frames_; }
  int num_chapters() const { return static_cast<int>(plan_.chapters.size()); }
  Time end() const { return history_.end; }  ///< end of the logged run
  bool log_is_complete() const { return history_.log_is_complete; }

 private:
  FilmSegments segments(int part, int num_parts) const;

  std::filesystem::path log_mcap_;
  sim::AssembledModel model_;
  Pose2 T_world_map_;
  ReplaySettings settings_;
  std::filesystem::path out_;
  RunHistory history_;
  ShotPlan plan_;
  int num_frames_ = 0;
};

/// Renders one picture of the last state up to `at`.
void still(const std::filesystem::path& log_mcap, sim::AssembledModel model, const Pose2& T_world_map,
           const ReplaySettings& settings, Time at, const std::filesystem::path& out_png);

}  // namespace patrol::render
