#include "io/trajectories/tum.h"

#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "io/files/atomic_file.h"
#include "io/files/line_reader.h"
#include "io/files/line_tokenizer.h"

namespace patrol::io {
namespace {

constexpr double kUnitTolerance = 1e-3;  ///< tolerance of the norm of a quaternion: some files have only four digits

StampedPose parse_pose(LineTokenizer fields) {
  StampedPose entry{.stamp = fields.stamp("t"), .pose = {}};
  Eigen::Vector3d& p = entry.pose.position;
  for (int axis = 0; axis < 3; ++axis) p[axis] = fields.distance("position");
  const double x = fields.number("qx"), y = fields.number("qy"), z = fields.number("qz"), w = fields.number("qw");
  if (!fields.is_empty()) throw ParseError("more than eight words");
  entry.pose.rotation = Eigen::Quaterniond(w, x, y, z);
  return entry;
}

StampedPose read_pose(const std::string& file, const LineReader::Line& line) {
  try {
    if (line.is_cut) throw ParseError("is too long");
    return parse_pose(LineTokenizer(line.text));
  } catch (const ParseError& error) {
    throw input_error(file, line.number, fmt::format("{}: a pose is t x y z qx qy qz qw", error.what()));
  }
}

}  // namespace

Trajectory load_tum(const std::filesystem::path& file, SameStamps same_stamps, std::size_t* num_left_out) {
  LineReader lines(file);
  Trajectory trajectory;
  while (const auto line = lines.next()) {
    if (LineTokenizer(line->text).is_empty() || line->text.front() == '#') continue;
    StampedPose entry = read_pose(file.string(), *line);
    const double length = entry.pose.rotation.norm();
    if (std::abs(length - 1.0) > kUnitTolerance)
      throw input_error(file.string(), line->number,
                        fmt::format("the quaternion has length {:.4g}, must be 1", length));
    entry.pose.rotation.normalize();
    if (!trajectory.empty() && entry.stamp <= trajectory.back().stamp) {
      if (same_stamps == SameStamps::kKeepFirst && entry.stamp == trajectory.back().stamp) {
        if (num_left_out != nullptr) ++*num_left_out;
        continue;
      }
      throw input_error(file.string(), line->number,
                        fmt::format("stamp {} does not follow {}: stamps must increase", format_stamp(entry.stamp),
                                    format_stamp(trajectory.back().stamp)));
    }
    trajectory.push_back(entry);
  }
  if (lines.read_error()) throw InputError(fmt::format("{}: {}", file.string(), *lines.read_error()));
  if (trajectory.empty()) throw InputError(file.string() + ": contains no poses");
  return trajectory;
}

void save_tum(const std::filesystem::path& file, const Trajectory& trajectory, const std::string& comment) {
  std::string text = "# " + comment + "\n# t_s x_m y_m z_m qx qy qz qw\n";
  for (const auto& [stamp, pose] : trajectory) {
    const Eigen::Vector3d& p = pose.position;
    const Eigen::Quaterniond& q = pose.rotation;
    text += fmt::format("{} {:.9f} {:.9f} {:.9f} {:.12f} {:.12f} {:.12f} {:.12f}\n", format_stamp(stamp), p.x(), p.y(),
                        p.z(), q.x(), q.y(), q.z(), q.w());
  }
  save_text(file, text);
}

}  // namespace patrol::io
