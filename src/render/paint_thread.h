#pragma once

#include <future>
#include <optional>
#include <thread>

#include "render/camera.h"
#include "render/film/film_note.h"
#include "render/frame.h"
#include "render/gas_puffs.h"
#include "render/gl_context.h"
#include "render/run_snapshot.h"
#include "render/work_queue.h"
#include "sim/mujoco.h"

namespace patrol::render {

/// What a picture of a run is painted with, whatever it shows.
struct PaintSettings {
  int width = 1280;
  int height = 720;
  double extinction_per_m = 0.0;  ///< of dust
  GasCloud gas = {};
  Renderer renderer = Renderer::kAuto;
};

/// Paints finished replay frames, two at a time: one thread draws the world, another smooths its edges and lays the overlay on
/// it. Only the first has OpenGL: with a context in each of two threads OSMesa 22.3 crashed in one of 13 films, nobody knows why,
/// and they would share its rasteriser, which uses every core for one of them already. What is painted depends on nothing but what
/// is given.
class PaintThread {
 public:
  /// Waits until OpenGL and fonts are there; throws what kept them from that. `view` must outlive the threads.
  PaintThread(const mjModel& view, const PaintSettings& settings);
  ~PaintThread();
  PaintThread(const PaintThread&) = delete;
  PaintThread& operator=(const PaintThread&) = delete;

  /// `note` as for Overlay.
  std::future<Frame> paint(RunSnapshot snapshot, const View& view, std::optional<FilmNote> note = {});

 private:
  struct Order {
    RunSnapshot snapshot;
    View view;
    std::optional<FilmNote> note;
    Frame frame;
    std::vector<float> depth;
    std::promise<Frame> result;
  };
  void draw_worlds(const mjModel& view, const PaintSettings& settings, std::promise<void> is_ready);
  void finish_frames(const PaintSettings& settings, std::promise<void> is_ready);
  void stop();

  WorkQueue<Order> ordered_, drawn_;
  std::thread drawer_, finisher_;
};

}  // namespace patrol::render
