#pragma once

#include <optional>
#include <vector>

#include "render/camera.h"
#include "render/canvas.h"
#include "render/film/film_note.h"
#include "render/gas_puffs.h"
#include "render/map_inset.h"
#include "render/run_snapshot.h"

namespace patrol::render {

/// What a replay adds to the picture of the world: gas, paths, scan and plan where they lie, the map in a corner,
/// figures, and what a film has to say.
class Overlay {
 public:
  /// Letters and lines fit a frame of this height. Throws InputError when there is no font.
  explicit Overlay(int frame_height, GasCloud gas = {});

  /// `note`: of a film; none for a picture of its own.
  void draw(Frame& frame, const std::vector<float>& depth, const View& view, const RunSnapshot& snapshot,
            const std::optional<FilmNote>& note = {});

 private:
  void draw_figures(Frame& frame, const RunSnapshot& snapshot, const std::optional<FilmNote>& note);
  /// Returns its upper edge.
  int draw_legend(Frame& frame, const RunSnapshot& snapshot);
  void draw_caption(Frame& frame, const std::vector<std::string>& lines, int bottom);
  void draw_timeline(Frame& frame, const FilmNote& note);

  double scale_;  ///< of lines: 1 in a frame 720 pixels high
  Font figures_;
  Font words_;
  Font title_;
  MapInset inset_;
  GasCloud gas_;
};

}  // namespace patrol::render
