#include "io/maps/map_image.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <csetjmp>
#include <cstring>
#include <limits>
#include <new>
#include <sstream>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <png.h>

#include "core/error.h"
#include "io/files/atomic_file.h"
#include "io/files/one_line.h"

namespace patrol::io {
namespace {

constexpr int kMaxByte = 255, kMaxPgmValue = 65535;
constexpr std::size_t kMaxPixels = 100'000'000;
constexpr std::string_view kPngSignature = "\x89PNG";

[[noreturn]] void refuse_image(const std::filesystem::path& file, const std::string& what) {
  throw InputError(file.string() + ": " + what);
}

/// Returns the number of pixels. `min_bytes`: least size of a file with an image of this size, checked before memory is
/// allocated.
std::size_t checked_count(const std::filesystem::path& file, const MapImage& image, std::size_t min_bytes,
                          std::size_t num_bytes) {
  const std::size_t count = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  const std::string pixels = fmt::format("{} x {} pixels", image.width, image.height);
  if (min_bytes > num_bytes) refuse_image(file, "ends too early for " + pixels);
  if (count > kMaxPixels) refuse_image(file, fmt::format("has {}: at most {} are allowed", pixels, kMaxPixels));
  return count;
}

/// Reader of a PGM image, binary (P5) or ASCII (P2), with one or two bytes per pixel.
class PgmDecoder {
 public:
  PgmDecoder(const std::filesystem::path& file, std::string bytes) : file_(file), in_(std::move(bytes)) {}

  MapImage decode() {
    std::string magic;
    in_ >> magic;
    if (magic != "P5" && magic != "P2") refuse_image(file_, "is neither a PGM (P5 or P2) nor a PNG");
    MapImage image{.width = number(), .height = number(), .brightness = {}, .opacity = {}};
    const int maximum = number();
    if (maximum < 1 || maximum > kMaxPgmValue)
      refuse_image(file_, fmt::format("largest gray value {}: must be in [1, {}]", maximum, kMaxPgmValue));
    image.maximum = static_cast<std::uint32_t>(maximum);
    if (image.width <= 0 || image.height <= 0)
      refuse_image(file_, fmt::format("is {} x {} pixels: contains no map", image.width, image.height));
    // Each pixel takes at least one byte of the file.
    const std::size_t min_bytes = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    const std::size_t count = checked_count(file_, image, min_bytes, in_.view().size());
    image.brightness.reserve(count);
    if (magic == "P5") in_.get();
    for (std::size_t i = 0; i < count && in_; ++i) {
      const int value = magic == "P2" ? number() : maximum > kMaxByte ? two_bytes() : in_.rdbuf()->sbumpc();
      if (value < 0) in_.setstate(std::ios::failbit);
      if (value > maximum) refuse_image(file_, fmt::format("a pixel of {} is brighter than {}", value, maximum));
      image.brightness.push_back(3 * static_cast<std::uint32_t>(std::max(value, 0)));
    }
    const std::string pixels = fmt::format("{} x {} pixels", image.width, image.height);
    if (!in_) refuse_image(file_, "ends too early for " + pixels);
    if (magic == "P2") skip_comments();
    if (in_.peek() != kEnd) refuse_image(file_, "has data after its " + pixels);
    return image;
  }

 private:
  static constexpr int kEnd = std::istringstream::traits_type::eof();

  void skip_comments() {
    while (in_ >> std::ws && in_.peek() == '#') in_.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
  }

  /// Reads the next number and skips comments; -1 at the end of the file. Throws InputError with the line of a word
  /// that is no number.
  int number() {
    skip_comments();
    std::string word;
    while (in_ && in_.peek() != kEnd && in_.peek() != '#' && std::isspace(in_.peek()) == 0)
      word += static_cast<char>(in_.get());
    if (word.empty()) return -1;
    int value = -1;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size() || value < 0) refuse_word(word);
    return value;
  }

  [[noreturn]] void refuse_word(const std::string& word) {
    in_.clear();
    const std::string_view before = in_.view().substr(0, static_cast<std::size_t>(in_.tellg()));
    constexpr std::size_t kMaxShown = 20;
    throw InputError(fmt::format("{}:{}: '{}': must be a whole number", file_.string(),
                                 1 + std::count(before.begin(), before.end(), '\n'),
                                 on_one_line(word.substr(0, kMaxShown))));
  }

  /// Value of a pixel of two bytes, the higher one first.
  int two_bytes() {
    const int high = in_.get(), low = in_.get();
    return low == kEnd ? -1 : high << 8 | low;
  }

  std::filesystem::path file_;
  std::istringstream in_;
};

/// Reader of a PNG in memory by libpng. Errors of libpng jump back into the method that is running. Its local variables
/// have no destructors.
class PngDecoder {
 public:
  explicit PngDecoder(std::string_view bytes)
      : rest_(bytes), png_(png_create_read_struct(PNG_LIBPNG_VER_STRING, this, on_error, on_warning)) {
    if (png_ != nullptr) info_ = png_create_info_struct(png_);
    if (info_ == nullptr) {
      png_destroy_read_struct(&png_, nullptr, nullptr);
      throw std::bad_alloc();
    }
    png_set_read_fn(png_, this, read);
  }
  ~PngDecoder() { png_destroy_read_struct(&png_, &info_, nullptr); }
  PngDecoder(const PngDecoder&) = delete;
  PngDecoder& operator=(const PngDecoder&) = delete;

  /// Reads the header. The pixels become gray or RGB of 8 or 16 bits, with alpha if the image has transparency. All
  /// methods return false after an error.
  bool read_header() {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    png_read_info(png_, info_);
    num_passes_ = png_set_interlace_handling(png_);
    num_stored_row_bytes_ = png_get_rowbytes(png_, info_);
    png_set_expand(png_);
    png_read_update_info(png_, info_);
    return true;
  }
  bool read_row(std::uint8_t* row) {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    png_read_row(png_, row, nullptr);
    return true;
  }
  bool read_end() {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    png_read_end(png_, nullptr);
    return true;
  }

  int width() const { return static_cast<int>(png_get_image_width(png_, info_)); }
  int height() const { return static_cast<int>(png_get_image_height(png_, info_)); }
  int num_channels() const { return png_get_channels(png_, info_); }
  bool has_16_bits() const { return png_get_bit_depth(png_, info_) == 16; }
  bool has_alpha() const { return (png_get_color_type(png_, info_) & PNG_COLOR_MASK_ALPHA) != 0; }
  int num_passes() const { return num_passes_; }
  std::size_t num_row_bytes() const { return png_get_rowbytes(png_, info_); }
  std::size_t num_stored_row_bytes() const { return num_stored_row_bytes_; }
  std::string error() const { return error_.data(); }

 private:
  static void read(png_structp png, png_bytep out, std::size_t size) {
    std::string_view& rest = static_cast<PngDecoder*>(png_get_io_ptr(png))->rest_;
    if (size > rest.size()) png_error(png, "ends too early");
    std::memcpy(out, rest.data(), size);
    rest.remove_prefix(size);
  }
  [[noreturn]] static void on_error(png_structp png, png_const_charp what) {
    std::array<char, 128>& error = static_cast<PngDecoder*>(png_get_error_ptr(png))->error_;
    std::strncpy(error.data(), what, error.size() - 1);
    png_longjmp(png, 1);
  }
  static void on_warning(png_structp /*png*/, png_const_charp /*what*/) {}

  std::string_view rest_;
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
  int num_passes_ = 1;
  std::size_t num_stored_row_bytes_ = 0;
  std::array<char, 128> error_{};
};

/// Appends a row of samples to an image.
void append_row(const PngDecoder& png, const std::uint8_t* row, MapImage& image) {
  const std::size_t num_channels = static_cast<std::size_t>(png.num_channels());
  const auto sample = [&](std::size_t i) -> std::uint32_t {
    return png.has_16_bits() ? static_cast<std::uint32_t>(row[2 * i] << 8 | row[2 * i + 1]) : row[i];
  };
  for (std::size_t i = 0; i < num_channels * static_cast<std::size_t>(image.width); i += num_channels) {
    const bool is_gray = num_channels < 3;
    image.brightness.push_back(is_gray ? 3 * sample(i) : sample(i) + sample(i + 1) + sample(i + 2));
    if (png.has_alpha()) image.opacity.push_back(static_cast<std::uint16_t>(sample(i + num_channels - 1)));
  }
}

MapImage decode_png(const std::filesystem::path& file, const std::string& bytes) {
  constexpr std::size_t kMaxDeflateRatio = 1032;
  PngDecoder png(bytes);
  const auto check = [&](bool is_read) {
    if (!is_read) refuse_image(file, "is not a valid PNG: " + png.error());
  };
  check(png.read_header());
  MapImage image{.width = png.width(),
                 .height = png.height(),
                 .maximum = png.has_16_bits() ? 65535U : 255U,
                 .brightness = {},
                 .opacity = {}};
  const std::size_t num_rows = static_cast<std::size_t>(image.height), num_row_bytes = png.num_row_bytes();
  const std::size_t count =
      checked_count(file, image, png.num_stored_row_bytes() * num_rows / kMaxDeflateRatio, bytes.size());
  image.brightness.reserve(count);
  if (png.has_alpha()) image.opacity.reserve(count);
  // The passes of an interlaced image need all rows, others one at a time.
  const bool is_interlaced = png.num_passes() > 1;
  std::vector<std::uint8_t> rows(num_row_bytes * (is_interlaced ? num_rows : 1));
  for (int pass = 1; pass <= png.num_passes(); ++pass) {
    for (std::size_t i = 0; i < num_rows; ++i) {
      std::uint8_t* row = rows.data() + (is_interlaced ? i * num_row_bytes : 0);
      check(png.read_row(row));
      if (pass == png.num_passes()) append_row(png, row, image);
    }
  }
  check(png.read_end());
  return image;
}

}  // namespace

MapImage load_map_image(const std::filesystem::path& file) {
  std::string bytes = load_text(file);
  return bytes.starts_with(kPngSignature) ? decode_png(file, bytes) : PgmDecoder(file, std::move(bytes)).decode();
}

}  // namespace patrol::io
