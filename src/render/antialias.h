#pragma once

#include "render/frame.h"

namespace patrol::render {

/// Softens the stairs of slanted edges: a pixel where brightness jumps is blurred along the edge, never
/// across it (fast approximate anti-aliasing, T. Lottes, NVIDIA 2009, the variant of few samples). To the eye
/// nearly as good as four samples a pixel, at a fraction of what those cost a software renderer.
void smooth_edges(Frame& frame);

}  // namespace patrol::render
