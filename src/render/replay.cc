#include "render/replay.h"

#include <algorithm>
#include <deque>
#include <future>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/error.h"
#include "io/mcap_reader.h"
#include "io/run_log.h"
#include "render/paint_thread.h"
#include "render/run_follower.h"
#include "render/scene_painter.h"
#include "render/video.h"

namespace patrol::render {
namespace {

/// Handlers that feed the follower, and call `on_state` after each state.
io::LogHandlers handlers_for(RunFollower& follower, std::function<void(Time)> on_state) {
  const auto feed = [&follower](Time, const auto& message) { follower.add(message); };
  io::LogHandlers handlers;
  handlers.scan = feed;
  handlers.odometry = feed;
  handlers.pose = feed;
  handlers.particles = feed;
  handlers.map = feed;
  handlers.path = feed;
  handlers.event = feed;
  handlers.truth = feed;
  handlers.state = [&follower, on_state = std::move(on_state)](Time, const SimState& state) {
    follower.add(state);
    on_state(state.stamp);
  };
  return handlers;
}

/// A camera that sees what the follower's world has in its way.
CameraRig camera_on(const RunFollower& follower, CameraKind kind) {
  const FreeDistance free_distance = [&follower](const Eigen::Vector3d& from_m, const Eigen::Vector3d& direction,
                                                 double max_m) {
    return follower.free_distance_m(from_m, direction, max_m);
  };
  const std::optional<Eigen::Vector3d> head_m = follower.head_m();
  return head_m ? CameraRig(kind, free_distance, *head_m) : CameraRig(kind, free_distance);
}

/// Films what the follower sees, at even steps of the run's time.
class Film {
 public:
  Film(const mjModel& view, const ReplaySettings& settings, CameraRig rig,
       const std::filesystem::path& out_mp4)
      : settings_(settings),
        step_(std::max(Time{1}, from_seconds(settings.speed / settings.frames_per_second))),
        rig_(std::move(rig)),
        video_(out_mp4, settings.width, settings.height, settings.frames_per_second) {
    for (int i = 0; i < std::max(1, settings.num_threads); ++i) {
      painters_.push_back(std::make_unique<PaintThread>(view, settings.width, settings.height, settings.dust.extinction_per_m()));
    }
  }

  /// Takes a frame if one is due.
  void shoot(const RunSnapshot& snapshot) {
    if (snapshot.state.stamp < next_) return;
    next_ = snapshot.state.stamp - snapshot.state.stamp % step_ + step_;
    PaintThread& painter = *painters_[num_frames_ % painters_.size()];
    const View view = rig_.follow(snapshot.T_world_body, 1.0 / settings_.frames_per_second);
    in_work_.push_back(painter.paint(snapshot, view));
    ++num_frames_;
    if (in_work_.size() > 2 * painters_.size()) develop();
  }

  void finish() {
    while (!in_work_.empty()) develop();
    video_.finish();
  }

  int num_frames() const { return static_cast<int>(num_frames_); }

 private:
  void develop() {
    video_.add(in_work_.front().get());
    in_work_.pop_front();
  }

  ReplaySettings settings_;
  Time step_;
  Time next_{};
  CameraRig rig_;
  VideoWriter video_;
  std::vector<std::unique_ptr<PaintThread>> painters_;
  std::deque<std::future<Frame>> in_work_;  ///< in the order of the film
  std::size_t num_frames_ = 0;
};

InputError no_states(const std::filesystem::path& log_mcap) {
  return InputError(log_mcap.string() + ": the log has no states to replay (topic " + io::kTopic<SimState> +
                    ")");
}

}  // namespace

ReplaySummary replay(const std::filesystem::path& log_mcap, sim::AssembledModel model,
                     const Pose2& T_world_map, const ReplaySettings& settings,
                     const std::filesystem::path& out_mp4, const ReplayProgress& progress) {
  if (!(settings.speed > 0.0) || !(settings.frames_per_second > 0.0)) {
    throw InputError(fmt::format("speed = {}: must be greater than 0", settings.speed));
  }
  const std::optional<Time> end = io::McapReader(log_mcap).last_time();
  set_replay_quality(*model.view);
  set_light(*model.view, settings.light);
  RunFollower follower(*model.view, T_world_map);
  if (settings.map) follower.add(MapUpdate{.stamp = {}, .map = *settings.map});
  Film film(*model.view, settings, camera_on(follower, settings.camera), out_mp4);
  ReplaySummary summary;
  summary.log_is_complete = io::read_run_log(log_mcap, handlers_for(follower, [&](Time now) {
                                               film.shoot(follower.snapshot());
                                               summary.end = now;
                                               if (progress && end && end->count() > 0)
                                                 progress(std::min(1.0, to_seconds(now) / to_seconds(*end)));
                                             }));
  if (film.num_frames() == 0) throw no_states(log_mcap);
  film.finish();
  summary.num_frames = film.num_frames();
  return summary;
}

void still(const std::filesystem::path& log_mcap, sim::AssembledModel model, const Pose2& T_world_map,
           const ReplaySettings& settings, Time at, const std::filesystem::path& out_png) {
  set_replay_quality(*model.view);
  set_light(*model.view, settings.light);
  RunFollower follower(*model.view, T_world_map);
  if (settings.map) follower.add(MapUpdate{.stamp = {}, .map = *settings.map});
  CameraRig rig = camera_on(follower, settings.camera);
  std::optional<View> view;
  const auto follow = [&](Time) {
    view = rig.follow(follower.snapshot().T_world_body, 0.02 / settings.speed);
  };
  io::read_run_log(log_mcap, handlers_for(follower, follow), Time::min(), at);
  if (!view) throw no_states(log_mcap);
  PaintThread painter(*model.view, settings.width, settings.height, settings.dust.extinction_per_m());
  save_png(out_png, painter.paint(follower.snapshot(), *view).get());
}

}  // namespace patrol::render
