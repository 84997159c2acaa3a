#include "sim/mujoco.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <stdexcept>

#include "core/error.h"
#include "sim/height_field_contact.h"

namespace patrol::sim {
namespace {

/// Returns a MuJoCo message as one line, without its line breaks.
std::string one_line(std::string text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

}  // namespace

SpecPtr load_spec(const std::string& path) {
  if (!std::filesystem::is_regular_file(path)) throw InputError(path + ": cannot be read");
  std::array<char, 1024> error{};
  SpecPtr spec(mj_parseXML(path.c_str(), nullptr, error.data(), error.size()));
  if (!spec) throw InputError(path + ": " + one_line(error.data()));
  return spec;
}

SpecPtr parse_spec(const std::string& xml) {
  std::array<char, 1024> error{};
  SpecPtr spec(mj_parseXMLString(xml.c_str(), nullptr, error.data(), error.size()));
  if (!spec) throw InputError("MJCF: " + one_line(error.data()));
  return spec;
}

ModelPtr compile(mjSpec& spec, const std::string& name) {
  use_closed_form_sphere_contacts();
  ModelPtr model(mj_compile(&spec, nullptr));
  if (!model) throw InputError(name + ": " + one_line(mjs_getError(&spec)));
  return model;
}

void drop_textures(mjSpec& spec) {
  for (mjsElement* element = mjs_firstElement(&spec, mjOBJ_TEXTURE); element != nullptr;
       element = mjs_nextElement(&spec, element)) {
    mjsTexture& texture = *mjs_asTexture(element);
    mjs_setString(texture.file, "");
    mjs_setStringVec(texture.cubefiles, "");
    texture.type = mjTEXTURE_2D;
    texture.builtin = mjBUILTIN_FLAT;
    texture.mark = mjMARK_NONE;
    texture.width = texture.height = 1;
    texture.nchannel = 3;
  }
}

DataPtr make_data(const mjModel& model) {
  DataPtr data(mj_makeData(&model));
  if (!data) throw std::runtime_error("MuJoCo: allocation of mjData failed");
  return data;
}

std::string_view name_of(const mjModel& model, mjtObj type, int id) {
  const char* name = mj_id2name(&model, type, id);
  return name == nullptr ? std::string_view() : name;
}

}  // namespace patrol::sim
