#pragma once

#include <string>
#include <vector>

namespace patrol::render {

/// What a film says beside the picture of the run. Seconds of film.
struct FilmNote {
  std::vector<std::string> caption;  ///< lines, about what is shown; empty: none
  double speed = 1.0;   ///< seconds of the run in a second of film
  double film_s = 0.0;
  double length_s = 0.0;
  std::vector<double> marks_s;  ///< where its moments are
};

}  // namespace patrol::render
