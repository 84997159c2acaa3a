#include "io/tum.h"

#include <array>
#include <cmath>
#include <sstream>

#include <fmt/format.h>

#include "core/error.h"
#include "io/atomic_file.h"

namespace patrol::io {
namespace {

constexpr double kUnitTol = 1e-3;  ///< of a quaternion's length: files carry as few as four digits

/// The line's eight numbers, or what is wrong with them.
std::array<double, 8> parse_line(const std::string& file, int number, const std::string& line) {
  const char* const rule = "must be eight finite numbers: t x y z qx qy qz qw";
  std::istringstream words(line);
  std::array<double, 8> values{};
  for (double& value : values) {
    if (!(words >> value) || !std::isfinite(value)) throw input_error(file, number, rule);
  }
  if (!(words >> std::ws).eof()) throw input_error(file, number, rule);
  return values;
}

}  // namespace

Trajectory load_tum(const std::filesystem::path& file) {
  std::istringstream lines(load_text(file));
  Trajectory trajectory;
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (line.find_first_not_of(" \t\r") == std::string::npos || line.front() == '#') continue;
    const auto [t, x, y, z, qx, qy, qz, qw] = parse_line(file.string(), number, line);
    const Eigen::Quaterniond rotation(qw, qx, qy, qz);
    if (std::abs(rotation.norm() - 1.0) > kUnitTol) {
      throw input_error(file.string(), number, fmt::format("the quaternion has length {:.4g}, must be 1", rotation.norm()));
    }
    const Time stamp = from_seconds(t);
    if (!trajectory.empty() && stamp <= trajectory.back().stamp) {
      throw input_error(file.string(), number, fmt::format("stamp {:.9f} does not follow {:.9f}: stamps must grow from line to line",
                                                           t, to_seconds(trajectory.back().stamp)));
    }
    trajectory.push_back({stamp, {{x, y, z}, rotation.normalized()}});
  }
  if (trajectory.empty()) throw InputError(file.string() + ": holds no poses");
  return trajectory;
}

void save_tum(const std::filesystem::path& file, const Trajectory& trajectory, const std::string& comment) {
  std::string text = "# " + comment + "\n# t_s x_m y_m z_m qx qy qz qw\n";
  for (const auto& [stamp, pose] : trajectory) {
    const Eigen::Vector3d& p = pose.position;
    const Eigen::Quaterniond& q = pose.rotation;
    text += fmt::format("{}.{:09} {:.9f} {:.9f} {:.9f} {:.12f} {:.12f} {:.12f} {:.12f}\n", stamp.count() / 1'000'000'000,
                        stamp.count() % 1'000'000'000, p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w());
  }
  save_text(file, text);
}

}  // namespace patrol::io
