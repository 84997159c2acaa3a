#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <sstream>
#include <string>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "core/geometry/angles.h"
#include "importer/robot/source_reader.h"
#include "importer/xml_elements.h"
#include "io/files/one_line.h"

namespace patrol::importer {

using tinyxml2::XMLElement;

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
      if (needs_interface) read_command_limits(*joint, name);
    }
  });
}

/// Takes the limits of speed and torque of a joint from its command interfaces, if they are below those of <limit>.
void SourceReader::read_command_limits(const XMLElement& control, const std::string& name) {
  const auto joint = std::ranges::find(robot_.joints, name, &SourceJoint::name);
  if (joint == robot_.joints.end()) return;
  for (const XMLElement* interface = control.FirstChildElement("command_interface"); interface != nullptr;
       interface = interface->NextSiblingElement("command_interface")) {
    const std::string kind = attribute_text(*interface, "name");
    if (kind != "velocity" && kind != "effort") continue;
    double limit = 0.0;
    for (const XMLElement* param = interface->FirstChildElement("param"); param != nullptr;
         param = param->NextSiblingElement("param")) {
      const std::string bound = attribute_text(*param, "name");
      if (bound == "min" || bound == "max")
        limit = std::max(limit, std::abs(number_of(*param, param->GetText(), name, bound, "command interface")));
    }
    std::optional<double>& stated = kind == "velocity" ? joint->velocity : joint->effort;
    if (limit <= 0.0 || !std::isfinite(limit) || (stated.value_or(0.0) > 0.0 && *stated <= limit)) continue;
    const std::string unit = kind == "velocity" ? "rad/s" : "N m";
    const std::string discarded =
        stated.value_or(0.0) > 0.0 ? fmt::format(", instead of the {:.4g} {} of <limit>", *stated, unit) : "";
    stated = limit;
    robot_.assumptions.push_back(
        {.subject = name,
         .text = fmt::format("{} limit {:.4g} {} is that of its command interface{}",
                             kind == "velocity" ? "speed" : "torque", limit, unit, discarded),
         .override_with = "<param name=\"min\"> and <param name=\"max\"> of the <command_interface>"});
  }
}

namespace {

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

}  // namespace

/// Returns the number in a text of an element of a sensor or an interface, which may be infinite.
double SourceReader::number_of(const XMLElement& element, const char* raw, const std::string& subject,
                               const std::string& name, const char* owner) const {
  const std::string text = trimmed(raw);
  const char* const end = text.data() + text.size();
  double value = 0.0;
  const auto [stop, error] = std::from_chars(text.data() + (text.starts_with('+') ? 1 : 0), end, value);
  if (error != std::errc() || stop != end || std::isnan(value)) {
    fail(element, subject, fmt::format("{} = \"{}\" of its {}: must be a number", name, io::on_one_line(text), owner));
  }
  return value;
}

/// Returns a number of an element, of its attribute or child; none if it has neither.
std::optional<double> SourceReader::sensor_number(const XMLElement& element, const char* name,
                                                  const std::string& link) const {
  if (const char* text = element.Attribute(name)) return number_of(element, text, link, name, "sensor");
  const XMLElement* child = element.FirstChildElement(name);
  if (child == nullptr) return std::nullopt;
  return number_of(*child, child->GetText(), link, name, "sensor");
}

/// Reads the numbers of a lidar. A field of view that is not symmetric turns the frame to its middle.
void SourceReader::read_scan(const XMLElement& sensor, SourceSensor& found) {
  if (const auto rate_hz = sensor_number(sensor, "update_rate", found.link); rate_hz && *rate_hz > 0.0)
    found.stated["rate_hz"] = *rate_hz;
  for_each_below(sensor, [&](const XMLElement& element) {
    const std::string tag = element.Name();
    if (tag == "horizontal") read_field_of_view(element, found);
    else if (tag == "vertical" && found.frame == "lidar3d") read_rings(element, found);
    else if (tag == "range") read_range(element, found);
  });
}

void SourceReader::read_field_of_view(const XMLElement& horizontal, SourceSensor& found) {
  constexpr double kSymmetric_rad = 0.02, kFull_deg = 359.0;
  if (const auto samples = sensor_number(horizontal, "samples", found.link)) found.stated["beams"] = *samples;
  const std::optional<double> min = sensor_number(horizontal, "min_angle", found.link),
                              max = sensor_number(horizontal, "max_angle", found.link);
  if (!min || !max) return;
  if (!(*max > *min)) {
    robot_.assumptions.push_back(
        {.subject = found.link,
         .text = fmt::format("the field of view of its lidar selects no preset: max_angle = {} is not above "
                             "min_angle = {} ({})",
                             *max, *min, robot_.short_location(horizontal.GetLineNum())),
         .override_with = "<min_angle> and <max_angle> of the sensor"});
    return;
  }
  const double fov_deg = std::min(360.0, kDegPerRad * (*max - *min)), middle_rad = 0.5 * (*min + *max);
  found.stated["fov_deg"] = fov_deg;
  if (std::abs(middle_rad) > kSymmetric_rad && fov_deg < kFull_deg)
    found.T_link_sensor = found.T_link_sensor * Pose3{Eigen::Vector3d::Zero(), quaternion_from_yaw(middle_rad)};
}

void SourceReader::read_rings(const XMLElement& vertical, SourceSensor& found) const {
  if (const auto samples = sensor_number(vertical, "samples", found.link)) found.stated["rings"] = *samples;
  const std::optional<double> min = sensor_number(vertical, "min_angle", found.link),
                              max = sensor_number(vertical, "max_angle", found.link);
  if (!min || !max || !(*max > *min)) return;
  found.stated["elevation_min_deg"] = kDegPerRad * *min;
  found.stated["elevation_max_deg"] = kDegPerRad * *max;
}

void SourceReader::read_range(const XMLElement& range, SourceSensor& found) {
  if (const auto min = sensor_number(range, "min", found.link); min && *min > 0.0) found.stated["range_min_m"] = *min;
  const std::optional<double> max = sensor_number(range, "max", found.link);
  if (!max) return;
  if (*max > 0.0) {
    found.stated["range_max_m"] = *max;
    return;
  }
  robot_.assumptions.push_back({.subject = found.link,
                                .text = fmt::format("the range of its lidar selects no preset: max = {} is not "
                                                    "positive ({})",
                                                    *max, robot_.short_location(range.GetLineNum())),
                                .override_with = "<range> of the sensor"});
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
  if (found.frame.starts_with("lidar")) read_scan(sensor, found);
  robot_.sensors.push_back(found);
}

/// Reports a sensor of a link that the file does not have.
void SourceReader::report_unknown_link(const std::string& link, int line, const std::string& override_with) {
  robot_.assumptions.push_back(
      {.subject = link,
       .text = fmt::format("unknown link: its sensor in {} is left out", robot_.short_location(line)),
       .override_with = override_with});
}

/// Reads the friction coefficients of a link; mu2 is mu1 if only this is given. They only make a row: texts that are no
/// numbers are left out.
void SourceReader::read_friction(const XMLElement& gazebo, const std::string& link) {
  const auto value_of = [&](const char* name) -> std::optional<double> {
    const XMLElement* element = gazebo.FirstChildElement(name);
    if (element == nullptr) return std::nullopt;
    const char* attribute = element->Attribute("value");
    double value = 0.0;
    const char* text = attribute != nullptr ? attribute : element->GetText();
    return text != nullptr && tinyxml2::XMLUtil::ToDouble(text, &value) ? std::optional(value) : std::nullopt;
  };
  const std::optional<double> mu1 = value_of("mu1"), mu2 = value_of("mu2");
  if (mu1 || mu2) robot_.frictions[link] = {mu1 ? *mu1 : *mu2, mu2 ? *mu2 : *mu1};
}

void SourceReader::read_sensors(const XMLElement& root) {
  for (const XMLElement* gazebo = root.FirstChildElement("gazebo"); gazebo != nullptr;
       gazebo = gazebo->NextSiblingElement("gazebo")) {
    const std::string link = attribute_text(*gazebo, "reference");
    if (robot_.find_link(link) == nullptr) {
      if (!link.empty() && gazebo->FirstChildElement("sensor") != nullptr)
        report_unknown_link(link, gazebo->GetLineNum(), "attribute reference of <gazebo>");
      continue;
    }
    read_friction(*gazebo, link);
    for (const XMLElement* sensor = gazebo->FirstChildElement("sensor"); sensor != nullptr;
         sensor = sensor->NextSiblingElement("sensor"))
      read_gazebo_sensor(*sensor, link);
  }
  for (const XMLElement* sensor = root.FirstChildElement("sensor"); sensor != nullptr;
       sensor = sensor->NextSiblingElement("sensor")) {
    const XMLElement* parent = sensor->FirstChildElement("parent");
    if (parent == nullptr || sensor->FirstChildElement("ray") == nullptr) continue;
    if (robot_.find_link(attribute_text(*parent, "link")) == nullptr) {
      report_unknown_link(attribute_text(*parent, "link"), parent->GetLineNum(), "<parent link> of the sensor");
      continue;
    }
    SourceSensor found{.frame = vertical_samples(*sensor) > 1 ? "lidar3d" : "lidar",
                       .link = attribute_text(*parent, "link"),
                       .T_link_sensor = origin(*sensor, attribute_text(*sensor, "name")),
                       .line = sensor->GetLineNum()};
    read_scan(*sensor, found);
    robot_.sensors.push_back(found);
  }
}

}  // namespace patrol::importer
