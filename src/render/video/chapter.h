#pragma once

#include <string>

namespace patrol::render {

/// Chapter of a film that a player can jump to.
struct Chapter {
  double begin_s = 0.0;  ///< film time
  double end_s = 0.0;
  std::string title;
};

}  // namespace patrol::render
