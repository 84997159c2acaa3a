#pragma once

#include "render/film/replay.h"

namespace patrol::app {

/// Renders the segments of a film in up to `jobs` processes (0: one per core), joins them, and shows the progress.
/// Removes the segments, also after an error. Returns false if interrupted; then no film is written.
bool render_film(const render::ReplayFilm& film, int jobs);

}  // namespace patrol::app
