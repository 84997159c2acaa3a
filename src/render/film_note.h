#pragma once

#include <string>
#include <vector>

namespace patrol::render {

/// Annotations of one frame of a film. Times are film times.
struct FilmNote {
  std::vector<std::string> caption;  ///< text lines about the current shot; empty without a shot
  double speed = 1.0;                ///< playback speed: run time / film time
  double film_s = 0.0;
  double length_s = 0.0;
  std::vector<double> marks_s;  ///< times of the highlights
};

}  // namespace patrol::render
