#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <fmt/format.h>

namespace patrol::importer {

/// Elements of synthetic robot descriptions for the tests.
inline std::string inertial(double mass_kg, const std::string& origin = "0 0 0", double moment = 0.01) {
  return fmt::format(
      R"(<inertial><origin xyz="{}"/><mass value="{}"/><inertia ixx="{}" ixy="0" ixz="0" iyy="{}" iyz="0" izz="{}"/></inertial>)",
      origin, mass_kg, moment, moment, moment);
}

inline std::string link(const std::string& name, const std::string& content = "") {
  return fmt::format("<link name=\"{}\">{}</link>\n", name, content);
}

inline std::string shape(const std::string& tag, const std::string& geometry, const std::string& xyz = "0 0 0",
                         const std::string& rpy = "0 0 0") {
  return fmt::format(R"(<{0}><origin xyz="{2}" rpy="{3}"/><geometry>{1}</geometry></{0}>)", tag, geometry, xyz, rpy);
}

inline std::string box(double x, double y, double z) { return fmt::format(R"(<box size="{} {} {}"/>)", x, y, z); }

inline std::string cylinder(double radius_m, double length_m) {
  return fmt::format(R"(<cylinder radius="{}" length="{}"/>)", radius_m, length_m);
}

inline std::string sphere(double radius_m) { return fmt::format(R"(<sphere radius="{}"/>)", radius_m); }

inline std::string joint(const std::string& name, const std::string& type, const std::string& parent,
                         const std::string& child, const std::string& xyz, const std::string& content = "",
                         const std::string& rpy = "0 0 0") {
  return fmt::format(
      R"(<joint name="{}" type="{}"><parent link="{}"/><child link="{}"/><origin xyz="{}" rpy="{}"/>{}</joint>)"
      "\n",
      name, type, parent, child, xyz, rpy, content);
}

inline std::string axis(const std::string& xyz) { return fmt::format(R"(<axis xyz="{}"/>)", xyz); }

const std::string kMotor = R"(<limit effort="10" velocity="12"/>)";
const std::string kAcross = "1.5707963267948966 0 0";

/// A wheel of 1 kg about y with its motor.
inline std::string wheel(const std::string& name, const std::string& parent, const std::string& xyz, double radius_m,
                         double width_m, const std::string& limit = kMotor, const std::string& direction = "0 1 0") {
  return joint(name + "_joint", "continuous", parent, name, xyz, axis(direction) + limit) +
         link(name, inertial(1.0) + shape("collision", cylinder(radius_m, width_m), "0 0 0", kAcross));
}

inline std::string robot(const std::string& content) {
  return "<?xml version=\"1.0\"?>\n<robot name=\"vendor\">\n" + content + "</robot>\n";
}

/// Chassis of 20 kg: 0.6 x 0.4 x 0.2 m.
inline std::string chassis(const std::string& name = "base_link", const std::string& content = "") {
  return link(name, inertial(20.0, "0 0 0", 0.5) + shape("collision", box(0.6, 0.4, 0.2)) + content);
}

/// Two driven wheels of 0.1 m radius on a chassis, 0.5 m apart; the ground is at z = -0.15 in base_link.
inline std::string two_wheels(const std::string& base = "base_link") {
  return wheel("left", base, "0 0.25 -0.05", 0.1, 0.04) + wheel("right", base, "0 -0.25 -0.05", 0.1, 0.04);
}

/// Caster of 0.05 m radius behind.
inline std::string caster(const std::string& base = "base_link") {
  return joint("swivel", "continuous", base, "fork", "-0.25 0 -0.08", axis("0 0 1")) + link("fork", inertial(0.3)) +
         joint("roll", "continuous", "fork", "small", "-0.03 0 -0.02", axis("0 1 0")) +
         link("small", inertial(0.2, "0 0 0", 0.001) + shape("collision", cylinder(0.05, 0.03), "0 0 0", kAcross));
}

/// A fixed part at the front of the chassis.
inline std::string part(const std::string& name, const std::string& content) {
  return joint(name + "_joint", "fixed", "base_link", name, "0.1 0 0.1") + link(name, content);
}

/// A robot with two driven wheels and a caster, and more.
inline std::string with(const std::string& more) { return robot(chassis() + two_wheels() + caster() + more); }

/// COLLADA text of an orange triangle from the origin to (2, 0, 0) and (0, 0, 4), in a node at (0, 10, 0).
inline std::string dae(const std::string& unit, const std::string& up_axis) {
  return R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset>
<unit meter=")" +
         unit + R"("/><up_axis>)" + up_axis + R"(</up_axis></asset>
<library_effects><effect id="e"><profile_COMMON><technique sid="t"><lambert><diffuse><color>1 0.5 0 1</color></diffuse></lambert>
</technique></profile_COMMON></effect></library_effects><library_materials><material id="m"><instance_effect url="#e"/></material></library_materials>
<library_geometries><geometry id="g"><mesh><source id="p"><float_array id="pa" count="9">0 0 0 2 0 0 0 0 4</float_array>
<technique_common><accessor source="#pa" count="3" stride="3"><param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices><triangles count="1" material="s"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n"><translate>0 10 0</translate><instance_geometry url="#g"><bind_material><technique_common>
<instance_material symbol="s" target="#m"/></technique_common></bind_material></instance_geometry></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
}

using Triangle = std::array<Eigen::Vector3d, 3>;

/// Binary STL of triangles.
inline std::string stl(const std::vector<Triangle>& triangles) {
  std::string bytes(80, ' ');
  const auto add = [&bytes](const auto& value) {
    char raw[sizeof(value)];
    std::memcpy(raw, &value, sizeof(value));
    bytes.append(raw, sizeof(value));
  };
  add(static_cast<std::uint32_t>(triangles.size()));
  for (const Triangle& t : triangles) {
    const Eigen::Vector3d normal = (t[1] - t[0]).cross(t[2] - t[0]).normalized();
    for (const Eigen::Vector3d& v : {normal, t[0], t[1], t[2]}) {
      for (int k = 0; k < 3; ++k) add(static_cast<float>(v[k]));
    }
    add(std::uint16_t{0});
  }
  return bytes;
}

inline std::vector<Triangle> box_triangles(const Eigen::Vector3d& size, const Eigen::Vector3d& center = {0, 0, 0}) {
  std::vector<Triangle> triangles;
  for (int a = 0; a < 3; ++a) {
    for (const double side : {-0.5, 0.5}) {
      const int b = (a + 1) % 3, c = (a + 2) % 3;
      const auto corner = [&](double u, double v) {
        Eigen::Vector3d p;
        p[a] = side, p[b] = u, p[c] = v;
        return Eigen::Vector3d(center + p.cwiseProduct(size));
      };
      const Eigen::Vector3d p00 = corner(-.5, -.5), p10 = corner(.5, -.5), p11 = corner(.5, .5), p01 = corner(-.5, .5);
      if (side > 0) triangles.insert(triangles.end(), {{p00, p10, p11}, {p00, p11, p01}});
      else triangles.insert(triangles.end(), {{p00, p11, p10}, {p00, p01, p11}});
    }
  }
  return triangles;
}

/// Cylinder about y of `num` sides.
inline std::vector<Triangle> wheel_triangles(double radius, double width, int num = 64) {
  std::vector<Triangle> triangles;
  for (int i = 0; i < num; ++i) {
    const double a = 2.0 * M_PI * i / num, b = 2.0 * M_PI * (i + 1) / num;
    const auto at = [&](double angle, double y) {
      return Eigen::Vector3d(radius * std::sin(angle), y, radius * std::cos(angle));
    };
    const double h = 0.5 * width;
    triangles.push_back({at(a, -h), at(b, -h), at(b, h)});
    triangles.push_back({at(a, -h), at(b, h), at(a, h)});
    triangles.push_back({at(a, h), at(b, h), Eigen::Vector3d(0, h, 0)});
    triangles.push_back({at(b, -h), at(a, -h), Eigen::Vector3d(0, -h, 0)});
  }
  return triangles;
}

}  // namespace patrol::importer
