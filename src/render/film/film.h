#pragma once

#include <deque>
#include <filesystem>
#include <future>

#include "render/film/director.h"
#include "render/frame_renderer.h"
#include "render/run_snapshot.h"
#include "render/video.h"

namespace patrol::render {

/// Renders a film from a run's snapshots and a director. Each frame shows the first state at or after the frame's time
/// in the run.
class Film {
 public:
  /// `view` must outlive the film.
  Film(const mjModel& view, const FrameSettings& settings, double frames_per_second, Director director,
       const std::filesystem::path& out_mp4);

  /// Adds the next snapshot in the order of the run and renders the frames that are due.
  void add_snapshot(const RunSnapshot& snapshot);
  /// Waits for the remaining frames and completes the file.
  void finish();

  int num_frames() const { return num_frames_; }
  double length_s() const { return num_frames_ / frames_per_second_; }

 private:
  void encode_oldest_frame();

  double frames_per_second_;
  Director director_;
  VideoWriter video_;
  FrameRenderer painter_;
  std::deque<std::future<Frame>> in_work_;  ///< in the order of the film
  int num_frames_ = 0;
};

}  // namespace patrol::render
