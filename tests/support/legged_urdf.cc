#include "tests/support/legged_urdf.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace patrol::test {
namespace {

constexpr int kHip = 1, kKnee = 2;

std::string words(const Eigen::Vector3d& v) { return fmt::format("{:.12f} {:.12f} {:.12f}", v.x(), v.y(), v.z()); }

std::string origin(const Eigen::Vector3d& p, const Eigen::Matrix3d& R) {
  const Eigen::Vector3d rpy(std::atan2(R(2, 1), R(2, 2)), std::asin(std::clamp(-R(2, 0), -1.0, 1.0)),
                            std::atan2(R(1, 0), R(0, 0)));
  return fmt::format("<origin xyz=\"{}\" rpy=\"{}\"/>", words(p), words(rpy));
}

/// Solid box.
std::string inertial(double mass_kg, const Eigen::Vector3d& size, const Eigen::Vector3d& p, const Eigen::Matrix3d& R) {
  const Eigen::Vector3d s = size.cwiseProduct(size);
  return fmt::format(
      "<inertial>{}<mass value=\"{:.6f}\"/><inertia ixx=\"{:.9f}\" iyy=\"{:.9f}\" izz=\"{:.9f}\" ixy=\"0\" ixz=\"0\" "
      "iyz=\"0\"/></inertial>",
      origin(p, R), mass_kg, mass_kg / 12.0 * (s.y() + s.z()), mass_kg / 12.0 * (s.x() + s.z()),
      mass_kg / 12.0 * (s.x() + s.y()));
}

std::string box(const char* kind, const Eigen::Vector3d& size, const Eigen::Vector3d& p, const Eigen::Matrix3d& R) {
  return fmt::format("<{0}>{1}<geometry><box size=\"{2}\"/></geometry></{0}>", kind, origin(p, R), words(size));
}

}  // namespace

std::string UrdfQuadruped::text() const {
  const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
  const Eigen::Vector3d trunk(hip_spacing_m + 0.05, hip_width_m, 0.1 * hip_spacing_m + 0.06);
  std::string out = "<robot name=\"synthetic\">\n<link name=\"base_link\">";
  out += inertial((1.0 - leg_mass_ratio) * mass_kg, trunk, {0, 0, 0}, I) + box("visual", trunk, {0, 0, 0}, I) +
         box("collision", trunk, {0, 0, 0}, I) + "</link>\n";
  for (const auto& [name, z_m] : {std::pair("imu", 0.0), std::pair("lidar", 0.15)}) {
    out += fmt::format(
        "<link name=\"{0}\"/><joint name=\"{0}_joint\" type=\"fixed\"><parent link=\"base_link\"/><child "
        "link=\"{0}\"/><origin xyz=\"0 0 {1}\"/></joint>\n",
        name, z_m);
  }
  const double leg_kg = 0.25 * leg_mass_ratio * mass_kg;
  const std::array<int, 3> order = is_hip_first ? std::array{1, 0, 2} : std::array{0, 1, 2};
  for (int leg = 0; leg < 4; ++leg) {
    const std::string& name = legs[static_cast<std::size_t>(leg)];
    const double front = leg < 2 ? 1.0 : -1.0, left = leg % 2 == 0 ? 1.0 : -1.0;
    const std::array<Eigen::Vector3d, 3> place = {
        Eigen::Vector3d(front * 0.5 * hip_spacing_m, left * 0.5 * hip_width_m, 0.0),
        Eigen::Vector3d(0.0, left * abduction_offset_m, 0.0), Eigen::Vector3d(0.0, left * knee_offset_m, -thigh_m)};
    const std::array<double, 3> mass = {0.32 * leg_kg, 0.56 * leg_kg, 0.096 * leg_kg};
    const std::array<Eigen::Vector3d, 3> size = {Eigen::Vector3d(0.2, 0.2, 0.2) * thigh_m,
                                                 Eigen::Vector3d(0.15, 0.12, 0.8) * thigh_m,
                                                 Eigen::Vector3d(0.06, 0.06, 0.9) * shank_m};
    const std::array<Eigen::Vector3d, 3> center = {Eigen::Vector3d(0, 0.3 * left * abduction_offset_m, 0),
                                                   Eigen::Vector3d(0, 0, -0.2 * thigh_m),
                                                   Eigen::Vector3d(0, 0, -0.5 * shank_m)};
    std::string parent = "base_link";
    Eigen::Matrix3d R_plain_parent = I;
    for (int i = 0; i < 3; ++i) {
      const int part = order[static_cast<std::size_t>(i)];
      const auto at = static_cast<std::size_t>(part);
      const UrdfLegFrame& frame = frames[at];
      const Eigen::Matrix3d R = frame.R_plain_joint.toRotationMatrix();
      const Eigen::Vector3d axis = part == 0 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY();
      const Eigen::Matrix3d turned = Eigen::AngleAxisd(frame.zero_rad, axis).toRotationMatrix() * R;
      const double low = part == kKnee ? knee_lower_rad : part == kHip ? -1.5 : -0.9;
      const double high = part == kKnee ? knee_upper_rad : part == kHip ? 2.5 : 0.9;
      const double one = frame.sign * (low - frame.zero_rad), other = frame.sign * (high - frame.zero_rad);
      const std::string link = fmt::format("{}_{}", name, i);
      const Eigen::Matrix3d back = R.transpose();
      out += fmt::format(
          "<joint name=\"{0}_motor\" type=\"revolute\"><parent link=\"{1}\"/><child link=\"{0}\"/>{2}<axis "
          "xyz=\"{3}\"/><limit lower=\"{4:.9f}\" upper=\"{5:.9f}\" effort=\"{6}\" velocity=\"{7}\"/></joint>\n",
          link, parent,
          origin(R_plain_parent.transpose() * place[static_cast<std::size_t>(i)], R_plain_parent.transpose() * turned),
          words(frame.sign * (back * axis)), std::min(one, other), std::max(one, other),
          part == kKnee ? knee_effort_nm : effort_nm, speed_radps);
      out += fmt::format("<link name=\"{}\">", link);
      out += inertial(mass[at], size[at], back * center[at], back) + box("visual", size[at], back * center[at], back);
      const double collision_ratio = part == kKnee ? shank_collision_ratio : 0.9;
      if (part != 0) out += box("collision", collision_ratio * size[at], back * center[at], back);
      out += "</link>\n";
      parent = link;
      R_plain_parent = R;
    }
    out += fmt::format(
        "<link name=\"{0}_tip\">{3}<collision><geometry><sphere radius=\"{4}\"/></geometry></collision></link><joint "
        "name=\"{0}_tip_mount\" type=\"fixed\"><parent link=\"{1}\"/><child link=\"{0}_tip\"/>{2}</joint>\n",
        name, parent, origin(R_plain_parent.transpose() * Eigen::Vector3d(0, 0, -shank_m), I),
        inertial(0.024 * leg_kg, Eigen::Vector3d::Constant(2.0 * foot_radius_m), {0, 0, 0}, I), foot_radius_m);
  }
  return out + "</robot>\n";
}

Eigen::Vector3d UrdfQuadruped::plain_angles(const Eigen::Vector3d& joint_rad) const {
  const std::array<int, 3> order = is_hip_first ? std::array{1, 0, 2} : std::array{0, 1, 2};
  Eigen::Vector3d plain;
  for (int i = 0; i < 3; ++i) {
    const int part = order[static_cast<std::size_t>(i)];
    const UrdfLegFrame& frame = frames[static_cast<std::size_t>(part)];
    plain[part] = frame.sign * joint_rad[i] + frame.zero_rad;
  }
  return plain;
}

LegGeometry UrdfQuadruped::plain_leg(int leg) const {
  const double front = leg < 2 ? 1.0 : -1.0, left = leg % 2 == 0 ? 1.0 : -1.0;
  LegGeometry plain;
  plain.hip_in_body = {front * 0.5 * hip_spacing_m, left * 0.5 * hip_width_m, 0.0};
  plain.abduction_offset_m = left * (abduction_offset_m + knee_offset_m);
  plain.thigh_m = thigh_m;
  plain.shank_m = shank_m;
  plain.foot_radius_m = foot_radius_m;
  return plain;
}

}  // namespace patrol::test
