#include "importer/site/sdf_checks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "importer/site/sdf_source.h"

namespace patrol::importer {
namespace {

/// Element with a text why it is ignored.
struct ElementNote {
  std::string_view element;
  std::string_view text;
};

constexpr std::array kIgnored = std::to_array<ElementNote>({
    {"plugin", "ignored"},
    {"sensor", "ignored: sensors belong to the robot"},
    {"joint", "ignored: the links keep their initial poses"},
    {"gripper", "ignored"},
    {"projector", "ignored"},
    {"particle_emitter", "ignored"},
    {"audio_source", "ignored"},
    {"audio_sink", "ignored"},
    {"battery", "ignored"},
    {"gui", "ignored"},
    {"physics", "ignored: physics is that of all sites"},
    {"scene", "ignored: sky and ambient light are those of all sites"},
    {"wind", "ignored"},
    {"atmosphere", "ignored"},
    {"audio", "ignored"},
    {"spherical_coordinates", "ignored: the site has no geographic datum"},
    {"surface", "ignored: friction is that of all sites"},
    {"laser_retro", "ignored: reflectivity is the luminance of the color"},
    {"pbr", "ignored: the color is that of <diffuse>"},
    {"normal_map", "ignored"},
});

/// Elements without content for a site, and those that the reader uses.
const std::set<std::string_view> kKnown = {"world",
                                           "model",
                                           "link",
                                           "collision",
                                           "visual",
                                           "geometry",
                                           "material",
                                           "pose",
                                           "frame",
                                           "static",
                                           "include",
                                           "uri",
                                           "name",
                                           "state",
                                           "inertial",
                                           "mass",
                                           "inertia",
                                           "box",
                                           "cylinder",
                                           "sphere",
                                           "plane",
                                           "mesh",
                                           "capsule",
                                           "cone",
                                           "ellipsoid",
                                           "polyline",
                                           "heightmap",
                                           "empty",
                                           "gravity",
                                           "magnetic_field",
                                           "self_collide",
                                           "kinematic",
                                           "allow_auto_disable",
                                           "enable_wind",
                                           "must_be_base_link",
                                           "velocity_decay",
                                           "cast_shadows",
                                           "transparency",
                                           "meta",
                                           "visibility_flags",
                                           "max_contacts",
                                           "script",
                                           "ambient",
                                           "diffuse",
                                           "specular",
                                           "emissive",
                                           "lighting",
                                           "shader",
                                           "render_order",
                                           "double_sided",
                                           "density",
                                           "placement_frame",
                                           "merge"};

template <typename Notes>
const ElementNote* note_of(const Notes& notes, std::string_view element) {
  const auto found =
      std::find_if(notes.begin(), notes.end(), [&](const ElementNote& note) { return note.element == element; });
  return found == notes.end() ? nullptr : &*found;
}

class ElementChecker {
 public:
  explicit ElementChecker(const SdfWorld& world) : world_(world) {}

  void visit(const sdf::ElementPtr& element) {
    const std::string& name = element->GetName();
    if (!element->GetExplicitlySetInFile()) return;
    if (const auto refusal = sdf_refusal(name)) world_.fail(element, std::string(*refusal));
    if (const ElementNote* ignored = note_of(kIgnored, name)) {
      const bool is_zero_retro = name == "laser_retro" && element->Get<double>() == 0.0;
      if (!is_zero_retro) count(element, std::string(ignored->text));
      return;
    }
    if (!kKnown.contains(name)) {
      count(element, "ignored: not an element of the format");
      return;
    }
    if (name == "gravity" && element->GetParent()->GetName() == "world") check_gravity(element);
    if (name == "model" && !is_below_state(element)) check_model(element);
    if (name == "scale" || name == "state") check_state(element);
    const bool has_plain_content = name == "inertial" || name == "material" || name == "script" || name == "state" ||
                                   is_shape(element) || name == "include" || name == "meta";
    if (name == "material") {
      for (sdf::ElementPtr child = element->GetFirstElement(); child; child = child->GetNextElement()) visit(child);
    }
    if (has_plain_content) return;
    for (sdf::ElementPtr child = element->GetFirstElement(); child; child = child->GetNextElement()) visit(child);
  }

  /// Counts the elements that are left out before libsdformat reads the files, those of the world first.
  void add_left_out() {
    for (auto file = world_.files().rbegin(); file != world_.files().rend(); ++file) {
      for (const LeftOutElement& element : file->source->left_out())
        count({element.element, element.text, element.override_with}, world_.short_location_of(*file, element.line));
    }
  }

  std::vector<Assumption> rows() const {
    std::vector<Assumption> rows;
    for (const auto& [kind, found] : found_) {
      const std::string number = found.count > 1 ? fmt::format("{}", found.count) : "";
      const std::string first = found.count > 1 && !found.location.empty() ? ", the first in " : "";
      const std::string more = number + first + found.location;
      rows.push_back(
          {"<" + kind.element + ">", kind.text + (more.empty() ? "" : " (" + more + ")"), kind.override_with});
    }
    return rows;
  }

 private:
  /// Kind of a row.
  struct Kind {
    std::string element;
    std::string text;
    std::string override_with = "the file";
    auto operator<=>(const Kind&) const = default;
  };

  struct Found {
    int count = 0;
    std::string location = {};  ///< location of the first occurrence
  };

  static bool is_shape(const sdf::ElementPtr& element) {
    return element->GetParent() != nullptr && element->GetParent()->GetName() == "geometry";
  }
  static bool is_below_state(const sdf::ElementPtr& element) {
    for (sdf::ElementPtr at = element->GetParent(); at; at = at->GetParent()) {
      if (at->GetName() == "state") return true;
    }
    return false;
  }

  void count(const sdf::ElementPtr& element, const std::string& text) {
    count({element->GetName(), text}, world_.short_location_of(element));
  }
  void count(const Kind& kind, const std::string& location) {
    Found& found = found_[kind];
    if (found.count++ == 0) found.location = location;
  }

  void check_gravity(const sdf::ElementPtr& element) const {
    const auto gravity = element->Get<ignition::math::Vector3d>();
    const bool is_down =
        std::abs(gravity.X()) < 0.1 && std::abs(gravity.Y()) < 0.1 && std::abs(gravity.Z() + 9.81) < 0.1;
    if (!is_down) world_.fail(element, "must be that of the earth, 0 0 -9.8");
  }

  void check_model(const sdf::ElementPtr& element) {
    const bool is_static = element->HasElement("static") && element->Get<bool>("static");
    bool is_inside_static = is_static;
    for (sdf::ElementPtr at = element->GetParent(); at; at = at->GetParent()) {
      if (at->GetName() == "model" && at->HasElement("static")) is_inside_static |= at->Get<bool>("static");
    }
    if (!is_inside_static) count(element, "not static: made static at its initial pose");
  }

  void check_state(const sdf::ElementPtr& element) const {
    for (sdf::ElementPtr child = element->GetFirstElement(); child; child = child->GetNextElement()) {
      if (!child->GetExplicitlySetInFile()) continue;
      const bool is_scale = child->GetName() == "scale";
      const auto scale = is_scale ? child->Get<ignition::math::Vector3d>() : ignition::math::Vector3d::One;
      if (!(scale.Min() > 0.0) || !scale.IsFinite()) world_.fail(child, "must be three positive numbers");
      if (is_scale && scale != ignition::math::Vector3d::One && !element->HasElement("pose"))
        world_.fail(child, "needs the <pose> of the model beside it");
      if (child->GetName() == "model") check_state(child);
    }
  }

  const SdfWorld& world_;
  std::map<Kind, Found> found_;
};

}  // namespace

std::vector<Assumption> check_elements(const SdfWorld& world) {
  ElementChecker checker(world);
  checker.visit(world.world().Element());
  checker.add_left_out();
  return checker.rows();
}

}  // namespace patrol::importer
