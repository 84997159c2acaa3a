#include "importer/robot/normalized_robot.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "io/files/markup_text.h"

namespace patrol::importer {
namespace {

std::string number_text(double value) { return fmt::format("{:.12g}", std::abs(value) < 1e-12 ? 0.0 : value); }

std::string vector_text(const Eigen::Vector3d& v) {
  return fmt::format("{} {} {}", number_text(v.x()), number_text(v.y()), number_text(v.z()));
}

/// Returns roll, pitch and yaw of R = Rz(yaw) Ry(pitch) Rx(roll).
Eigen::Vector3d rpy_of(const Eigen::Quaterniond& rotation) {
  const Eigen::Matrix3d R = rotation.normalized().toRotationMatrix();
  const double pitch = std::atan2(-R(2, 0), std::hypot(R(0, 0), R(1, 0)));
  if (std::hypot(R(0, 0), R(1, 0)) < 1e-9) return {0.0, pitch, std::atan2(-R(0, 1), R(1, 1))};
  return {std::atan2(R(2, 1), R(2, 2)), pitch, std::atan2(R(1, 0), R(0, 0))};
}

std::string origin_text(const Pose3& pose) {
  return fmt::format(R"(<origin xyz="{}" rpy="{}"/>)", vector_text(pose.position), vector_text(rpy_of(pose.rotation)));
}

std::string geometry_text(const NormalizedShape& shape) {
  if (!shape.mesh_file.empty()) return fmt::format(R"(<mesh filename="{}"/>)", io::escaped_markup(shape.mesh_file));
  const Shape& form = shape.shape;
  switch (form.type) {
    case ShapeType::kBox:
      return fmt::format(R"(<box size="{}"/>)", vector_text(form.size_m));
    case ShapeType::kCylinder:
      return fmt::format(R"(<cylinder radius="{}" length="{}"/>)", number_text(form.radius_m),
                         number_text(form.length_m));
    default:
      return fmt::format(R"(<sphere radius="{}"/>)", number_text(form.radius_m));
  }
}

std::string rgba_text(const Eigen::Vector4d& rgba) {
  return fmt::format("{:.3g} {:.3g} {:.3g} {:.3g}", rgba[0], rgba[1], rgba[2], rgba[3]);
}

/// Colors of all visuals, each a material of the robot.
class Palette {
 public:
  explicit Palette(const NormalizedRobot& robot) {
    for (const NormalizedLink& link : robot.links) {
      for (const NormalizedShape& visual : link.visuals) {
        if (visual.rgba && !index_of(*visual.rgba)) colors_.push_back(rgba_text(*visual.rgba));
      }
    }
  }
  std::optional<std::size_t> index_of(const Eigen::Vector4d& rgba) const {
    const auto found = std::find(colors_.begin(), colors_.end(), rgba_text(rgba));
    return found == colors_.end() ? std::nullopt : std::optional(static_cast<std::size_t>(found - colors_.begin()));
  }
  std::string text() const {
    std::string text;
    for (std::size_t i = 0; i < colors_.size(); ++i)
      text += fmt::format("  <material name=\"color_{}\"><color rgba=\"{}\"/></material>\n", i, colors_[i]);
    return text;
  }

 private:
  std::vector<std::string> colors_;
};

std::string inertial_text(const Inertial& inertial) {
  const Eigen::Matrix3d& I = inertial.inertia;
  return fmt::format(
      "    <inertial>\n      {}\n      <mass value=\"{}\"/>\n      <inertia ixx=\"{}\" ixy=\"{}\" ixz=\"{}\" "
      "iyy=\"{}\" iyz=\"{}\" izz=\"{}\"/>\n    </inertial>\n",
      origin_text(inertial.T_link_inertia), number_text(inertial.mass_kg), number_text(I(0, 0)), number_text(I(0, 1)),
      number_text(I(0, 2)), number_text(I(1, 1)), number_text(I(1, 2)), number_text(I(2, 2)));
}

std::string joint_text(const NormalizedJoint& joint, const std::string& child) {
  const char* type = joint.is_fixed ? "fixed" : joint.range ? "revolute" : "continuous";
  std::string text =
      fmt::format("  <joint name=\"{}\" type=\"{}\">\n    <parent link=\"{}\"/>\n    <child link=\"{}\"/>\n    {}\n",
                  io::escaped_markup(joint.name), type, io::escaped_markup(joint.parent), io::escaped_markup(child),
                  origin_text(joint.T_parent_link));
  if (!joint.is_fixed) {
    text += fmt::format("    <axis xyz=\"{}\"/>\n", vector_text(joint.axis));
    if (joint.motor) {
      const std::string range = joint.range
                                    ? fmt::format("lower=\"{}\" upper=\"{}\" ", number_text(joint.range->lower_rad),
                                                  number_text(joint.range->upper_rad))
                                    : "";
      text += fmt::format("    <limit {}effort=\"{}\" velocity=\"{}\"/>\n", range, number_text(joint.motor->effort_nm),
                          number_text(joint.motor->velocity_radps));
    }
    text += fmt::format("    <dynamics damping=\"{}\" friction=\"{}\"/>\n", number_text(joint.damping),
                        number_text(joint.friction));
  }
  return text + "  </joint>\n";
}

std::string link_text(const NormalizedLink& link, const Palette& palette) {
  const std::string name = io::escaped_markup(link.name);
  std::string content;
  if (link.inertial) content += inertial_text(*link.inertial);
  for (const NormalizedShape& visual : link.visuals) {
    const std::string material =
        visual.rgba ? fmt::format(R"(<material name="color_{}"/>)", *palette.index_of(*visual.rgba)) : "";
    content += fmt::format("    <visual>{}<geometry>{}</geometry>{}</visual>\n", origin_text(visual.shape.T_link_shape),
                           geometry_text(visual), material);
  }
  for (const NormalizedShape& collision : link.collisions) {
    content += fmt::format("    <collision>{}<geometry>{}</geometry></collision>\n",
                           origin_text(collision.shape.T_link_shape), geometry_text(collision));
  }
  if (content.empty()) return fmt::format("  <link name=\"{}\"/>\n", name);
  return fmt::format("  <link name=\"{}\">\n{}  </link>\n", name, content);
}

}  // namespace

Inertial combine(const std::vector<std::pair<Pose3, Inertial>>& parts) {
  if (parts.size() == 1) {
    Inertial result = parts.front().second;
    result.T_link_inertia = parts.front().first * result.T_link_inertia;
    return result;
  }
  Inertial result;
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  for (const auto& [pose, part] : parts) {
    result.mass_kg += part.mass_kg;
    first += part.mass_kg * (pose * part.T_link_inertia.position);
  }
  if (result.mass_kg <= 0.0) return result;
  const Eigen::Vector3d center = first / result.mass_kg;
  result.T_link_inertia.position = center;
  for (const auto& [pose, part] : parts) {
    const Eigen::Matrix3d R = (pose.rotation * part.T_link_inertia.rotation).toRotationMatrix();
    const Eigen::Vector3d arm = pose * part.T_link_inertia.position - center;
    result.inertia += R * part.inertia * R.transpose() +
                      part.mass_kg * (arm.squaredNorm() * Eigen::Matrix3d::Identity() - arm * arm.transpose());
  }
  return result;
}

std::string to_urdf(const NormalizedRobot& robot, const std::string& comment) {
  const Palette palette(robot);
  std::string safe_comment = io::escaped_markup(comment);  // XML comments contain no two hyphens in a row
  for (std::size_t at = 0; (at = safe_comment.find("--", at)) != std::string::npos;) safe_comment.replace(at, 2, "- -");
  std::string text = fmt::format("<?xml version=\"1.0\"?>\n<!-- {} -->\n<robot name=\"{}\">\n{}", safe_comment,
                                 io::escaped_markup(robot.name), palette.text());
  for (const NormalizedLink& link : robot.links) {
    text += "\n";
    if (link.joint) text += joint_text(*link.joint, link.name);
    text += link_text(link, palette);
  }
  return text + "</robot>\n";
}

}  // namespace patrol::importer
