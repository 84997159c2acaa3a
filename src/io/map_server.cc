#include "io/map_server.h"

#include <fstream>

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include "core/error.h"
#include "io/settings_yaml.h"

namespace patrol::io {
namespace {

constexpr double kOccupiedThreshold = 0.65, kFreeThreshold = 0.196;
constexpr unsigned char kOccupiedPixel = 0, kFreePixel = 254, kUnknownPixel = 205;

unsigned char pixel_of(std::int8_t occupancy) {
  if (occupancy < 0) return kUnknownPixel;
  return occupancy >= 100.0 * kOccupiedThreshold ? kOccupiedPixel : occupancy <= 100.0 * kFreeThreshold ? kFreePixel : kUnknownPixel;
}

/// A binary PGM's next number; comments are skipped.
int pgm_number(std::istream& in) {
  while (in >> std::ws && in.peek() == '#') in.ignore(1 << 16, '\n');
  int value = -1;
  in >> value;
  return value;
}

}  // namespace

void save_map(const std::filesystem::path& file, const OccupancyGrid& map) {
  const GridGeometry& geometry = map.geometry();
  std::string image = fmt::format("P5\n{} {}\n255\n", geometry.width, geometry.height);
  for (int row = geometry.height - 1; row >= 0; --row) {
    for (int col = 0; col < geometry.width; ++col) image += static_cast<char>(pixel_of(map.at({col, row})));
  }
  const std::filesystem::path image_file = std::filesystem::path(file).replace_extension(".pgm");
  save_text(image_file, image);
  save_text(file, fmt::format("image: {}\nmode: trinary\nresolution: {}\norigin: [{}, {}, 0.0]\nnegate: 0\n"
                              "occupied_thresh: {}\nfree_thresh: {}\n",
                              image_file.filename().string(), geometry.resolution_m, geometry.origin_m.x(), geometry.origin_m.y(),
                              kOccupiedThreshold, kFreeThreshold));
}

OccupancyGrid load_map(const std::filesystem::path& file) {
  const YAML::Node document = load_document(file, {});
  const auto number = [&](const char* key, const YAML::Node& node) {
    double value = 0.0;
    if (!node.IsDefined() || !node.IsScalar() || !YAML::convert<double>::decode(node, value) || !std::isfinite(value)) {
      throw InputError(fmt::format("{}: {}: must be a number", file.string(), key));
    }
    return value;
  };
  GridGeometry geometry;
  geometry.resolution_m = number("resolution", document["resolution"]);
  if (geometry.resolution_m <= 0.0) throw InputError(file.string() + ": resolution: must be positive");
  const YAML::Node origin = document["origin"];
  if (!origin.IsDefined() || !origin.IsSequence() || origin.size() < 2) throw InputError(file.string() + ": origin: must be a list x, y, yaw");
  geometry.origin_m = {number("origin", origin[0]), number("origin", origin[1])};
  if (!document["image"].IsDefined()) throw InputError(file.string() + ": image: is missing");

  const std::filesystem::path image_file = file.parent_path() / document["image"].Scalar();
  std::ifstream in(image_file, std::ios::binary);
  std::string magic;
  in >> magic;
  geometry.width = pgm_number(in);
  geometry.height = pgm_number(in);
  const int maximum = pgm_number(in);
  if (!in || magic != "P5" || geometry.width <= 0 || geometry.height <= 0 || maximum != 255) {
    throw InputError(image_file.string() + ": is not a binary 8-bit PGM");
  }
  in.get();
  const bool negate = document["negate"].IsDefined() && document["negate"].Scalar() == "1";
  const double occupied = document["occupied_thresh"].IsDefined() ? number("occupied_thresh", document["occupied_thresh"]) : kOccupiedThreshold;
  const double free = document["free_thresh"].IsDefined() ? number("free_thresh", document["free_thresh"]) : kFreeThreshold;
  OccupancyGrid map(geometry, kUnknown);
  std::string row_bytes(static_cast<std::size_t>(geometry.width), '\0');
  for (int row = geometry.height - 1; row >= 0; --row) {
    if (!in.read(row_bytes.data(), geometry.width)) throw InputError(image_file.string() + ": ends too early");
    for (int col = 0; col < geometry.width; ++col) {
      const double value = static_cast<unsigned char>(row_bytes[static_cast<std::size_t>(col)]);
      const double p = negate ? value / 255.0 : (255.0 - value) / 255.0;
      if (p > occupied) map.at({col, row}) = kOccupied;
      else if (p < free) map.at({col, row}) = kFree;
    }
  }
  return map;
}

}  // namespace patrol::io
