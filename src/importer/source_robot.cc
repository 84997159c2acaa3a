#include "importer/source_robot.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <numbers>
#include <sstream>
#include <utility>

#include <fmt/format.h>
#include <tinyxml2.h>

#include "core/error.h"
#include "core/geometry/angles.h"
#include "core/geometry/linear_algebra.h"
#include "io/files/one_line.h"

namespace patrol::importer {
namespace {

using tinyxml2::XMLElement;

constexpr double kMaxRobot_m = 20.0;

const std::map<std::string, JointType> kJointTypes = {
    {"fixed", JointType::kFixed},         {"continuous", JointType::kContinuous}, {"revolute", JointType::kRevolute},
    {"prismatic", JointType::kPrismatic}, {"floating", JointType::kFloating},     {"planar", JointType::kPlanar}};

std::string attribute_text(const XMLElement& element, const char* name) {
  const char* text = element.Attribute(name);
  return text == nullptr ? "" : text;
}

/// Calls `visit` with every element below `root`.
void for_each_below(const XMLElement& root, const std::function<void(const XMLElement&)>& visit) {
  for (const XMLElement* child = root.FirstChildElement(); child != nullptr; child = child->NextSiblingElement()) {
    visit(*child);
    for_each_below(*child, visit);
  }
}

std::string trimmed(const char* text) {
  std::string word = text == nullptr ? "" : text;
  word.erase(0, word.find_first_not_of(" \t\r\n"));
  word.erase(word.find_last_not_of(" \t\r\n") + 1);
  return word;
}

/// Returns XML_ERROR_MISMATCHED_ELEMENT as "mismatched element".
std::string plain_words(std::string name) {
  const std::string prefix = "XML_ERROR_";
  if (name.starts_with(prefix)) name.erase(0, prefix.size());
  for (char& c : name) c = c == '_' ? ' ' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return name;
}

/// Reader of the elements of a description.
class SourceReader {
 public:
  SourceReader(const std::string& file, const std::string& text, const Packages& packages)
      : packages_(packages), document_(true, tinyxml2::COLLAPSE_WHITESPACE) {
    robot_.file = file;
    if (trimmed(text.c_str()).empty()) throw InputError(file + ": is empty: must be a URDF file");
    if (document_.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) {
      throw input_error(file, document_.ErrorLineNum(), "not an XML file: " + plain_words(document_.ErrorName()));
    }
  }

  SourceRobot read();

 private:
  [[noreturn]] void fail(const XMLElement& element, const std::string& name, const std::string& what) const {
    robot_.fail(element.GetLineNum(), name, what);
  }

  std::vector<double> numbers(const XMLElement& element, const char* attribute, std::size_t count,
                              const std::string& name) const;
  double number(const XMLElement& element, const char* attribute, const std::string& name) const;
  std::optional<double> optional_number(const XMLElement& element, const char* attribute,
                                        const std::string& name) const;
  double positive(const XMLElement& element, const char* attribute, const std::string& name) const;
  Eigen::Vector3d vector(const XMLElement& element, const char* attribute, const std::string& name) const;
  Pose3 origin(const XMLElement& parent, const std::string& name) const;
  std::string required_name(const XMLElement& element) const;
  void read_materials(const XMLElement& root);
  std::optional<Eigen::Vector4d> read_color(const XMLElement& material, const std::string& name) const;
  Shape read_shape(const XMLElement& element, const std::string& link);
  SourceInertial read_inertial(const XMLElement& element, const std::string& link) const;
  void read_link(const XMLElement& element);
  void read_joint(const XMLElement& element);
  void read_mesh(const XMLElement& element, const std::string& link, Shape& shape);
  void read_motors(const XMLElement& root);
  void read_plugin(const XMLElement& plugin);
  void read_sensors(const XMLElement& root);
  void read_gazebo_sensor(const XMLElement& sensor, const std::string& link);
  void check_tree() const;
  void check_joints() const;
  void scale_millimeters();
  void check_sizes() const;

  const Packages& packages_;
  tinyxml2::XMLDocument document_;
  SourceRobot robot_;
  std::map<std::string, Eigen::Vector4d> materials_;
  std::map<std::string, std::shared_ptr<const std::vector<MeshPart>>> meshes_;  ///< by path and scale
  std::map<std::string, std::string> unscaled_;  ///< key of `meshes_` without scale, to the extension
};

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

void SourceReader::read_mesh(const XMLElement& element, const std::string& link, Shape& shape) {
  const std::string uri = attribute_text(element, "filename");
  if (uri.empty()) fail(element, link, "<mesh>: filename is missing");
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();
  const bool has_scale = element.Attribute("scale") != nullptr;
  if (has_scale) {
    std::istringstream words(attribute_text(element, "scale"));
    const auto count = std::distance(std::istream_iterator<std::string>(words), {});
    scale = count == 1 ? Eigen::Vector3d::Constant(number(element, "scale", link)) : vector(element, "scale", link);
    if (scale.cwiseAbs().minCoeff() <= 0.0) fail(element, link, "scale: must not be zero");
  }
  std::filesystem::path path;
  try {
    path = packages_.resolve(uri);
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (extension != ".stl" && extension != ".obj" && extension != ".dae")
      throw InputError(fmt::format("{}: mesh must be an STL, OBJ or DAE file", path.string()));
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
  } catch (const InputError& error) {
    fail(element, link, error.what());
  }
  shape.type = ShapeType::kMesh;
  shape.mesh_name = path.stem().string();
}

Shape SourceReader::read_shape(const XMLElement& element, const std::string& link) {
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
    shape.radius_m = positive(*form, "radius", link);
  } else if (name == "mesh") {
    read_mesh(*form, link, shape);
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
    fail(element, link.name, fmt::format("duplicate link: also in line {}", other->line));
  if (const XMLElement* inertial = element.FirstChildElement("inertial"))
    link.inertial = read_inertial(*inertial, link.name);
  for (const XMLElement* shape = element.FirstChildElement("visual"); shape != nullptr;
       shape = shape->NextSiblingElement("visual"))
    link.visuals.push_back(read_shape(*shape, link.name));
  for (const XMLElement* shape = element.FirstChildElement("collision"); shape != nullptr;
       shape = shape->NextSiblingElement("collision"))
    link.collisions.push_back(read_shape(*shape, link.name));
  robot_.links.push_back(std::move(link));
}

void SourceReader::read_joint(const XMLElement& element) {
  SourceJoint joint{.name = required_name(element), .line = element.GetLineNum()};
  for (const SourceJoint& other : robot_.joints) {
    if (other.name == joint.name)
      fail(element, joint.name, fmt::format("duplicate joint: also in line {}", other.line));
  }
  const std::string type = attribute_text(element, "type");
  const auto found = kJointTypes.find(type);
  if (found == kJointTypes.end()) {
    fail(element, joint.name,
         fmt::format("unknown joint type \"{}\": must be fixed, continuous, revolute, prismatic, floating or planar",
                     io::on_one_line(type)));
  }
  joint.type = found->second;
  for (const auto& [tag, link] : {std::pair{"parent", &joint.parent}, std::pair{"child", &joint.child}}) {
    const XMLElement* end = element.FirstChildElement(tag);
    if (end == nullptr || end->Attribute("link") == nullptr)
      fail(element, joint.name, fmt::format("<{} link=\"...\"/> is missing", tag));
    *link = end->Attribute("link");
    if (robot_.find_link(*link) == nullptr)
      fail(*end, joint.name, fmt::format("unknown {} link: {}", tag, io::on_one_line(*link)));
  }
  joint.T_parent_child = origin(element, joint.name);
  if (const XMLElement* axis = element.FirstChildElement("axis")) {
    joint.axis = vector(*axis, "xyz", joint.name);
    const bool has_axis = joint.type != JointType::kFixed && joint.type != JointType::kFloating;
    if (joint.axis.norm() < 1e-9) {
      if (has_axis) fail(*axis, joint.name, "axis: must not be zero");
      joint.axis = Eigen::Vector3d::UnitX();
    }
    joint.axis.normalize();
  }
  const XMLElement* limit = element.FirstChildElement("limit");
  const bool needs_limit = joint.type == JointType::kRevolute || joint.type == JointType::kPrismatic;
  if (limit != nullptr) {
    joint.lower = optional_number(*limit, "lower", joint.name).value_or(0.0);
    joint.upper = optional_number(*limit, "upper", joint.name).value_or(0.0);
    joint.effort = optional_number(*limit, "effort", joint.name);
    joint.velocity = optional_number(*limit, "velocity", joint.name);
    const bool is_given = limit->Attribute("lower") != nullptr || limit->Attribute("upper") != nullptr;
    if (needs_limit && is_given && joint.lower >= joint.upper)
      fail(*limit, joint.name, fmt::format("limit lower = {}: must be below upper = {}", joint.lower, joint.upper));
  } else if (needs_limit) {
    fail(element, joint.name, fmt::format("<limit> is missing: required for a {} joint", type));
  }
  if (const XMLElement* dynamics = element.FirstChildElement("dynamics")) {
    joint.damping = std::max(0.0, optional_number(*dynamics, "damping", joint.name).value_or(0.0));
    joint.friction = std::max(0.0, optional_number(*dynamics, "friction", joint.name).value_or(0.0));
  }
  joint.is_mimic = element.FirstChildElement("mimic") != nullptr;
  robot_.joints.push_back(std::move(joint));
}

/// Reads the joints that a drive plugin names: texts of its elements that are names of joints.
void SourceReader::read_plugin(const XMLElement& plugin) {
  const std::string name = attribute_text(plugin, "filename") + attribute_text(plugin, "name");
  if (name.find("joint_state") != std::string::npos || name.find("joint-state") != std::string::npos ||
      name.find("JointState") != std::string::npos)
    return;  // publishes all joints
  for_each_below(plugin, [this](const XMLElement& element) {
    std::istringstream words(trimmed(element.GetText()));
    for (std::string word; words >> word;) {
      while (word.ends_with(',')) word.pop_back();
      for (const SourceJoint& joint : robot_.joints) {
        if (joint.name == word) robot_.motors.insert(word);
      }
    }
  });
}

void SourceReader::read_motors(const XMLElement& root) {
  for_each_below(root, [this](const XMLElement& element) {
    const std::string tag = element.Name();
    if (tag == "plugin") read_plugin(element);
    if (tag != "transmission" && tag != "ros2_control") return;
    const bool needs_interface = tag == "ros2_control";
    for (const XMLElement* joint = element.FirstChildElement("joint"); joint != nullptr;
         joint = joint->NextSiblingElement("joint")) {
      if (needs_interface && joint->FirstChildElement("command_interface") == nullptr) continue;
      const std::string name =
          joint->Attribute("name") != nullptr ? attribute_text(*joint, "name") : trimmed(joint->GetText());
      robot_.motors.insert(name);
    }
  });
}

/// Returns the number of rings of a lidar element; 1 if it has none.
int vertical_samples(const XMLElement& sensor) {
  int samples = 1;
  for_each_below(sensor, [&samples](const XMLElement& element) {
    if (element.Name() != std::string("vertical")) return;
    int value = 1;
    if (element.QueryIntAttribute("samples", &value) == tinyxml2::XML_SUCCESS) samples = value;
    if (const XMLElement* child = element.FirstChildElement("samples")) {
      if (child->QueryIntText(&value) == tinyxml2::XML_SUCCESS) samples = value;
    }
  });
  return samples;
}

/// Returns a number of an element, of its child or attribute; none if it has neither.
std::optional<double> number_in(const XMLElement& element, const char* name) {
  double value = 0.0;
  if (element.QueryDoubleAttribute(name, &value) == tinyxml2::XML_SUCCESS) return value;
  const XMLElement* child = element.FirstChildElement(name);
  if (child != nullptr && child->QueryDoubleText(&value) == tinyxml2::XML_SUCCESS) return value;
  return std::nullopt;
}

/// Reads field of view and range of a lidar. A field of view that is not symmetric turns the frame to its middle.
void read_scan_field(const XMLElement& sensor, SourceSensor& found) {
  double middle_rad = 0.0;
  for_each_below(sensor, [&](const XMLElement& element) {
    const std::string tag = element.Name();
    if (tag == "horizontal") {
      const std::optional<double> min = number_in(element, "min_angle"), max = number_in(element, "max_angle");
      if (!min || !max || !(*max > *min)) return;
      found.fov_deg = kDegPerRad * (*max - *min);
      middle_rad = 0.5 * (*min + *max);
    } else if (tag == "range") {
      found.range_max_m = number_in(element, "max").value_or(0.0);
    }
  });
  constexpr double kSymmetric_rad = 0.02;
  if (std::abs(middle_rad) > kSymmetric_rad && found.fov_deg < 359.0)
    found.T_link_sensor = found.T_link_sensor * Pose3{Eigen::Vector3d::Zero(), quaternion_from_yaw(middle_rad)};
}

void SourceReader::read_gazebo_sensor(const XMLElement& sensor, const std::string& link) {
  const std::string type = attribute_text(sensor, "type");
  SourceSensor found{.link = link, .line = sensor.GetLineNum()};
  if (type == "ray" || type == "gpu_ray" || type == "lidar" || type == "gpu_lidar") {
    found.frame = vertical_samples(sensor) > 1 ? "lidar3d" : "lidar";
  } else if (type == "imu") {
    found.frame = "imu";
  } else if (type == "gps" || type == "navsat") {
    found.frame = "gnss";
  } else if (type == "depth" || type == "depth_camera" || type == "rgbd_camera" || type == "rgbd") {
    found.frame = "depth_camera";
  } else {
    return;
  }
  if (const XMLElement* pose = sensor.FirstChildElement("pose")) {
    std::istringstream words(trimmed(pose->GetText()));
    std::array<double, 6> values{};
    for (double& value : values) words >> value;
    if (words) {
      found.T_link_sensor = {{values[0], values[1], values[2]}, quaternion_from_rpy(values[3], values[4], values[5])};
    }
  }
  if (found.frame.starts_with("lidar")) read_scan_field(sensor, found);
  robot_.sensors.push_back(found);
}

void SourceReader::read_sensors(const XMLElement& root) {
  for (const XMLElement* gazebo = root.FirstChildElement("gazebo"); gazebo != nullptr;
       gazebo = gazebo->NextSiblingElement("gazebo")) {
    const std::string link = attribute_text(*gazebo, "reference");
    if (robot_.find_link(link) == nullptr) continue;
    for (const XMLElement* sensor = gazebo->FirstChildElement("sensor"); sensor != nullptr;
         sensor = sensor->NextSiblingElement("sensor"))
      read_gazebo_sensor(*sensor, link);
  }
  for (const XMLElement* sensor = root.FirstChildElement("sensor"); sensor != nullptr;
       sensor = sensor->NextSiblingElement("sensor")) {
    const XMLElement* parent = sensor->FirstChildElement("parent");
    if (parent == nullptr || robot_.find_link(attribute_text(*parent, "link")) == nullptr) continue;
    if (sensor->FirstChildElement("ray") == nullptr) continue;
    robot_.sensors.push_back({.frame = vertical_samples(*sensor) > 1 ? "lidar3d" : "lidar",
                              .link = attribute_text(*parent, "link"),
                              .T_link_sensor = origin(*sensor, attribute_text(*sensor, "name")),
                              .line = sensor->GetLineNum()});
  }
}

/// Checks that links and joints are one tree.
void SourceReader::check_tree() const {
  std::map<std::string, const SourceJoint*> joint_of;  // child link to joint
  for (const SourceJoint& joint : robot_.joints) {
    const auto [found, is_new] = joint_of.emplace(joint.child, &joint);
    if (!is_new) {
      robot_.fail(joint.line, joint.child,
                  fmt::format("child of two joints, {} and {}: only one is allowed", found->second->name, joint.name));
    }
  }
  for (const SourceLink& link : robot_.links) {
    std::size_t steps = 0;
    for (auto at = joint_of.find(link.name); at != joint_of.end(); at = joint_of.find(at->second->parent)) {
      if (++steps > joint_of.size()) robot_.fail(at->second->line, link.name, "the joints form a cycle");
    }
  }
  const SourceLink* root = nullptr;
  for (const SourceLink& link : robot_.links) {
    if (joint_of.contains(link.name)) continue;
    if (root != nullptr)
      robot_.fail(link.line, link.name,
                  fmt::format("is not connected: the robot has two roots, {} and {}", root->name, link.name));
    root = &link;
  }
}

/// Checks masses and inertias of links below movable joints.
void SourceReader::check_joints() const {
  for (const SourceJoint& joint : robot_.joints) {
    if (joint.type == JointType::kFixed) continue;
    const SourceLink& child = robot_.link(joint.child);
    if (child.inertial && child.inertial->mass_kg <= 0.0)
      robot_.fail(child.inertial->line, child.name, "mass = 0: must be positive for a moving link");
  }
  for (const SourceLink& link : robot_.links) {
    if (!link.inertial || link.inertial->mass_kg <= 0.0) continue;
    const Eigen::Vector3d moments = symmetric_eigen(link.inertial->inertia).values;
    const bool is_physical =
        moments[0] >= -1e-2 * moments[2] && moments[2] >= 0.0 && moments[2] <= 1.01 * (moments[0] + moments[1]);
    if (!is_physical && moments.cwiseAbs().maxCoeff() > 1e-12) {
      robot_.fail(
          link.inertial->line, link.name,
          fmt::format("invalid inertia: principal moments {:.3g}, {:.3g} and {:.3g} kg m2: the largest must not "
                      "exceed the sum of the others",
                      moments[0], moments[1], moments[2]));
    }
  }
}

/// Scales meshes without a unit by 0.001 if one of their format is larger than 20 m.
void SourceReader::scale_millimeters() {
  std::set<std::string> extensions;  // in millimeters
  std::map<const std::vector<MeshPart>*, std::string> extension_of;
  for (const auto& [key, extension] : unscaled_) {
    const auto& mesh = meshes_.at(key);
    extension_of[mesh.get()] = extension;
    for (const MeshPart& part : *mesh) {
      if (std::max(diagonal_m(part.mesh), max_coordinate_m(part.mesh)) > kMaxRobot_m) extensions.insert(extension);
    }
  }
  if (extensions.empty()) return;
  std::map<const std::vector<MeshPart>*, std::shared_ptr<const std::vector<MeshPart>>> replaced;
  for (SourceLink& link : robot_.links) {
    for (std::vector<Shape>* shapes : {&link.visuals, &link.collisions}) {
      for (Shape& shape : *shapes) {
        const auto found = extension_of.find(shape.mesh.get());
        if (found == extension_of.end() || !extensions.contains(found->second)) continue;
        auto& small = replaced[shape.mesh.get()];
        if (!small) {
          std::vector<MeshPart> parts = *shape.mesh;
          for (MeshPart& part : parts) part.mesh = scaled(part.mesh, Eigen::Vector3d::Constant(1e-3));
          small = std::make_shared<const std::vector<MeshPart>>(std::move(parts));
        }
        shape.mesh = small;
      }
    }
  }
  for (const std::string& extension : extensions) {
    robot_.assumptions.push_back(
        {.subject = fmt::format("meshes *{}", extension),
         .text = "are in millimeters and scaled by 0.001: in meters the robot would be larger than 20 m",
         .override_with = "attribute scale of <mesh>"});
  }
}

void SourceReader::check_sizes() const {
  for (const SourceLink& link : robot_.links) {
    for (const std::vector<Shape>* shapes : {&link.visuals, &link.collisions}) {
      for (const Shape& shape : *shapes) {
        if (shape.type != ShapeType::kMesh) continue;
        const double size_m = diagonal_m(whole_mesh(shape));
        if (size_m <= kMaxRobot_m) continue;
        robot_.fail(shape.line, link.name,
                    fmt::format("mesh {} is {:.0f} m large: at most {} m: check its scale", shape.mesh_name, size_m,
                                kMaxRobot_m));
      }
    }
  }
}

SourceRobot SourceReader::read() {
  const XMLElement* root = document_.FirstChildElement("robot");
  if (root == nullptr) {
    const XMLElement* other = document_.RootElement();
    throw input_error(robot_.file, other != nullptr ? other->GetLineNum() : 0,
                      "<robot> is missing: must be a URDF file");
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
  check_joints();
  read_motors(*root);
  read_sensors(*root);
  scale_millimeters();
  check_sizes();
  return std::move(robot_);
}

}  // namespace

bool SourceJoint::is_endless() const {
  constexpr double kTwoTurns_rad = 4.0 * std::numbers::pi - 1e-3;
  return type == JointType::kContinuous || (type == JointType::kRevolute && upper - lower >= kTwoTurns_rad);
}

const SourceLink* SourceRobot::find_link(const std::string& link_name) const {
  const auto found =
      std::find_if(links.begin(), links.end(), [&](const SourceLink& link) { return link.name == link_name; });
  return found == links.end() ? nullptr : &*found;
}

const SourceLink& SourceRobot::link(const std::string& link_name) const {
  const SourceLink* found = find_link(link_name);
  if (found == nullptr) throw InputError(fmt::format("{}: unknown link: {}", file, link_name));
  return *found;
}

const SourceJoint* SourceRobot::parent_joint(const std::string& link_name) const {
  const auto found =
      std::find_if(joints.begin(), joints.end(), [&](const SourceJoint& joint) { return joint.child == link_name; });
  return found == joints.end() ? nullptr : &*found;
}

std::vector<const SourceJoint*> SourceRobot::child_joints(const std::string& link_name) const {
  std::vector<const SourceJoint*> children;
  for (const SourceJoint& joint : joints) {
    if (joint.parent == link_name) children.push_back(&joint);
  }
  return children;
}

const SourceLink& SourceRobot::root() const {
  for (const SourceLink& link : links) {
    if (parent_joint(link.name) == nullptr) return link;
  }
  throw InputError(file + ": the joints form a cycle");
}

void SourceRobot::fail(int line, const std::string& element, const std::string& what) const {
  throw input_error(file, line, fmt::format("{}: {}", io::on_one_line(element), what));
}

SourceRobot read_source_robot(const std::string& file, const std::string& text, const Packages& packages) {
  return SourceReader(file, text, packages).read();
}

}  // namespace patrol::importer
