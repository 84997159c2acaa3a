#pragma once

#include <optional>
#include <vector>

#include "render/canvas.h"
#include "render/film_note.h"
#include "render/gas_puffs.h"
#include "render/map_inset.h"
#include "render/run_snapshot.h"
#include "render/scene/camera.h"

namespace patrol::render {

/// Annotations over the rendered world: gas, paths, scan and plan at their positions, the map in a corner, values,
/// legend, and the notes of a film.
class Overlay {
 public:
  /// Scales fonts and lines to the frame height. Throws InputError when the font is not installed.
  explicit Overlay(int frame_height, GasCloud gas = {});

  /// Draws on a rendered frame; `depth` as in Offscreen::read_depth. `note` is none for a still picture.
  void draw(Frame& frame, const std::vector<float>& depth, const View& view, const RunSnapshot& snapshot,
            const std::optional<FilmNote>& note = {});

 private:
  void draw_lining_labels(Frame& frame, const std::vector<float>& depth, const Projector& projector,
                          const RunSnapshot& snapshot);
  void draw_figures(Frame& frame, const RunSnapshot& snapshot, const std::optional<FilmNote>& note);
  /// Returns the upper edge of the legend, px.
  int draw_legend(Frame& frame, const RunSnapshot& snapshot);
  void draw_caption(Frame& frame, const std::vector<std::string>& lines, int bottom);
  void draw_timeline(Frame& frame, const FilmNote& note) const;

  double scale_;  ///< line width scale: 1 for a frame of 720 pixels height
  Font values_;
  Font texts_;
  Font title_;
  MapInset inset_;
  GasCloud gas_;
};

}  // namespace patrol::render
