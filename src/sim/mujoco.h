#pragma once

#include <memory>
#include <string>
#include <string_view>

#include <mujoco/mujoco.h>

namespace patrol::sim {

template <auto Delete>
struct Deleter {
  template <typename T>
  void operator()(T* pointer) const {
    Delete(pointer);
  }
};

using ModelPtr = std::unique_ptr<mjModel, Deleter<mj_deleteModel>>;
using DataPtr = std::unique_ptr<mjData, Deleter<mj_deleteData>>;
using SpecPtr = std::unique_ptr<mjSpec, Deleter<mj_deleteSpec>>;

/// Loads, parses or compiles a model. Throws InputError with MuJoCo's message, which names the line, when the model is
/// invalid. A file also has to have the images of its textures.
SpecPtr load_spec(const std::string& path);
SpecPtr parse_spec(const std::string& xml);
ModelPtr compile(mjSpec& spec, const std::string& name);

/// Replaces the images of all textures by one texel, which takes no time to compile. A cube with a file per side stays.
void drop_textures(mjSpec& spec);

DataPtr make_data(const mjModel& model);

/// Returns the name of an element of the model; empty if it has none.
std::string_view name_of(const mjModel& model, mjtObj type, int id);

}  // namespace patrol::sim
