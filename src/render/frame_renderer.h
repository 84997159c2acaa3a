#pragma once

#include <future>
#include <optional>
#include <thread>

#include "render/film_note.h"
#include "render/gas_puffs.h"
#include "render/run_snapshot.h"
#include "render/scene/camera.h"
#include "render/scene/frame.h"
#include "render/scene/gl_context.h"
#include "render/work_queue.h"
#include "sim/mujoco.h"

namespace patrol::render {

/// Settings of the renderer that apply to all frames.
struct FrameSettings {
  int width = 1280;
  int height = 720;
  double extinction_per_m = 0.0;  ///< extinction coefficient of the dust
  GasCloud gas = {};
  Renderer renderer = Renderer::kAuto;
};

/// Renders finished replay frames in a pipeline of two threads: one draws the world, the other smooths edges and draws
/// the overlay. Only the first uses OpenGL. With one context in each of two threads, OSMesa 22.3 crashed in one of 13
/// films (cause unknown). Several cores are used by several processes (render/film/replay.h). A frame depends only on
/// the arguments of `paint`.
class FrameRenderer {
 public:
  /// Waits until OpenGL and fonts are ready, or rethrows the error of the thread that failed. `view` must outlive this
  /// object.
  FrameRenderer(const mjModel& view, const FrameSettings& settings);
  ~FrameRenderer();
  FrameRenderer(const FrameRenderer&) = delete;
  FrameRenderer& operator=(const FrameRenderer&) = delete;

  /// Queues a frame. `note` as in Overlay::draw. Thread-safe.
  std::future<Frame> paint(RunSnapshot snapshot, const View& view, std::optional<FilmNote> note = {});

 private:
  struct FrameRequest {
    RunSnapshot snapshot;
    View view;
    std::optional<FilmNote> note;
    Frame frame;
    std::vector<float> depth;
    std::promise<Frame> result;
  };
  void run_world_thread(const mjModel& view, const FrameSettings& settings, std::promise<void> is_ready);
  void run_overlay_thread(const FrameSettings& settings, std::promise<void> is_ready);
  void stop();

  WorkQueue<FrameRequest> queued_, drawn_;
  std::thread world_thread_, overlay_thread_;
};

}  // namespace patrol::render
