#pragma once

#include "render/scene/frame.h"

namespace patrol::render {

/// Fast approximate anti-aliasing (FXAA, few-sample variant) [Lottes09]: blurs pixels with a brightness step along the
/// edge, never across it. The result is close to four samples per pixel at a fraction of their cost in a software
/// renderer.
void smooth_edges(Frame& frame);

}  // namespace patrol::render
