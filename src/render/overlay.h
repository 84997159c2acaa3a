#pragma once

#include <vector>

#include "render/camera.h"
#include "render/canvas.h"
#include "render/map_inset.h"
#include "render/run_snapshot.h"

namespace patrol::render {

/// What a replay adds to the picture of the world: paths, scan and plan where they lie, the map in a corner,
/// figures.
class Overlay {
 public:
  /// Letters fit a frame of this height. Throws InputError when there is no font.
  explicit Overlay(int frame_height);

  void draw(Frame& frame, const std::vector<float>& depth, const View& view, const RunSnapshot& snapshot);

 private:
  void draw_figures(Frame& frame, const RunSnapshot& snapshot);
  void draw_legend(Frame& frame);

  Font figures_;
  Font words_;
  MapInset inset_;
};

}  // namespace patrol::render
