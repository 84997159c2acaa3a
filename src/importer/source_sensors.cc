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
#include "importer/source_reader.h"
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
    }
  });
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

/// Returns a number of an element, of its attribute or child; none if it has neither. Numbers may be infinite.
std::optional<double> SourceReader::sensor_number(const XMLElement& element, const char* name,
                                                  const std::string& link) const {
  const XMLElement* child = element.FirstChildElement(name);
  const bool is_attribute = element.Attribute(name) != nullptr;
  if (!is_attribute && child == nullptr) return std::nullopt;
  const std::string text = is_attribute ? trimmed(element.Attribute(name)) : trimmed(child->GetText());
  const char* const end = text.data() + text.size();
  double value = 0.0;
  const auto [stop, error] = std::from_chars(text.data() + (text.starts_with('+') ? 1 : 0), end, value);
  if (error != std::errc() || stop != end || std::isnan(value)) {
    fail(is_attribute ? element : *child, link,
         fmt::format("{} = \"{}\" of its sensor: must be a number", name, io::on_one_line(text)));
  }
  return value;
}

/// Reads field of view and range of a lidar. A field of view that is not symmetric turns the frame to its middle.
void SourceReader::read_scan_field(const XMLElement& sensor, SourceSensor& found) {
  double middle_rad = 0.0;
  for_each_below(sensor, [&](const XMLElement& element) {
    const std::string tag = element.Name();
    if (tag == "horizontal") {
      const std::optional<double> min = sensor_number(element, "min_angle", found.link),
                                  max = sensor_number(element, "max_angle", found.link);
      if (!min || !max) return;
      if (!(*max > *min)) {
        robot_.assumptions.push_back(
            {.subject = found.link,
             .text = fmt::format("the field of view of its lidar selects no preset: max_angle = {} is not above "
                                 "min_angle = {} (line {})",
                                 *max, *min, element.GetLineNum()),
             .override_with = "<min_angle> and <max_angle> of the sensor"});
        return;
      }
      found.fov_deg = kDegPerRad * (*max - *min);
      middle_rad = 0.5 * (*min + *max);
    } else if (tag == "range") {
      const std::optional<double> max = sensor_number(element, "max", found.link);
      if (!max) return;
      found.range_max_m = *max;
      if (*max > 0.0) return;
      robot_.assumptions.push_back({.subject = found.link,
                                    .text = fmt::format("the range of its lidar selects no preset: max = {} is not "
                                                        "positive (line {})",
                                                        *max, element.GetLineNum()),
                                    .override_with = "<range> of the sensor"});
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

/// Reports a sensor of a link that the file does not have.
void SourceReader::report_unknown_link(const std::string& link, int line, const std::string& override_with) {
  robot_.assumptions.push_back({.subject = link,
                                .text = fmt::format("unknown link: its sensor in line {} is left out", line),
                                .override_with = override_with});
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
    robot_.sensors.push_back({.frame = vertical_samples(*sensor) > 1 ? "lidar3d" : "lidar",
                              .link = attribute_text(*parent, "link"),
                              .T_link_sensor = origin(*sensor, attribute_text(*sensor, "name")),
                              .line = sensor->GetLineNum()});
  }
}

}  // namespace patrol::importer
