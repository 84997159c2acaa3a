// Paints a small world with shadows by the renderer named: still_with RENDERER OUT.png. Exit code 1 where it is not to
// be had.
#include <cstdio>
#include <exception>
#include <vector>

#include "render/scene/scene_painter.h"
#include "tests/render/small_scene.h"

int main(int, char** argv) {
  using namespace patrol::render;
  try {
    const patrol::sim::ModelPtr model = small_scene(kRobotBeforeWall);
    SceneRenderer painter(*model, 320, 180, 0.0, parse_renderer(argv[1]));
    painter.set_state(reference_state(*model));
    Frame frame;
    std::vector<float> depth;
    painter.draw(look_at({-2.5, 1.0, 1.2}, {0.5, 0.0, 0.3}), frame, depth);
    save_png(argv[2], frame);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
