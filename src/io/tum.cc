#include "io/tum.h"

#include <cmath>
#include <fstream>
#include <sstream>

#include <fmt/format.h>

#include "core/error.h"
#include "io/settings_yaml.h"

namespace patrol::io {

Trajectory load_tum(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in) throw InputError(file.string() + ": cannot be read");
  Trajectory trajectory;
  int number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    if (line.empty() || line.front() == '#') continue;
    std::istringstream fields(line);
    double value[8];
    for (double& v : value) {
      if (!(fields >> v) || !std::isfinite(v)) throw input_error(file.string(), number, "must be eight finite numbers: t x y z qx qy qz qw");
    }
    StampedPose entry{from_seconds(value[0]),
                      {{value[1], value[2], value[3]}, Eigen::Quaterniond(value[7], value[4], value[5], value[6])}};
    if (std::abs(entry.pose.rotation.norm() - 1.0) > 1e-3) throw input_error(file.string(), number, "the quaternion is not of length 1");
    entry.pose.rotation.normalize();
    if (!trajectory.empty() && entry.stamp <= trajectory.back().stamp) throw input_error(file.string(), number, "stamps must grow from line to line");
    trajectory.push_back(entry);
  }
  if (trajectory.empty()) throw InputError(file.string() + ": holds no poses");
  return trajectory;
}

void save_tum(const std::filesystem::path& file, const Trajectory& trajectory, const std::string& comment) {
  std::string text = "# " + comment + "\n# t_s x_m y_m z_m qx qy qz qw\n";
  for (const StampedPose& entry : trajectory) {
    const auto& p = entry.pose.position;
    const auto& q = entry.pose.rotation;
    text += fmt::format("{:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f}\n", to_seconds(entry.stamp), p.x(), p.y(), p.z(),
                        q.x(), q.y(), q.z(), q.w());
  }
  save_text(file, text);
}

}  // namespace patrol::io
