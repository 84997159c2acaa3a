#include "importer/robot/source_reader.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <sstream>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "core/letter_case.h"
#include "importer/xacro.h"
#include "importer/xml_elements.h"
#include "io/files/one_line.h"
#include "io/files/xml_problem.h"

namespace patrol::importer {

using tinyxml2::XMLElement;

namespace {

const std::map<std::string, JointType> kJointTypes = {
    {"fixed", JointType::kFixed},         {"continuous", JointType::kContinuous}, {"revolute", JointType::kRevolute},
    {"prismatic", JointType::kPrismatic}, {"floating", JointType::kFloating},     {"planar", JointType::kPlanar}};

/// Returns the path that a description names; empty if its package is unknown.
std::filesystem::path named_path(const Packages& packages, const std::string& uri) {
  try {
    return packages.resolve(uri).lexically_normal();
  } catch (const InputError&) {
    return {};
  }
}

}  // namespace

SourceReader::SourceReader(const std::string& file, const std::string& text, const Packages& packages)
    : packages_(packages), document_(true, tinyxml2::COLLAPSE_WHITESPACE) {
  robot_.file = file;
  if (const std::size_t at = text.find('\0'); at != std::string::npos) {
    const auto line = std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n') + 1;
    throw input_error(file, static_cast<int>(line), "not an XML file: has a byte of zero: must be text in UTF-8");
  }
  if (trimmed(text.c_str()).empty()) throw InputError(file + ": is empty: must be a URDF file");
  if (document_.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) {
    throw input_error(file, document_.ErrorLineNum(), "not an XML file: " + io::xml_problem(document_));
  }
  robot_.positions = take_positions(document_);
}

std::vector<double> SourceReader::numbers(const XMLElement& element, const char* attribute, std::size_t count,
                                          const std::string& name) const {
  std::vector<double> values;
  const std::string text = attribute_text(element, attribute);
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    const char* begin = word.data() + (word.starts_with('+') ? 1 : 0);
    const char* const end = word.data() + word.size();
    double value = 0.0;
    const auto [stop, error] = std::from_chars(begin, end, value);
    if (error != std::errc() || stop != end || !std::isfinite(value)) {
      fail(element, name, fmt::format("{} = \"{}\": must be finite numbers", attribute, io::on_one_line(text)));
    }
    values.push_back(value);
  }
  if (values.size() != count)
    fail(element, name,
         fmt::format("{} = \"{}\": must be {} number{}", attribute, io::on_one_line(text), count,
                     count == 1 ? "" : "s"));
  return values;
}

double SourceReader::number(const XMLElement& element, const char* attribute, const std::string& name) const {
  return numbers(element, attribute, 1, name).front();
}

std::optional<double> SourceReader::optional_number(const XMLElement& element, const char* attribute,
                                                    const std::string& name) const {
  if (element.Attribute(attribute) == nullptr) return std::nullopt;
  return number(element, attribute, name);
}

double SourceReader::positive(const XMLElement& element, const char* attribute, const std::string& name) const {
  const double value = number(element, attribute, name);
  if (value <= 0.0) fail(element, name, fmt::format("{} = {}: must be positive", attribute, value));
  return value;
}

Eigen::Vector3d SourceReader::vector(const XMLElement& element, const char* attribute, const std::string& name) const {
  const std::vector<double> values = numbers(element, attribute, 3, name);
  return {values[0], values[1], values[2]};
}

Pose3 SourceReader::origin(const XMLElement& parent, const std::string& name) const {
  const XMLElement* element = parent.FirstChildElement("origin");
  Pose3 pose;
  if (element == nullptr) return pose;
  if (element->Attribute("xyz") != nullptr) pose.position = vector(*element, "xyz", name);
  if (element->Attribute("rpy") != nullptr) {
    const Eigen::Vector3d rpy = vector(*element, "rpy", name);
    pose.rotation = quaternion_from_rpy(rpy.x(), rpy.y(), rpy.z());
  }
  return pose;
}

std::string SourceReader::required_name(const XMLElement& element) const {
  std::string name = attribute_text(element, "name");
  if (name.empty()) fail(element, fmt::format("<{}>", element.Name()), "name is missing");
  if (!io::is_utf8(name)) fail(element, io::on_one_line(name), "name is not UTF-8: the file must be saved as UTF-8");
  if (io::has_control_characters(name)) fail(element, io::on_one_line(name), "name must have no control characters");
  return name;
}

std::optional<Eigen::Vector4d> SourceReader::read_color(const XMLElement& material, const std::string& name) const {
  if (const XMLElement* color = material.FirstChildElement("color")) {
    const std::vector<double> rgba = numbers(*color, "rgba", 4, name);
    return Eigen::Vector4d(rgba[0], rgba[1], rgba[2], rgba[3]).cwiseMax(0.0).cwiseMin(1.0);
  }
  const auto found = materials_.find(attribute_text(material, "name"));
  return found == materials_.end() ? std::nullopt : std::optional(found->second);
}

/// Reads the colors of materials of the robot and of its links, which may be referred to before they are defined.
void SourceReader::read_materials(const XMLElement& root) {
  for_each_below(root, [this](const XMLElement& element) {
    if (element.Name() != std::string("material") || element.FirstChildElement("color") == nullptr) return;
    const std::string name = attribute_text(element, "name");
    if (const auto color = read_color(element, name); color && !name.empty()) materials_.try_emplace(name, *color);
  });
}

/// Reads the scale of a mesh: three numbers, or one for all axes. A fourth number, as some simulators write it, has no
/// meaning.
Eigen::Vector3d SourceReader::read_scale(const XMLElement& element, const std::string& link) {
  std::istringstream words(attribute_text(element, "scale"));
  const auto count = std::distance(std::istream_iterator<std::string>(words), {});
  std::vector<double> values =
      numbers(element, "scale", count == 1 || count == 4 ? static_cast<std::size_t>(count) : 3, link);
  if (count == 1) values.resize(3, values.front());
  const Eigen::Vector3d scale(values[0], values[1], values[2]);
  if (scale.cwiseAbs().minCoeff() <= 0.0) fail(element, link, "scale: must not be zero");
  if (count == 4) {
    robot_.assumptions.push_back({.subject = link,
                                  .text = "the fourth number of the scale of its mesh is left out",
                                  .override_with = "attribute scale of <mesh>"});
  }
  return scale;
}

void SourceReader::read_mesh(const XMLElement& element, const std::string& link, Shape& shape) {
  const std::string uri = attribute_text(element, "filename");
  if (uri.empty()) fail(element, link, "<mesh>: filename is missing");
  const bool has_scale = element.Attribute("scale") != nullptr;
  const Eigen::Vector3d scale = has_scale ? read_scale(element, link) : Eigen::Vector3d::Ones();
  std::filesystem::path path;
  try {
    path = packages_.find_mesh(uri);
    if (path.lexically_normal() != named_path(packages_, uri))
      elsewhere_[packages_.relative(path.parent_path())].insert(path.filename().string());
    const std::string extension = to_lower(path.extension().string());
    constexpr std::array kExtensions = {".stl", ".obj", ".dae", ".gltf", ".glb"};
    if (std::ranges::find(kExtensions, extension) == kExtensions.end())
      throw InputError(fmt::format("{}: mesh must be an STL, OBJ, DAE, glTF or GLB file", path.string()));
    const std::string key =
        fmt::format("{} {}", path.string(), has_scale ? fmt::format("{} {} {}", scale.x(), scale.y(), scale.z()) : "-");
    auto& loaded = meshes_[key];
    if (!loaded) {
      std::vector<MeshPart> parts = load_mesh(path);
      for (MeshPart& part : parts) part.mesh = scaled(part.mesh, scale);
      loaded = std::make_shared<const std::vector<MeshPart>>(std::move(parts));
      if (!has_scale) unscaled_[key] = extension;
    }
    shape.mesh = loaded;
  } catch (const MeshNotFound&) {
    throw;
  } catch (const InputError& error) {
    fail(element, link, error.what());
  }
  shape.type = ShapeType::kMesh;
  shape.mesh_name = path.stem().string();
}

/// Reads a visual or collision. Returns none for a sphere without size, and for a visual whose mesh is not found.
std::optional<Shape> SourceReader::read_shape(const XMLElement& element, const std::string& link) {
  Shape shape{.T_link_shape = origin(element, link), .line = element.GetLineNum()};
  const XMLElement* geometry = element.FirstChildElement("geometry");
  if (geometry == nullptr) fail(element, link, fmt::format("<{}>: <geometry> is missing", element.Name()));
  const XMLElement* form = geometry->FirstChildElement();
  if (form == nullptr) fail(*geometry, link, "<geometry> is empty: must be box, cylinder, sphere or mesh");
  const std::string name = form->Name();
  if (name == "box") {
    shape.type = ShapeType::kBox;
    shape.size_m = vector(*form, "size", link);
    if (shape.size_m.minCoeff() < 0.0) fail(*form, link, "size of a box must not be negative");
  } else if (name == "cylinder") {
    shape.type = ShapeType::kCylinder;
    shape.radius_m = positive(*form, "radius", link);
    shape.length_m = positive(*form, "length", link);
  } else if (name == "sphere") {
    shape.type = ShapeType::kSphere;
    if (number(*form, "radius", link) == 0.0) {
      robot_.assumptions.push_back({.subject = link,
                                    .text = fmt::format("its {} sphere of radius 0 is left out", element.Name()),
                                    .override_with = "attribute radius of <sphere>"});
      return std::nullopt;
    }
    shape.radius_m = positive(*form, "radius", link);
  } else if (name == "mesh") {
    try {
      read_mesh(*form, link, shape);
    } catch (const MeshNotFound& error) {
      if (element.Name() != std::string("visual")) fail(*form, link, error.what());
      missing_visuals_.push_back({link, form->GetLineNum(), attribute_text(*form, "filename"), error.what()});
      return std::nullopt;
    }
  } else {
    fail(*form, link, fmt::format("<{}>: unknown shape: must be box, cylinder, sphere or mesh", name));
  }
  if (const XMLElement* material = element.FirstChildElement("material")) shape.rgba = read_color(*material, link);
  return shape;
}

SourceInertial SourceReader::read_inertial(const XMLElement& element, const std::string& link) const {
  SourceInertial inertial{.T_link_inertia = origin(element, link), .line = element.GetLineNum()};
  const XMLElement* mass = element.FirstChildElement("mass");
  if (mass == nullptr) fail(element, link, "<inertial>: <mass> is missing");
  inertial.mass_kg = number(*mass, "value", link);
  inertial.line = mass->GetLineNum();
  if (inertial.mass_kg < 0.0) fail(*mass, link, fmt::format("mass = {}: must be positive", inertial.mass_kg));
  if (const XMLElement* tensor = element.FirstChildElement("inertia")) {
    const auto value = [&](const char* name) { return optional_number(*tensor, name, link).value_or(0.0); };
    const std::array<const char*, 3> diagonal = {"ixx", "iyy", "izz"};
    const auto is_missing = [&](const char* name) { return tensor->Attribute(name) == nullptr; };
    const auto missing = std::find_if(diagonal.begin(), diagonal.end(), is_missing);
    if (missing != diagonal.end() && !std::all_of(diagonal.begin(), diagonal.end(), is_missing))
      fail(*tensor, link, fmt::format("<inertia>: {} is missing", *missing));
    const double xx = value("ixx"), yy = value("iyy"), zz = value("izz");
    const double xy = value("ixy"), xz = value("ixz"), yz = value("iyz");
    inertial.inertia << xx, xy, xz, xy, yy, yz, xz, yz, zz;
    inertial.line = tensor->GetLineNum();
  }
  return inertial;
}

void SourceReader::read_link(const XMLElement& element) {
  SourceLink link{.name = required_name(element), .line = element.GetLineNum()};
  if (const SourceLink* other = robot_.find_link(link.name))
    fail(element, link.name, "duplicate link: also in " + robot_.short_location(other->line));
  if (const XMLElement* inertial = element.FirstChildElement("inertial"))
    link.inertial = read_inertial(*inertial, link.name);
  for (const auto& [tag, shapes] : {std::pair{"visual", &link.visuals}, std::pair{"collision", &link.collisions}}) {
    for (const XMLElement* at = element.FirstChildElement(tag); at != nullptr; at = at->NextSiblingElement(tag)) {
      if (auto shape = read_shape(*at, link.name)) shapes->push_back(std::move(*shape));
    }
  }
  robot_.links.push_back(std::move(link));
}

void SourceReader::read_joint(const XMLElement& element) {
  SourceJoint joint{.name = required_name(element), .line = element.GetLineNum()};
  const auto [other, is_new] = joint_lines_.emplace(joint.name, joint.line);
  if (!is_new) fail(element, joint.name, "duplicate joint: also in " + robot_.short_location(other->second));
  joint.type = joint_type(element, joint.name);
  for (const auto& [tag, link] : {std::pair{"parent", &joint.parent}, std::pair{"child", &joint.child}}) {
    const XMLElement* end = element.FirstChildElement(tag);
    if (end == nullptr || end->Attribute("link") == nullptr)
      fail(element, joint.name, fmt::format("<{} link=\"...\"/> is missing", tag));
    *link = end->Attribute("link");
    if (robot_.find_link(*link) == nullptr)
      fail(*end, joint.name, fmt::format("unknown {} link: {}", tag, io::on_one_line(*link)));
  }
  joint.T_parent_child = origin(element, joint.name);
  if (const XMLElement* axis = element.FirstChildElement("axis")) read_axis(*axis, joint);
  const bool needs_limit = joint.type == JointType::kRevolute || joint.type == JointType::kPrismatic;
  if (const XMLElement* limit = element.FirstChildElement("limit")) read_limit(*limit, needs_limit, joint);
  else if (needs_limit)
    fail(element, joint.name,
         fmt::format("<limit> is missing: required for a {} joint", attribute_text(element, "type")));
  if (const XMLElement* dynamics = element.FirstChildElement("dynamics")) {
    joint.damping = std::max(0.0, optional_number(*dynamics, "damping", joint.name).value_or(0.0));
    joint.friction = std::max(0.0, optional_number(*dynamics, "friction", joint.name).value_or(0.0));
  }
  if (const XMLElement* mimic = element.FirstChildElement("mimic")) read_mimic(*mimic, joint);
  robot_.joints.push_back(std::move(joint));
}

JointType SourceReader::joint_type(const XMLElement& element, const std::string& joint) const {
  const std::string type = attribute_text(element, "type");
  const auto found = kJointTypes.find(type);
  if (found != kJointTypes.end()) return found->second;
  fail(element, joint,
       fmt::format("unknown joint type \"{}\": must be fixed, continuous, revolute, prismatic, floating or planar",
                   io::on_one_line(type)));
}

void SourceReader::read_axis(const XMLElement& axis, SourceJoint& joint) const {
  joint.axis = vector(axis, "xyz", joint.name);
  const bool has_axis = joint.type != JointType::kFixed && joint.type != JointType::kFloating;
  if (joint.axis.norm() < 1e-9) {
    if (has_axis) fail(axis, joint.name, "axis: must not be zero");
    joint.axis = Eigen::Vector3d::UnitX();
  }
  joint.axis.normalize();
}

void SourceReader::read_limit(const XMLElement& limit, bool needs_limit, SourceJoint& joint) {
  joint.lower = optional_number(limit, "lower", joint.name).value_or(0.0);
  joint.upper = optional_number(limit, "upper", joint.name).value_or(0.0);
  joint.effort = optional_number(limit, "effort", joint.name);
  joint.velocity = optional_number(limit, "velocity", joint.name);
  for (const auto& [attribute, value] : {std::pair{"effort", joint.effort}, std::pair{"velocity", joint.velocity}}) {
    if (value && *value < 0.0)
      fail(limit, joint.name, fmt::format("limit {} = {}: must not be negative", attribute, *value));
  }
  const bool is_given = limit.Attribute("lower") != nullptr || limit.Attribute("upper") != nullptr;
  if (!needs_limit || !is_given) return;
  if (joint.lower == 0.0 && joint.upper == 0.0) {
    joint.type = JointType::kFixed;
    robot_.assumptions.push_back({.subject = joint.name,
                                  .text = "fixed at zero: its limits lower and upper are both 0",
                                  .override_with = "<limit lower upper> of the joint"});
  } else if (joint.lower >= joint.upper) {
    fail(limit, joint.name, fmt::format("limit lower = {}: must be below upper = {}", joint.lower, joint.upper));
  }
}

void SourceReader::read_mimic(const XMLElement& mimic, SourceJoint& joint) const {
  joint.is_mimic = true;
  joint.mimic_line = mimic.GetLineNum();
  joint.mimicked = attribute_text(mimic, "joint");
  if (joint.mimicked.empty()) fail(mimic, joint.name, "<mimic>: joint is missing");
  for (const char* attribute : {"multiplier", "offset"}) optional_number(mimic, attribute, joint.name);
}

SourceRobot SourceReader::read() {
  const XMLElement* root = document_.FirstChildElement("robot");
  if (root == nullptr) {
    const XMLElement* other = document_.RootElement();
    const std::string found = other != nullptr ? other->Name() : "";
    const std::string kind = found == "mujoco" ? " of MuJoCo" : found == "sdf" ? " in SDF" : "";
    throw input_error(robot_.file, other != nullptr ? other->GetLineNum() : 0,
                      kind.empty() ? "<robot> is missing: must be a URDF file"
                                   : fmt::format("is a model{}: robots are read from URDF and xacro only", kind));
  }
  robot_.name = attribute_text(*root, "name");
  read_materials(*root);
  const auto for_each = [root](const char* tag, const auto& read) {
    for (const XMLElement* element = root->FirstChildElement(tag); element != nullptr;
         element = element->NextSiblingElement(tag))
      read(*element);
  };
  for_each("link", [this](const XMLElement& element) { read_link(element); });
  if (robot_.links.empty()) fail(*root, "<robot>", "has no links");
  for_each("joint", [this](const XMLElement& element) { read_joint(element); });
  check_tree();
  check_mimics();
  check_missing_visuals();
  report_misspelled_elements(*root);
  report_meshes_elsewhere();
  check_inertias();
  read_motors(*root);
  read_sensors(*root);
  scale_millimeters();
  check_sizes();
  return std::move(robot_);
}

SourceRobot read_source_robot(const std::string& file, const std::string& text, const Packages& packages) {
  return SourceReader(file, text, packages).read();
}

}  // namespace patrol::importer
