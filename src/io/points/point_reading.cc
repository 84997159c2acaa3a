#include "io/points/point_reading.h"

#include <algorithm>
#include <array>
#include <limits>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.h"
#include "core/letter_case.h"
#include "io/points/las.h"
#include "io/points/pcd.h"
#include "io/points/ply.h"
#include "io/points/point_collector.h"
#include "io/points/xyz.h"

namespace patrol::io {
namespace {

constexpr std::array<std::string_view, 5> kTextExtensions = {".xyz", ".pts", ".asc", ".csv", ".txt"};

}  // namespace

RelativePoints load_points(const std::filesystem::path& file, const std::optional<Eigen::Vector3d>& origin,
                           double unit_m) {
  PointShift shift{.origin = origin, .num_dropped = 0, .unit_m = unit_m};
  RelativePoints relative;
  const std::string extension = to_lower(file.extension().string());
  if (extension == ".ply") {
    relative.points = load_shifted_ply(file, shift);
  } else if (extension == ".pcd") {
    relative.points = load_shifted_pcd(file, shift);
  } else if (extension == ".las" || extension == ".laz") {
    relative.points = load_shifted_las(file, shift);
  } else if (std::ranges::find(kTextExtensions, extension) != kTextExtensions.end()) {
    relative.points = load_shifted_xyz(file, shift, relative.columns);
  } else {
    throw InputError(fmt::format("{}: extension of a point cloud must be .ply, .pcd, .las, {}", file.string(),
                                 fmt::join(kTextExtensions, ", ")));
  }
  relative.origin = shift.origin.value_or(Eigen::Vector3d::Zero());
  relative.num_dropped = shift.num_dropped;
  if (shift.is_single_precision)
    relative.step = static_cast<double>(std::numeric_limits<float>::epsilon()) * relative.origin.cwiseAbs().maxCoeff();
  return relative;
}

}  // namespace patrol::io
