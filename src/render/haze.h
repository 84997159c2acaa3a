#pragma once

#include <vector>

#include "render/camera.h"
#include "render/frame.h"

namespace patrol::render {

/// What hangs in the air: it takes light that comes from a thing, and sends some of its own to the eye.
struct Haze {
  double extinction_per_m = 0.0;  ///< 0 in clear air
  Color color;                    ///< of air that one sees nothing through
};

/// Draws the haze between eye and things into a picture of clear air. After a way of d metres a share exp(-extinction d) of
/// what was there is left, the rest is haze (Koschmieder 1924). The way begins at the view's near plane: where that cuts
/// something away, it cuts the air away too. `depth` as in Offscreen::read_depth.
void add_haze(Frame& frame, const std::vector<float>& depth, const View& view, const Haze& haze);

}  // namespace patrol::render
