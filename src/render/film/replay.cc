#include "render/film/replay.h"

#include <algorithm>
#include <optional>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/error.h"
#include "io/logs/run_log.h"
#include "render/film/film.h"
#include "render/film/find_highlights.h"
#include "render/film/run_history.h"
#include "render/frame_renderer.h"
#include "render/scene/scene_painter.h"
#include "render/snapshot_builder.h"
#include "render/video/join_videos.h"

namespace patrol::render {
namespace {

/// Log handlers that feed the follower and call `on_state` after each state.
io::LogHandlers handlers_for(SnapshotBuilder& follower, std::function<void(Time)> on_state) {
  const auto feed = [&follower](Time, const auto& message) { follower.add(message); };
  io::LogHandlers handlers;
  handlers.on<LaserScan>(feed);
  handlers.on<OdometryEstimate>(feed);
  handlers.on<PoseEstimate>(feed);
  handlers.on<ParticleSet>(feed);
  handlers.on<MapUpdate>(feed);
  handlers.on<Path>(feed);
  handlers.on<Event>(feed);
  handlers.on<GasReading>(feed);
  handlers.on<LiningResult>(feed);
  handlers.on<GroundTruth>(feed);
  handlers.on<SimState>([&follower, on_state = std::move(on_state)](Time, const SimState& state) {
    follower.add(state);
    on_state(state.stamp);
  });
  return handlers;
}

/// Exception that interrupts the reading of a log when the progress callback returns false.
struct Interrupted {};

FreeDistance free_distance_in(const SnapshotBuilder& follower) {
  return [&follower](const Eigen::Vector3d& from_m, const Eigen::Vector3d& direction, double max_m) {
    return follower.free_distance_m(from_m, direction, max_m);
  };
}

/// Camera rig that detects obstacles in the follower's world.
CameraRig camera_on(const SnapshotBuilder& follower, CameraKind kind) {
  const std::optional<Eigen::Vector3d>& head_m = follower.head_m();
  return head_m ? CameraRig(kind, free_distance_in(follower), *head_m) : CameraRig(kind, free_distance_in(follower));
}

FrameSettings frame_settings(const ReplaySettings& settings, const mjModel& view) {
  return {.width = settings.width,
          .height = settings.height,
          .extinction_per_m = settings.dust.extinction_per_m(),
          .gas = GasCloud(view, settings.leaks, settings.wind),
          .renderer = settings.renderer};
}

void prepare(mjModel& view, const ReplaySettings& settings) {
  set_replay_quality(view);
  set_light(view, settings.light);
}

InputError no_states(const std::filesystem::path& log_mcap) {
  return InputError(log_mcap.string() + ": contains no states (topic " + io::kTopic<SimState> + ")");
}

ShotPlan plan_of(const std::filesystem::path& log_mcap, const RunHistory& history, const Pose2& T_world_map,
                 const ReplaySettings& settings) {
  if (!(settings.speed.fast > 0.0) || !(settings.speed.slow > 0.0) || !(settings.frames_per_second > 0.0)) {
    throw InputError(fmt::format("speed = {}, highlight speed = {}: must be greater than 0", settings.speed.fast,
                                 settings.speed.slow));
  }
  if (history.num_states == 0) throw no_states(log_mcap);
  return plan_shots(history, find_highlights(history, T_world_map, settings.announced), settings.style, settings.speed);
}

}  // namespace

ReplayFilm::ReplayFilm(std::filesystem::path log_mcap, sim::AssembledModel model, const Pose2& T_world_map,
                       ReplaySettings settings, std::filesystem::path out)
    : log_mcap_(std::move(log_mcap)),
      model_(std::move(model)),
      T_world_map_(T_world_map),
      settings_(std::move(settings)),
      out_(std::move(out)),
      history_(read_run_history(log_mcap_, *model_.view, T_world_map)),
      plan_(plan_of(log_mcap_, history_, T_world_map, settings_)) {
  prepare(*model_.view, settings_);
  while (history_.end >= plan_.speed.run_time(num_frames_ / settings_.frames_per_second)) ++num_frames_;
}

int segment_size(int num_frames) { return std::clamp((num_frames + 15) / 16, 30, 300); }

FilmSegments ReplayFilm::segments(int part, int num_parts) const {
  const int size = settings_.frames_per_segment > 0 ? settings_.frames_per_segment : segment_size(num_frames_);
  return {.folder = out_.string() + ".segments",
          .extension = out_.extension().string(),
          .frames_per_segment = can_join(out_) ? size : std::max(1, num_frames_),
          .part = part,
          .num_parts = num_parts};
}

int ReplayFilm::num_segments() const {
  const int size = segments(0, 1).frames_per_segment;
  return (num_frames_ + size - 1) / size;
}

bool ReplayFilm::render(int part, int num_parts, const ReplayProgress& progress) const {
  const FilmSegments parts = segments(part, num_parts);
  std::filesystem::create_directories(parts.folder);
  const mjModel& view = *model_.view;
  SnapshotBuilder follower(view, T_world_map_);
  if (settings_.map) follower.add(MapUpdate{.stamp = {}, .map = *settings_.map});
  Director director(plan_, camera_on(follower, settings_.camera), free_distance_in(follower));
  Film film(view, frame_settings(settings_, view), settings_.frames_per_second, std::move(director), parts);
  try {
    io::read_run_log(log_mcap_, handlers_for(follower, [&](Time) {
                       film.add_snapshot(follower.snapshot());
                       if (progress && !progress(std::min(1.0, static_cast<double>(film.num_frames()) / num_frames_)))
                         throw Interrupted();
                     }));
  } catch (const Interrupted&) {
    return false;
  }
  film.finish();
  return true;
}

void ReplayFilm::join() const {
  const FilmSegments parts = segments(0, 1);
  std::vector<std::filesystem::path> files;
  for (int i = 0; i < num_segments(); ++i) files.push_back(parts.file(i));
  join_videos(files, parts.frames_per_segment, plan_.chapters, out_);
}

void ReplayFilm::remove_segments() const {
  std::error_code ignored;
  std::filesystem::remove_all(segments(0, 1).folder, ignored);
}

void still(const std::filesystem::path& log_mcap, sim::AssembledModel model, const Pose2& T_world_map,
           const ReplaySettings& settings, Time at, const std::filesystem::path& out_png) {
  prepare(*model.view, settings);
  SnapshotBuilder follower(*model.view, T_world_map);
  if (settings.map) follower.add(MapUpdate{.stamp = {}, .map = *settings.map});
  CameraRig rig = camera_on(follower, settings.camera);
  std::optional<View> view;
  const auto follow = [&](Time) { view = rig.follow(follower.snapshot().T_world_body, 0.02 / settings.speed.fast); };
  io::read_run_log(log_mcap, handlers_for(follower, follow), Time::min(), at);
  if (!view) throw no_states(log_mcap);
  FrameRenderer painter(*model.view, frame_settings(settings, *model.view));
  save_png(out_png, painter.paint(follower.snapshot(), *view).get());
}

}  // namespace patrol::render
