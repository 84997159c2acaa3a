#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include <mujoco/mujoco.h>

#include "sim/lidar_scene.h"
#include "sim/mujoco.h"

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

/// The free-standing statistics that the sensor tests compare with data sheets.
struct Moments {
  double sum = 0.0, squares = 0.0;
  double smallest = 1e300, largest = -1e300;
  int count = 0;

  void add(double value) {
    sum += value;
    squares += value * value;
    smallest = value < smallest ? value : smallest;
    largest = value > largest ? value : largest;
    ++count;
  }
  double mean() const { return count == 0 ? 0.0 : sum / count; }
  double rms() const { return count == 0 ? 0.0 : std::sqrt(squares / count); }
  double std() const { return std::sqrt(std::max(0.0, rms() * rms() - mean() * mean())); }
};

}  // namespace patrol::sim
