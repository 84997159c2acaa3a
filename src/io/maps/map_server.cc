#include "io/maps/map_server.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include "core/error.h"
#include "core/letter_case.h"
#include "core/settings.h"
#include "io/files/atomic_file.h"
#include "io/maps/map_image.h"
#include "io/yaml/settings_yaml.h"

namespace patrol::io {
namespace {

constexpr double kOccupiedThreshold = 0.65, kFreeThreshold = 0.196;
constexpr double kYawRounding_rad = 1e-9;
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
    visit("mode", self.mode, one_of({"trinary", "scale", "raw"}));
    visit("resolution", self.resolution, between(0.001, 10.0));
    visit("origin", self.origin, between(-1e5, 1e5));
    visit("negate", self.negate, one_of({"0", "1", "false", "true"}));
    visit("occupied_thresh", self.occupied_thresh, between(0.0, 1.0));
    visit("free_thresh", self.free_thresh, between(0.0, 1.0));
  }
};

/// Reads the YAML file; `image` becomes a path relative to the working directory.
MapFile load_map_file(const std::filesystem::path& file) {
  YAML::Node document = load_document(file, {});
  const auto refuse = [&document = std::as_const(document), &file](const char* key, const std::string& what) {
    const YAML::Node node = document[key];
    throw input_error(file.string(), node.IsDefined() ? line_of(node) : 0, fmt::format("{}: {}", key, what));
  };
  for (const char* key : {"image", "resolution", "origin"}) {
    if (!std::as_const(document)[key].IsDefined()) refuse(key, "is missing");
  }
  if (YAML::Node mode = std::as_const(document)["mode"]; mode.IsDefined() && mode.IsScalar())
    mode = to_lower(mode.Scalar());
  MapFile map;
  SettingsReader::read_section(file.string(), document, "", map);
  if (map.origin.size() != 3) refuse("origin", "must be three numbers: x, y, yaw");
  if (std::abs(std::remainder(map.origin[2], 2.0 * std::numbers::pi)) > kYawRounding_rad)
    refuse("origin", "rotated maps (yaw other than 0) are not supported");
  if (map.free_thresh > map.occupied_thresh) refuse("free_thresh", "must not be above occupied_thresh");
  if (map.mode == "scale" && map.free_thresh == map.occupied_thresh)
    refuse("free_thresh", "must be below occupied_thresh in mode scale");
  const std::filesystem::path image = file.parent_path() / map.image;
  std::error_code ignored;  // error for an invalid name
  if (!std::filesystem::is_regular_file(image, ignored)) refuse("image", "file not found: " + image.string());
  map.image = image.string();
  return map;
}

/// Occupancy of the pixels of an image, as in nav2_map_server (map_io.cpp). Mode trinary averages alpha with the color
/// channels.
class PixelToCell {
 public:
  PixelToCell(const MapFile& about, const MapImage& image)
      : about_(about),
        image_(image),
        averages_alpha_(has_alpha_ && about.mode == "trinary"),
        maximum_(static_cast<double>((averages_alpha_ ? 4 : 3) * image.maximum)) {}

  std::int8_t operator()(std::size_t pixel) const {
    const double value = image_.brightness[pixel] + (averages_alpha_ ? image_.opacity[pixel] : 0U);
    if (is_raw_) {
      const double percent = std::round(255.0 * value / maximum_);
      return percent <= kOccupied ? static_cast<std::int8_t>(percent) : kUnknown;
    }
    const double p = (negates_ ? value : maximum_ - value) / maximum_;
    if (is_scale_ && has_alpha_ && image_.opacity[pixel] != image_.maximum) return kUnknown;
    if (p > about_.occupied_thresh) return kOccupied;
    if (p < about_.free_thresh) return kFree;
    if (!is_scale_) return kUnknown;
    const double ratio = (p - about_.free_thresh) / (about_.occupied_thresh - about_.free_thresh);
    return static_cast<std::int8_t>(std::rint(kOccupied * ratio));
  }

 private:
  const MapFile& about_;
  const MapImage& image_;
  bool has_alpha_ = !image_.opacity.empty();
  bool averages_alpha_;
  double maximum_;
  bool is_raw_ = about_.mode == "raw", is_scale_ = about_.mode == "scale";
  bool negates_ = about_.negate == "1" || about_.negate == "true";
};

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
  const MapImage image = load_map_image(about.image);
  const Eigen::Vector2d origin_m(about.origin[0], about.origin[1]);
  OccupancyGrid map(
      {.resolution_m = about.resolution, .width = image.width, .height = image.height, .origin_m = origin_m}, kUnknown);
  const PixelToCell cell_of(about, image);
  std::size_t pixel = 0;
  for (int row = image.height - 1; row >= 0; --row) {
    for (int col = 0; col < image.width; ++col) map.at({col, row}) = cell_of(pixel++);
  }
  return map;
}

void save_map_errors(const std::filesystem::path& file_pgm, const Grid<float>& errors_m) {
  save_text(file_pgm, to_pgm(errors_m, error_pixel));
}

Grid<float> load_map_errors(const std::filesystem::path& file_pgm, const GridGeometry& geometry) {
  const MapImage image = load_map_image(file_pgm);
  if (image.width != geometry.width || image.height != geometry.height) {
    throw InputError(fmt::format("{}: is {} x {} pixels, its map {} x {}", file_pgm.string(), image.width, image.height,
                                 geometry.width, geometry.height));
  }
  constexpr std::uint32_t kMaxPixel = 255;
  Grid<float> errors_m(geometry, std::numeric_limits<float>::quiet_NaN());
  for (int row = 0; row < image.height; ++row) {
    for (int col = 0; col < image.width; ++col) {
      const std::uint32_t pixel =
          kMaxPixel *
          image.brightness[static_cast<std::size_t>(image.height - 1 - row) * static_cast<std::size_t>(image.width) +
                           static_cast<std::size_t>(col)] /
          (3 * image.maximum);
      if (pixel != kNoError) errors_m.at({col, row}) = 1e-3F * static_cast<float>(pixel);
    }
  }
  return errors_m;
}

}  // namespace patrol::io
