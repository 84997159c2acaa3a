#include "io/maps/map_server.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <vector>

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include "core/error.h"
#include "core/settings.h"
#include "io/files/atomic_file.h"
#include "io/yaml/settings_yaml.h"

namespace patrol::io {
namespace {

constexpr double kOccupiedThreshold = 0.65, kFreeThreshold = 0.196;
constexpr int kMaxPixelValue = 255;
constexpr std::size_t kMaxPixels = 100'000'000;
constexpr unsigned char kOccupiedPixel = 0, kFreePixel = 254, kUnknownPixel = 205;
constexpr unsigned char kMaxError = 254, kNoError = 255;  // mm

unsigned char pixel_of(std::int8_t occupancy) {
  if (occupancy < 0) return kUnknownPixel;
  return occupancy >= 100.0 * kOccupiedThreshold ? kOccupiedPixel
         : occupancy <= 100.0 * kFreeThreshold   ? kFreePixel
                                                 : kUnknownPixel;
}

unsigned char error_pixel(float error_m) {
  if (std::isnan(error_m)) return kNoError;
  return static_cast<unsigned char>(std::min<double>(kMaxError, std::round(1e3 * error_m)));
}

/// Formats a grid as a binary PGM; the rows of the image start at the top.
template <typename Value, typename PixelOf>
std::string to_pgm(const Grid<Value>& grid, const PixelOf& pixel_of_value) {
  const GridGeometry& geometry = grid.geometry();
  std::string image = fmt::format("P5\n{} {}\n255\n", geometry.width, geometry.height);
  for (int row = geometry.height - 1; row >= 0; --row) {
    for (int col = 0; col < geometry.width; ++col) image += static_cast<char>(pixel_of_value(grid.at({col, row})));
  }
  return image;
}

/// Gray image, 8 bits per pixel: [row from the top * width + column].
struct Image {
  int width = 0, height = 0;
  std::vector<unsigned char> pixels;
};

/// Reads the next number of a PGM and skips comments; -1 if there is none.
int pgm_number(std::istream& in) {
  while (in >> std::ws && in.peek() == '#') in.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
  int value = -1;
  return in >> value ? value : -1;
}

/// Reads a PGM image, binary (P5) or ASCII (P2).
Image load_pgm(const std::filesystem::path& file) {
  std::istringstream in(load_text(file));
  const auto refuse = [&](const std::string& what) { throw InputError(file.string() + ": " + what); };
  const std::size_t size = in.view().size();
  std::string magic;
  in >> magic;
  Image image{.width = pgm_number(in), .height = pgm_number(in), .pixels = {}};
  const int maximum = pgm_number(in);
  if ((magic != "P5" && magic != "P2") || maximum != kMaxPixelValue) refuse("is not an 8-bit PGM");
  if (image.width <= 0 || image.height <= 0)
    refuse(fmt::format("is {} x {} pixels: contains no map", image.width, image.height));
  // Each pixel takes at least one byte of the file: check the size before memory is allocated.
  const std::size_t count = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  const std::string pixels = fmt::format("{} x {} pixels", image.width, image.height);
  if (count > size) refuse("ends too early for " + pixels);
  if (count > kMaxPixels) refuse(fmt::format("has {}: at most {} are allowed", pixels, kMaxPixels));
  image.pixels.resize(count);
  in.get();
  if (magic == "P5") in.read(reinterpret_cast<char*>(image.pixels.data()), static_cast<std::streamsize>(count));
  for (std::size_t i = 0; magic == "P2" && i < count; ++i) {
    const int value = pgm_number(in);
    if (value < 0) in.setstate(std::ios::failbit);
    if (value > maximum) refuse(fmt::format("a pixel of {} is brighter than {}", value, maximum));
    image.pixels[i] = static_cast<unsigned char>(value);
  }
  if (!in) refuse("ends too early for " + pixels);
  if (magic == "P2") in >> std::ws;
  if (in.peek() != std::istringstream::traits_type::eof()) refuse("has data after its " + pixels);
  return image;
}

/// Content of the YAML file of a map, with defaults for missing keys.
struct MapFile {
  std::string image;
  std::string mode = "trinary";
  double resolution = 0.0;     ///< m
  std::vector<double> origin;  ///< x, y, yaw of the lower-left corner
  std::string negate = "0";
  double occupied_thresh = kOccupiedThreshold;
  double free_thresh = kFreeThreshold;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("image", self.image);
    visit("mode", self.mode, one_of({"trinary"}));
    visit("resolution", self.resolution, between(0.001, 10.0));
    visit("origin", self.origin, between(-1e5, 1e5));
    visit("negate", self.negate, one_of({"0", "1", "false", "true"}));
    visit("occupied_thresh", self.occupied_thresh, between(0.0, 1.0));
    visit("free_thresh", self.free_thresh, between(0.0, 1.0));
  }
};

/// Reads the YAML file; `image` becomes a path relative to the working directory.
MapFile load_map_file(const std::filesystem::path& file) {
  const YAML::Node document = load_document(file, {});
  const auto refuse = [&](const char* key, const std::string& what) {
    const YAML::Node node = document[key];
    throw input_error(file.string(), node.IsDefined() ? line_of(node) : 0, fmt::format("{}: {}", key, what));
  };
  for (const char* key : {"image", "resolution", "origin"}) {
    if (!document[key].IsDefined()) refuse(key, "is missing");
  }
  MapFile map;
  SettingsReader::read_section(file.string(), document, "", map);
  if (map.origin.size() != 3) refuse("origin", "must be three numbers: x, y, yaw");
  if (map.origin[2] != 0.0) refuse("origin", "rotated maps (yaw other than 0) are not supported");
  if (map.free_thresh > map.occupied_thresh) refuse("free_thresh", "must not be above occupied_thresh");
  const std::filesystem::path image = file.parent_path() / map.image;
  std::error_code ignored;  // error for an invalid name
  if (!std::filesystem::is_regular_file(image, ignored)) refuse("image", "file not found: " + image.string());
  map.image = image.string();
  return map;
}

}  // namespace

void save_map(const std::filesystem::path& file, const OccupancyGrid& map) {
  const GridGeometry& geometry = map.geometry();
  const std::filesystem::path image_file = std::filesystem::path(file).replace_extension(".pgm");
  save_text(image_file, to_pgm(map, pixel_of));
  save_text(file, fmt::format("image: {}\nmode: trinary\nresolution: {}\norigin: [{}, {}, 0.0]\nnegate: 0\n"
                              "occupied_thresh: {}\nfree_thresh: {}\n",
                              image_file.filename().string(), geometry.resolution_m, geometry.origin_m.x(),
                              geometry.origin_m.y(), kOccupiedThreshold, kFreeThreshold));
}

std::filesystem::path map_image(const std::filesystem::path& file) { return load_map_file(file).image; }

OccupancyGrid load_map(const std::filesystem::path& file) {
  const MapFile about = load_map_file(file);
  const Image image = load_pgm(about.image);
  const bool negate = about.negate == "1" || about.negate == "true";
  const Eigen::Vector2d origin_m(about.origin[0], about.origin[1]);
  OccupancyGrid map(
      {.resolution_m = about.resolution, .width = image.width, .height = image.height, .origin_m = origin_m}, kUnknown);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const double value = image.pixels[i];
    const double p = (negate ? value : kMaxPixelValue - value) / kMaxPixelValue;
    const int col = static_cast<int>(i) % image.width, row = image.height - 1 - static_cast<int>(i) / image.width;
    if (p > about.occupied_thresh) map.at({col, row}) = kOccupied;
    else if (p < about.free_thresh) map.at({col, row}) = kFree;
  }
  return map;
}

void save_map_errors(const std::filesystem::path& file_pgm, const Grid<float>& errors_m) {
  save_text(file_pgm, to_pgm(errors_m, error_pixel));
}

Grid<float> load_map_errors(const std::filesystem::path& file_pgm, const GridGeometry& geometry) {
  const Image image = load_pgm(file_pgm);
  if (image.width != geometry.width || image.height != geometry.height) {
    throw InputError(fmt::format("{}: is {} x {} pixels, its map {} x {}", file_pgm.string(), image.width, image.height,
                                 geometry.width, geometry.height));
  }
  Grid<float> errors_m(geometry, std::numeric_limits<float>::quiet_NaN());
  for (int row = 0; row < image.height; ++row) {
    for (int col = 0; col < image.width; ++col) {
      const unsigned char pixel =
          image.pixels[static_cast<std::size_t>(image.height - 1 - row) * static_cast<std::size_t>(image.width) +
                       static_cast<std::size_t>(col)];
      if (pixel != kNoError) errors_m.at({col, row}) = 1e-3F * static_cast<float>(pixel);
    }
  }
  return errors_m;
}

}  // namespace patrol::io
