#pragma once

#include <string>

#include <mujoco/mujoco.h>

#include "sim/lidar_scene.h"
#include "sim/mujoco.h"
#include "tests/support/moments.h"

namespace patrol::sim {

/// A world of a few geoms, written in the test, with MuJoCo's state of it and the lidar's scene.
struct SmallWorld {
  /// `body` is what stands inside <worldbody>, `asset` what stands inside <asset>.
  explicit SmallWorld(const std::string& body, const std::string& asset = "")
      : model(compile(*parse_spec("<mujoco><option timestep=\"0.002\"/><asset>" + asset + "</asset><worldbody>" + body +
                                  "</worldbody></mujoco>"),
                      "small world")),
        data(make_data(*model)),
        scene(*model) {
    mj_forward(model.get(), data.get());
    scene.update(*data);
  }

  ModelPtr model;
  DataPtr data;
  LidarScene scene;
};

}  // namespace patrol::sim
