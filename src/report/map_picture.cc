#include "report/map_picture.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <png.h>

#include "core/error.h"
#include "core/map_cells.h"

namespace patrol::report {
namespace {

constexpr int kNumErrors = 40;  // number of error colors
constexpr std::uint8_t kNothing = 0, kFreePixel = 1, kTruthPixel = 2, kFirstError = 3;

/// Palette image, row 0 at the top.
struct PaletteImage {
  int width = 0, height = 0;
  std::vector<std::uint8_t> pixels;
};

std::string to_png(const PaletteImage& image) {
  std::array<Color, kFirstError + kNumErrors> palette;
  palette[kNothing] = {255, 255, 255};
  palette[kFreePixel] = kMapFree;
  palette[kTruthPixel] = kMapTruth;
  for (int i = 0; i < kNumErrors; ++i)
    palette[static_cast<std::size_t>(kFirstError + i)] = map_error_color(kMapErrorEnd_m * i / (kNumErrors - 1));

  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  header.format = PNG_FORMAT_RGB_COLORMAP;
  header.width = static_cast<png_uint_32>(image.width);
  header.height = static_cast<png_uint_32>(image.height);
  header.colormap_entries = palette.size();
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(header);
  std::string png(size, '\0');
  if (png_image_write_to_memory(&header, png.data(), &size, 0, image.pixels.data(), 0, palette.data()) == 0) {
    throw InputError(std::string("cannot encode the map picture: ") + header.message);
  }
  png.resize(size);
  return png;
}

/// Transformation from world to the pixels of a picture.
class Picture {
 public:
  /// `shown` is the minimum area, from its upper left corner. A cell is drawn `brush` pixels wide.
  Picture(const Eigen::AlignedBox2d& shown, double pixel_m, int brush)
      : left_m_(shown.min().x()),
        top_m_(shown.max().y()),
        pixel_m_(pixel_m),
        brush_(brush),
        image_{.width = static_cast<int>(std::ceil(shown.sizes().x() / pixel_m)),
               .height = static_cast<int>(std::ceil(shown.sizes().y() / pixel_m)),
               .pixels = {}} {
    image_.pixels.assign(static_cast<std::size_t>(image_.width) * static_cast<std::size_t>(image_.height), kNothing);
  }

  MapPicture::Sheet sheet() const {
    return {.png = to_png(image_), .size_m = pixel_m_ * Eigen::Vector2d(image_.width, image_.height)};
  }

  /// Sets every pixel to `value_at` of its center in world.
  template <typename ValueAt>
  void fill(const ValueAt& value_at) {
    for (int row = 0; row < image_.height; ++row) {
      for (int col = 0; col < image_.width; ++col) {
        image_.pixels[index(col, row)] =
            value_at(Eigen::Vector2d(left_m_ + pixel_m_ * (col + 0.5), top_m_ - pixel_m_ * (row + 0.5)));
      }
    }
  }

  /// Draws a value at `p_world` and in the area of the brush. The maximum of several values remains, so that the
  /// largest error is visible.
  void draw_max(const Eigen::Vector2d& p_world, std::uint8_t value) {
    const int left = static_cast<int>(std::floor((p_world.x() - left_m_) / pixel_m_));
    const int top = static_cast<int>(std::floor((top_m_ - p_world.y()) / pixel_m_));
    for (int row = std::max(top, 0); row < std::min(top + brush_, image_.height); ++row) {
      for (int col = std::max(left, 0); col < std::min(left + brush_, image_.width); ++col) {
        std::uint8_t& pixel = image_.pixels[index(col, row)];
        pixel = std::max(pixel, value);
      }
    }
  }

 private:
  std::size_t index(int col, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(image_.width) + static_cast<std::size_t>(col);
  }

  double left_m_, top_m_;
  double pixel_m_;
  int brush_;
  PaletteImage image_;
};

template <typename Value, typename Use>
void for_each_cell(const Grid<Value>& grid, const Use& use) {
  for (int row = 0; row < grid.geometry().height; ++row) {
    for (int col = 0; col < grid.geometry().width; ++col) use(Cell{col, row});
  }
}

bool is_occupied(const OccupancyGrid& map, Cell cell) { return patrol::is_occupied(map.at(cell)); }

/// Extends the area to the known cells of the built map and the true surfaces, in world.
void extend_to_map(Eigen::AlignedBox2d& shown, const MapLayers& layers) {
  for_each_cell(layers.built, [&](Cell cell) {
    if (layers.built.at(cell) != kUnknown) shown.extend(layers.T_world_map * layers.built.geometry().center_of(cell));
  });
  if (!layers.truth) return;
  for_each_cell(*layers.truth, [&](Cell cell) {
    if (is_occupied(*layers.truth, cell)) shown.extend(layers.truth->geometry().center_of(cell));
  });
}

std::uint8_t error_pixel(float error_m) {
  const double step = std::round((kNumErrors - 1) * std::min(1.0, error_m / kMapErrorEnd_m));
  return static_cast<std::uint8_t>(kFirstError + static_cast<int>(step));
}

std::uint8_t built_pixel(const MapLayers& layers, Cell cell) {
  if (is_occupied(layers.built, cell))
    return layers.error_m.values().empty() ? kFirstError : error_pixel(layers.error_m.at(cell));
  return layers.built.at(cell) == kUnknown ? kNothing : kFreePixel;
}

void paint(const MapLayers& layers, Picture& picture) {
  const Pose2 T_map_world = layers.T_world_map.inverse();
  const GridGeometry& geometry = layers.built.geometry();
  picture.fill([&](const Eigen::Vector2d& p_world) {
    const Cell cell = geometry.cell_at(T_map_world * p_world);
    return layers.built.contains(cell) ? built_pixel(layers, cell) : kNothing;
  });
  if (layers.truth) {
    for_each_cell(*layers.truth, [&](Cell cell) {
      if (is_occupied(*layers.truth, cell)) picture.draw_max(layers.truth->geometry().center_of(cell), kTruthPixel);
    });
  }
  // Draw the cells as well: pixel centers can miss a wall of one cell.
  for_each_cell(layers.built, [&](Cell cell) {
    if (is_occupied(layers.built, cell))
      picture.draw_max(layers.T_world_map * geometry.center_of(cell), built_pixel(layers, cell));
  });
}

}  // namespace

// Dark blue over violet to red: an accurate map resembles a line drawing. The lightness increases with the error.
Color map_error_color(double error_m) {
  struct Stop {
    double fraction, r, g, b;
  };
  static constexpr std::array<Stop, 4> kStops = {
      {{0.0, 22, 34, 48}, {0.35, 92, 52, 150}, {0.7, 210, 48, 104}, {1.0, 250, 96, 46}}};
  const double fraction = std::clamp(error_m / kMapErrorEnd_m, 0.0, 1.0);
  std::size_t upper = 1;
  while (upper + 1 < kStops.size() && fraction > kStops[upper].fraction) ++upper;
  const Stop &a = kStops[upper - 1], &b = kStops[upper];
  const double offset = (fraction - a.fraction) / (b.fraction - a.fraction);
  const auto mix = [&](double from, double to) {
    return static_cast<std::uint8_t>(std::lround(from + offset * (to - from)));
  };
  return {mix(a.r, b.r), mix(a.g, b.g), mix(a.b, b.b)};
}

MapPicture map_picture(const MapLayers& layers, Eigen::AlignedBox2d shown) {
  constexpr double kMargin_m = 1.0, kMaxPixels = 8e6;
  const Eigen::Array2d kPage_px(1150.0, 750.0);  // size of the figure on the page
  extend_to_map(shown, layers);
  if (shown.isEmpty()) shown.extend(Eigen::Vector2d::Zero().eval());
  shown.min().array() -= kMargin_m;
  shown.max().array() += kMargin_m;
  const double cell_m = layers.built.values().empty() ? 0.05 : layers.built.geometry().resolution_m;
  const double detail_m = std::max(cell_m, std::sqrt(shown.volume() / kMaxPixels));
  const double overview_m = std::max(detail_m, (shown.sizes().array() / kPage_px).maxCoeff());

  Picture overview(shown, overview_m, 2), detail(shown, detail_m, 1);
  paint(layers, overview);
  paint(layers, detail);
  return {.overview = overview.sheet(),
          .detail = detail.sheet(),
          .low_m = shown.min(),
          .high_m = shown.max(),
          .has_errors = !layers.error_m.values().empty()};
}

}  // namespace patrol::report
