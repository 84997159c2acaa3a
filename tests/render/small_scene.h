#pragma once

#include <string>

#include "core/ground_truth.h"
#include "sim/mujoco.h"

namespace patrol::render {

/// A model of a few geoms, written in the test. `body` is what stands inside <worldbody>, `asset` adds to <asset>.
inline sim::ModelPtr small_scene(const std::string& body, const std::string& asset = "") {
  const std::string xml =
      "<mujoco>"
      "<statistic extent=\"30\" center=\"0 0 1\"/>"
      "<visual><headlight ambient=\"0.5 0.5 0.5\" diffuse=\"0.1 0.1 0.1\" specular=\"0 0 0\"/>"
      "<map znear=\"0.003\" zfar=\"6\" fogstart=\"4\" fogend=\"6\"/></visual>"
      "<asset><texture type=\"skybox\" builtin=\"gradient\" rgb1=\"0.4 0.6 1\" rgb2=\"0.4 0.6 1\" "
      "width=\"32\" height=\"192\"/>" +
      asset +
      "</asset>"
      "<worldbody>" +
      body + "</worldbody></mujoco>";
  return sim::compile(*sim::parse_spec(xml), "small scene");
}

/// A robot of one box, 0.3 m above the ground, its lidar 0.1 m above that; and a wall 4 m ahead of it.
inline constexpr const char* kRobotBeforeWall = R"(
  <light directional="true" dir="0.4 0.5 -0.76" diffuse="0.8 0.8 0.8" castshadow="true"/>
  <geom type="plane" size="50 50 1" rgba="0.3 0.6 0.3 1"/>
  <body name="base_link" pos="0 0 0.3"><freejoint/>
    <geom type="box" size="0.3 0.15 0.1" rgba="0.9 0.1 0.1 1" group="4"/>
    <site name="lidar" pos="0 0 0.1"/>
  </body>
  <geom type="box" size="0.1 3 1" pos="4.1 0 1" rgba="0.6 0.5 0.4 1"/>)";

/// The model's own reference state.
inline SimState reference_state(const mjModel& model) {
  SimState state;
  state.qpos.assign(model.qpos0, model.qpos0 + model.nq);
  for (int body = 0; body < model.nbody; ++body) {
    if (model.body_mocapid[body] < 0) continue;
    state.mocap.insert(state.mocap.end(), model.body_pos + 3 * body, model.body_pos + 3 * body + 3);
    state.mocap.insert(state.mocap.end(), model.body_quat + 4 * body, model.body_quat + 4 * body + 4);
  }
  return state;
}

}  // namespace patrol::render
