#pragma once

#include <deque>
#include <filesystem>
#include <future>
#include <memory>

#include "render/film/director.h"
#include "render/frame_renderer.h"
#include "render/run_snapshot.h"
#include "render/video/video_writer.h"

namespace patrol::render {

/// Division of a film into segments, one video file each, and the selection of those that one process renders.
struct FilmSegments {
  std::filesystem::path folder;
  std::string extension = ".mp4";
  int frames_per_segment = 1;
  int part = 0;       ///< renders the segments whose number modulo `num_parts` is `part`
  int num_parts = 1;  ///< number of processes

  std::filesystem::path file(int segment) const;
  bool contains(int segment) const { return segment % num_parts == part; }
};

/// Renders the segments of a film from a run's snapshots and a director. Each frame shows the first state at or after
/// the frame's time in the run.
class Film {
 public:
  /// `view` must outlive the film.
  Film(const mjModel& view, const FrameSettings& settings, double frames_per_second, Director director,
       FilmSegments segments);

  /// Adds the next snapshot in the order of the run and renders the frames that are due.
  void add_snapshot(const RunSnapshot& snapshot);
  /// Waits for the remaining frames and completes the files.
  void finish();

  /// Frames of the film until now, with those of other parts.
  int num_frames() const { return num_frames_; }
  double length_s() const { return num_frames_ / frames_per_second_; }

 private:
  struct FrameInWork {
    int segment = 0;
    std::future<Frame> frame;
  };
  void encode_oldest_frame();
  void close_segment();

  FrameSettings settings_;
  double frames_per_second_;
  Director director_;
  FilmSegments segments_;
  std::unique_ptr<VideoWriter> video_;  ///< video of segment `open_segment_`
  int open_segment_ = -1;
  FrameRenderer painter_;
  std::deque<FrameInWork> in_work_;  ///< in the order of the film
  int num_frames_ = 0;
};

}  // namespace patrol::render
