#pragma once

#include <vector>

#include "render/scene/camera.h"
#include "render/scene/frame.h"

namespace patrol::render {

/// Homogeneous participating medium (fog, dust): extinction coefficient and in-scattered color.
struct Haze {
  double extinction_per_m = 0.0;  ///< 0: clear air
  Color color;                    ///< in-scattered color: color of the medium at infinite distance
};

/// Applies the medium to a picture of clear air. After d meters the fraction exp(-extinction d) of the object's color
/// remains; the rest is the color of the haze [Koschmieder24]. The distance starts at the view's near plane: what the
/// plane cuts away contains no haze. `depth` as in Offscreen::read_depth.
void add_haze(Frame& frame, const std::vector<float>& depth, const View& view, const Haze& haze);

}  // namespace patrol::render
