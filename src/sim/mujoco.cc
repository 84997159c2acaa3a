#include "sim/mujoco.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <stdexcept>

#include <fmt/format.h>

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

template <typename Visitor>
void for_each_texture(mjSpec& spec, Visitor&& visit) {
  for (mjsElement* element = mjs_firstElement(&spec, mjOBJ_TEXTURE); element != nullptr;
       element = mjs_nextElement(&spec, element))
    visit(*mjs_asTexture(element));
}

/// Models are compiled without textures where nothing is rendered, so that MuJoCo does not notice a missing image.
void refuse_missing_images(mjSpec& spec, const std::string& path) {
  for_each_texture(spec, [&](const mjsTexture& texture) {
    const std::filesystem::path file = mjs_getString(texture.file);
    const mjSpec& origin = *mjs_getOriginSpec(texture.element);
    const std::filesystem::path image = std::filesystem::path(mjs_getString(origin.modelfiledir)) /
                                        mjs_getString(origin.compiler.texturedir) /
                                        (origin.strippath ? file.filename() : file);
    if (file.empty() || std::filesystem::is_regular_file(image)) return;
    throw InputError(fmt::format("{}: texture '{}': {} cannot be read ({})", path,
                                 mjs_getString(mjs_getName(texture.element)), image.string(),
                                 mjs_getString(texture.info)));
  });
}

}  // namespace

SpecPtr load_spec(const std::string& path) {
  if (!std::filesystem::is_regular_file(path)) throw InputError(path + ": cannot be read");
  std::array<char, 1024> error{};
  SpecPtr spec(mj_parseXML(path.c_str(), nullptr, error.data(), error.size()));
  if (!spec) throw InputError(path + ": " + one_line(error.data()));
  refuse_missing_images(*spec, path);
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
  for_each_texture(spec, [](mjsTexture& texture) {
    const bool has_file_per_side = *mjs_getString(texture.file) == '\0' && texture.builtin == mjBUILTIN_NONE;
    if (has_file_per_side) return;
    mjs_setString(texture.file, "");
    // A skybox stays one: only it may have no name. It has the height of six sides.
    const bool is_sky = texture.type == mjTEXTURE_SKYBOX;
    if (!is_sky) texture.type = mjTEXTURE_2D;
    texture.builtin = mjBUILTIN_FLAT;
    texture.mark = mjMARK_NONE;
    texture.width = 1;
    texture.height = is_sky ? 6 : 1;
    texture.nchannel = 3;
  });
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
