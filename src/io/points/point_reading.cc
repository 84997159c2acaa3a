#include "io/points/point_reading.h"

#include <limits>

#include <fmt/format.h>

#include "core/error.h"
#include "core/letter_case.h"
#include "io/points/pcd.h"
#include "io/points/ply.h"
#include "io/points/point_table.h"

namespace patrol::io {

RelativePoints load_points(const std::filesystem::path& file, const std::optional<Eigen::Vector3d>& origin,
                           double unit_m) {
  PointShift shift{.origin = origin, .num_dropped = 0, .unit_m = unit_m};
  RelativePoints relative;
  const std::string extension = to_lower(file.extension().string());
  if (extension == ".ply") {
    relative.points = load_shifted_ply(file, shift);
  } else if (extension == ".pcd") {
    relative.points = load_shifted_pcd(file, shift);
  } else {
    throw InputError(fmt::format("{}: extension of a point cloud must be .ply or .pcd", file.string()));
  }
  relative.origin = shift.origin.value_or(Eigen::Vector3d::Zero());
  relative.num_dropped = shift.num_dropped;
  if (shift.is_single_precision)
    relative.step = static_cast<double>(std::numeric_limits<float>::epsilon()) * relative.origin.cwiseAbs().maxCoeff();
  return relative;
}

}  // namespace patrol::io
