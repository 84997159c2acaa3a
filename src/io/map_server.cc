#include "io/map_server.h"

#include <limits>
#include <sstream>
#include <vector>

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include "core/error.h"
#include "io/atomic_file.h"
#include "io/settings_yaml.h"

namespace patrol::io {
namespace {

constexpr double kOccupiedThreshold = 0.65, kFreeThreshold = 0.196;
constexpr unsigned char kOccupiedPixel = 0, kFreePixel = 254, kUnknownPixel = 205;

unsigned char pixel_of(std::int8_t occupancy) {
  if (occupancy < 0) return kUnknownPixel;
  return occupancy >= 100.0 * kOccupiedThreshold ? kOccupiedPixel : occupancy <= 100.0 * kFreeThreshold ? kFreePixel : kUnknownPixel;
}

/// An 8-bit grey image: [row from the top * width + column].
struct Image {
  int width = 0, height = 0;
  std::vector<unsigned char> pixels;
};

/// A PGM's next number; comments are skipped. -1 if there is none.
int pgm_number(std::istream& in) {
  while (in >> std::ws && in.peek() == '#') in.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
  int value = -1;
  return in >> value ? value : -1;
}

/// PGM, binary (P5) or in figures (P2).
Image load_pgm(const std::filesystem::path& file) {
  std::istringstream in(load_text(file));
  const std::size_t size = in.view().size();
  std::string magic;
  in >> magic;
  Image image{.width = pgm_number(in), .height = pgm_number(in), .pixels = {}};
  const int maximum = pgm_number(in);
  if ((magic != "P5" && magic != "P2") || image.width <= 0 || image.height <= 0 || maximum != 255) {
    throw InputError(file.string() + ": is not an 8-bit PGM");
  }
  // Each pixel takes at least a byte of the file: a wrong size must not fill the memory.
  const std::size_t count = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  if (count > size) throw InputError(file.string() + ": ends too early");
  image.pixels.resize(count);
  in.get();
  if (magic == "P5") in.read(reinterpret_cast<char*>(image.pixels.data()), static_cast<std::streamsize>(count));
  for (std::size_t i = 0; magic == "P2" && i < count; ++i) {
    const int value = pgm_number(in);
    if (value < 0) in.setstate(std::ios::failbit);
    if (value > maximum) throw InputError(fmt::format("{}: a pixel of {} is brighter than {}", file.string(), value, maximum));
    image.pixels[i] = static_cast<unsigned char>(value);
  }
  if (!in) throw InputError(file.string() + ": ends too early");
  return image;
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
  if (origin.size() > 2 && number("origin", origin[2]) != 0.0) throw InputError(file.string() + ": origin: a turned map (yaw other than 0) is not read");
  if (!document["image"].IsDefined()) throw InputError(file.string() + ": image: is missing");

  const Image image = load_pgm(file.parent_path() / document["image"].Scalar());
  geometry.width = image.width;
  geometry.height = image.height;
  const bool negate = document["negate"].IsDefined() && document["negate"].Scalar() == "1";
  const double occupied = document["occupied_thresh"].IsDefined() ? number("occupied_thresh", document["occupied_thresh"]) : kOccupiedThreshold;
  const double free = document["free_thresh"].IsDefined() ? number("free_thresh", document["free_thresh"]) : kFreeThreshold;
  OccupancyGrid map(geometry, kUnknown);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const double value = image.pixels[i];
    const double p = negate ? value / 255.0 : (255.0 - value) / 255.0;
    const int col = static_cast<int>(i) % image.width, row = image.height - 1 - static_cast<int>(i) / image.width;
    if (p > occupied) map.at({col, row}) = kOccupied;
    else if (p < free) map.at({col, row}) = kFree;
  }
  return map;
}

}  // namespace patrol::io
