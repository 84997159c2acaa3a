#include "io/points/las.h"

#include <array>
#include <cstdint>
#include <string_view>

#include <Eigen/Core>
#include <fmt/format.h>

#include "core/error.h"
#include "io/points/file_text.h"
#include "io/points/little_endian.h"
#include "io/points/point_collector.h"

namespace patrol::io {
namespace {

constexpr std::size_t kMinHeaderBytes = 227;      // versions 1.0 to 1.2
constexpr std::size_t kMinHeaderBytes14 = 375;    // version 1.4
constexpr int kFirstExtendedFormat = 6;           // formats with 16 bits of return and flags
constexpr std::uint8_t kCompressedFormat = 0x80;  // bit that LASzip sets
/// [format], bytes of a point without additional ones.
constexpr std::array<std::size_t, 11> kPointBytes = {20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};

struct LasHeader {
  std::size_t begin = 0;  ///< offset of the points in the file
  int format = 0;
  std::size_t point_bytes = 0, num_points = 0;
  Eigen::Array3d scale, offset;
};

LasHeader read_las_header(const FileText& text) {
  const std::string_view bytes = text.rest();
  const auto refuse = [&](const std::string& reason) { throw InputError(fmt::format("{}: {}", text.file(), reason)); };
  if (bytes.size() < kMinHeaderBytes || bytes.substr(0, 4) != "LASF") refuse("is not a LAS file");
  const int major = little_endian<std::uint8_t>(bytes, 24), minor = little_endian<std::uint8_t>(bytes, 25);
  if (major != 1 || minor > 4)
    refuse(fmt::format("LAS version {}.{} is not supported (known: 1.0 to 1.4)", major, minor));
  const auto format = little_endian<std::uint8_t>(bytes, 104);
  if ((format & kCompressedFormat) != 0)
    refuse("LAZ, which is compressed, is not supported: convert to LAS, for example with pdal translate");
  if (format >= kPointBytes.size()) refuse(fmt::format("point format {} is not supported (known: 0 to 10)", format));
  LasHeader header{.begin = little_endian<std::uint32_t>(bytes, 96),
                   .format = format,
                   .point_bytes = little_endian<std::uint16_t>(bytes, 105),
                   .num_points = little_endian<std::uint32_t>(bytes, 107),
                   .scale = {},
                   .offset = {}};
  if (minor == 4) {
    if (bytes.size() < kMinHeaderBytes14) refuse("the header is incomplete");
    header.num_points = little_endian<std::uint64_t>(bytes, 247);
  }
  for (int axis = 0; axis < 3; ++axis) {
    const std::size_t at = 8 * static_cast<std::size_t>(axis);
    header.scale[axis] = little_endian<double>(bytes, 131 + at);
    header.offset[axis] = little_endian<double>(bytes, 155 + at);
  }
  if (!header.offset.isFinite().all() || !(header.scale.isFinite() && header.scale > 0.0).all())
    refuse("scales must be positive and offsets finite");
  if (header.point_bytes < kPointBytes[format])
    refuse(fmt::format("points of {} bytes are too short for point format {}", header.point_bytes, format));
  if (header.begin > bytes.size() || header.num_points > (bytes.size() - header.begin) / header.point_bytes)
    refuse(fmt::format("ends too early for {} points of {} bytes", header.num_points, header.point_bytes));
  return header;
}

/// Returns whether a point is withheld or noise.
bool is_left_out(std::string_view point, int format) {
  constexpr int kLowNoise = 7, kHighNoise = 18, kWithheldOfFlags = 0x04, kWithheldOfClass = 0x80, kClassBits = 0x1F;
  const int flags = little_endian<std::uint8_t>(point, 15);
  const bool is_extended = format >= kFirstExtendedFormat;
  const int class_of_point = is_extended ? little_endian<std::uint8_t>(point, 16) : flags & kClassBits;
  const bool is_withheld = (flags & (is_extended ? kWithheldOfFlags : kWithheldOfClass)) != 0;
  return is_withheld || class_of_point == kLowNoise || class_of_point == kHighNoise;
}

}  // namespace

std::vector<ScannerPoint> load_shifted_las(const std::filesystem::path& file, PointShift& shift) {
  const FileText text(file);
  const LasHeader header = read_las_header(text);
  PointCollector points(&shift);
  points.reserve(header.num_points);
  for (std::size_t i = 0; i < header.num_points; ++i) {
    const std::string_view point = text.rest().substr(header.begin + i * header.point_bytes, header.point_bytes);
    if (is_left_out(point, header.format)) {
      ++shift.num_dropped;
      continue;
    }
    const Eigen::Array3d counts(little_endian<std::int32_t>(point, 0), little_endian<std::int32_t>(point, 4),
                                little_endian<std::int32_t>(point, 8));
    const Eigen::Array3d position = header.scale * counts + header.offset;
    const double intensity = little_endian<std::uint16_t>(point, 12);
    if (!points.add({position.x(), position.y(), position.z(), intensity}))
      throw InputError(fmt::format("{}: point {} is not finite", file.string(), i + 1));
  }
  return points.take();
}

}  // namespace patrol::io
