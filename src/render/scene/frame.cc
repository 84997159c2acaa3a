#include "render/scene/frame.h"

#include <stdexcept>
#include <string>

#include <png.h>

#include "core/error.h"
#include "io/files/atomic_file.h"

namespace patrol::render {
namespace {

png_image rgb_image() {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.format = PNG_FORMAT_RGB;
  return image;
}

}  // namespace

std::string to_png(const Frame& frame) {
  png_image image = rgb_image();
  image.width = static_cast<png_uint_32>(frame.width());
  image.height = static_cast<png_uint_32>(frame.height());
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::string png(size, '\0');
  if (png_image_write_to_memory(&image, png.data(), &size, 0, frame.bytes(), 0, nullptr) == 0)
    throw std::runtime_error(std::string("cannot encode a PNG: ") + image.message);
  png.resize(size);
  return png;
}

void save_png(const std::filesystem::path& file, const Frame& frame) { io::save_text(file, to_png(frame)); }

Frame load_png(const std::filesystem::path& file) {
  const std::string png = io::load_text(file);
  png_image image = rgb_image();
  if (png_image_begin_read_from_memory(&image, png.data(), png.size()) == 0) {
    throw InputError(file.string() + ": cannot read as a PNG: " + image.message);
  }
  image.format = PNG_FORMAT_RGB;
  Frame frame(static_cast<int>(image.width), static_cast<int>(image.height));
  if (png_image_finish_read(&image, nullptr, frame.bytes(), 0, nullptr) == 0) {
    throw InputError(file.string() + ": cannot read as a PNG: " + image.message);
  }
  return frame;
}

}  // namespace patrol::render
