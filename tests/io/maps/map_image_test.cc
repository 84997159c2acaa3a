#include "io/maps/map_image.h"

#include <algorithm>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>

#include "core/error.h"
#include "io/maps/map_server.h"
#include "tests/support/temporary_file.h"

namespace patrol::io::map_image_test {
namespace {

using test::TemporaryFolder, test::write_bytes;
using ::testing::ElementsAre, ::testing::IsEmpty, ::testing::MatchesRegex;

constexpr std::int8_t F = kFree, X = kOccupied, U = kUnknown;

/// Content of a PNG of 8 or 16 bits. `samples`: bytes of all rows.
struct PngContent {
  int color_type = PNG_COLOR_TYPE_GRAY;
  int bits = 8;
  int width = 1;
  std::vector<std::uint8_t> samples = {};
  std::vector<png_color> palette = {};
  std::vector<std::uint8_t> palette_alpha = {};
  int interlace = PNG_INTERLACE_NONE;
  double gamma = 0.0;
};

void append_bytes(png_structp png, png_bytep bytes, std::size_t size) {
  static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<const char*>(bytes), size);
}

std::string to_png(const PngContent& content) {
  std::string bytes;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_set_write_fn(png, &bytes, append_bytes, nullptr);
  const int channels = content.color_type == PNG_COLOR_TYPE_RGBA         ? 4
                       : content.color_type == PNG_COLOR_TYPE_RGB        ? 3
                       : content.color_type == PNG_COLOR_TYPE_GRAY_ALPHA ? 2
                                                                         : 1;
  const std::size_t row_bytes = static_cast<std::size_t>(std::max(1, content.width * channels * content.bits / 8));
  const std::size_t height = content.samples.size() / row_bytes;
  png_set_IHDR(png, info, static_cast<png_uint_32>(content.width), static_cast<png_uint_32>(height), content.bits,
               content.color_type, content.interlace, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  if (!content.palette.empty())
    png_set_PLTE(png, info, content.palette.data(), static_cast<int>(content.palette.size()));
  if (!content.palette_alpha.empty())
    png_set_tRNS(png, info, content.palette_alpha.data(), static_cast<int>(content.palette_alpha.size()), nullptr);
  if (content.gamma > 0.0) png_set_gAMA(png, info, content.gamma);
  std::vector<std::uint8_t> samples = content.samples;
  std::vector<png_bytep> rows;
  for (std::size_t i = 0; i < height; ++i) rows.push_back(samples.data() + i * row_bytes);
  png_set_rows(png, info, rows.data());
  png_write_png(png, info, PNG_TRANSFORM_IDENTITY, nullptr);
  png_destroy_write_struct(&png, &info);
  return bytes;
}

class MapImageFile : public ::testing::Test {
 protected:
  MapImage image_of(const std::string& bytes) {
    write_bytes(folder / "m.png", bytes);
    return load_map_image(folder / "m.png");
  }
  std::vector<std::int8_t> cells_of(const PngContent& content, const std::string& mode = "trinary") {
    write_bytes(folder / "m.png", to_png(content));
    write_bytes(folder / "m.yaml", "image: m.png\nresolution: 0.1\norigin: [0, 0, 0]\nnegate: 0\nmode: " + mode + "\n");
    return load_map(folder / "m.yaml").values();
  }
  std::string complaint_about(const std::string& bytes) {
    try {
      image_of(bytes);
    } catch (const InputError& error) {
      return std::string(error.what()).substr(folder.path().string().size() + 1);
    }
    return "";
  }

  TemporaryFolder folder;
  const PngContent gray = {.width = 3, .samples = {0, 254, 205, 254, 0, 0}};
};

TEST_F(MapImageFile, GrayPngHasTheCellsOfThePgm) {
  EXPECT_THAT(cells_of(gray), ElementsAre(F, X, X, X, F, U)) << "the first row of the image is the highest";
  EXPECT_THAT(image_of(to_png(gray)).opacity, IsEmpty());
}

TEST_F(MapImageFile, InterlacedPngHasTheSamePixels) {
  PngContent interlaced = gray;
  interlaced.interlace = PNG_INTERLACE_ADAM7;
  EXPECT_EQ(image_of(to_png(interlaced)).brightness, image_of(to_png(gray)).brightness);
}

TEST_F(MapImageFile, OneBitPngIsBlackAndWhite) {
  EXPECT_THAT(image_of(to_png({.bits = 1, .width = 2, .samples = {0x40}})).brightness, ElementsAre(0, 3 * 255));
}

TEST_F(MapImageFile, ColorsAreTheMeanOfTheirChannels) {
  // Means: 85 (occupied with 0.67), 170 (0.33), 254.
  EXPECT_THAT(
      cells_of({.color_type = PNG_COLOR_TYPE_RGB, .width = 3, .samples = {255, 0, 0, 255, 255, 0, 254, 254, 254}}),
      ElementsAre(X, U, F));
}

TEST_F(MapImageFile, PaletteIsReadAsColorsWithAlpha) {
  const MapImage image = image_of(to_png({.color_type = PNG_COLOR_TYPE_PALETTE,
                                          .width = 3,
                                          .samples = {1, 0, 1},
                                          .palette = {{10, 20, 30}, {255, 254, 253}},
                                          .palette_alpha = {128}}));
  EXPECT_THAT(image.brightness, ElementsAre(762, 60, 762));
  EXPECT_THAT(image.opacity, ElementsAre(255, 128, 255));
}

TEST_F(MapImageFile, SixteenBitsKeepTheirValuesWhateverTheGamma) {
  const MapImage image = image_of(to_png({.bits = 16, .width = 2, .samples = {0x12, 0x34, 0xff, 0xff}, .gamma = 1.0}));
  EXPECT_EQ(image.maximum, 65535U);
  EXPECT_THAT(image.brightness, ElementsAre(3 * 0x1234, 3 * 65535));
}

TEST_F(MapImageFile, TrinaryAveragesAlphaAsNav2Does) {
  // Mean of three times the gray value and alpha: 63.75 (occupied with 0.75), 254.25 (0.003), 217.5 (0.147), 190.5
  // (0.25).
  EXPECT_THAT(
      cells_of({.color_type = PNG_COLOR_TYPE_GRAY_ALPHA, .width = 4, .samples = {0, 255, 254, 255, 205, 255, 254, 0}}),
      ElementsAre(X, F, F, U));
  EXPECT_THAT(cells_of({.color_type = PNG_COLOR_TYPE_RGBA, .width = 2, .samples = {0, 0, 0, 255, 254, 254, 254, 0}}),
              ElementsAre(X, U));
}

TEST_F(MapImageFile, ScaleTakesPixelsThatAreNotOpaqueAsUnknown) {
  EXPECT_THAT(
      cells_of({.color_type = PNG_COLOR_TYPE_GRAY_ALPHA, .width = 4, .samples = {0, 255, 254, 255, 128, 255, 0, 254}},
               "scale"),
      ElementsAre(X, F, 67, U));
}

TEST_F(MapImageFile, PgmsWithAnyLargestGrayValueHaveTheSameCells) {
  const std::string about = "resolution: 0.1\norigin: [0, 0, 0]\nnegate: 0\n";
  write_bytes(folder / "m.yaml", "image: m.png\n" + about);
  // Ratios: 1 (free), 0.8 (unknown with 0.2), 0 (occupied).
  for (const std::string& bytes : {std::string("P5 3 1 100\n") + std::string("d\x50\0", 3),
                                   std::string("P5 3 1 1000\n") + std::string("\x03\xe8\x03\x20\0\0", 6),
                                   std::string("P2 3 1 65535# largest\n65535 52428 0 # end\n")}) {
    write_bytes(folder / "m.png", bytes);
    EXPECT_THAT(load_map(folder / "m.yaml").values(), ElementsAre(F, U, X)) << bytes;
  }
}

TEST_F(MapImageFile, BrokenPgmsAreNamedWithTheirCause) {
  EXPECT_EQ(complaint_about("P2\n# made by hand\n2 2\n255\n0 254\n2x5 0\n"), "m.png:6: '2x5': must be a whole number");
  EXPECT_EQ(complaint_about("P2\n2 2\n255\n0 254 -5 0\n"), "m.png:4: '-5': must be a whole number");
  EXPECT_EQ(complaint_about("P2\n2 2\n255\n0 254 205\n"), "m.png: ends too early for 2 x 2 pixels");
  EXPECT_EQ(complaint_about(std::string("P5 1 2 1000\n\0\0\0", 15)), "m.png: ends too early for 1 x 2 pixels");
  EXPECT_EQ(complaint_about("P5 1 1 70000\n0"), "m.png: largest gray value 70000: must be in [1, 65535]");
  EXPECT_EQ(complaint_about("P6 1 1 255\n000"), "m.png: is neither a PGM (P5 or P2) nor a PNG");
  EXPECT_EQ(complaint_about("P2 1 1 100\n101"), "m.png: a pixel of 101 is brighter than 100");
}

TEST_F(MapImageFile, BrokenPngsAreNamedInOneLine) {
  const std::string good = to_png(gray);
  EXPECT_EQ(complaint_about(good), "");
  for (std::size_t size = 4; size < good.size(); ++size)
    EXPECT_THAT(complaint_about(good.substr(0, size)), MatchesRegex("m.png: [^\n]*")) << "cut to " << size << " bytes";
  EXPECT_EQ(complaint_about(good.substr(0, good.size() - 12)), "m.png: is not a valid PNG: ends too early");
  std::string flipped = good;
  flipped[good.find("IDAT") + 8] ^= 1;
  EXPECT_THAT(complaint_about(flipped), MatchesRegex("m.png: is not a valid PNG: [^\n]*"));
  // Width of 2^24 + 3 pixels: over the limit of libpng.
  std::string wide = good;
  wide[16] = 1;
  EXPECT_THAT(complaint_about(wide), MatchesRegex("m.png: is not a valid PNG: [^\n]*"));
}

TEST_F(MapImageFile, PngsTooShortForTheirSizeAreRefusedBeforeMemoryIsAllocated) {
  std::string bytes = to_png({.width = 1000, .samples = std::vector<std::uint8_t>(1000 * 1000)});
  const std::size_t end = bytes.find("IDAT") + 4;
  EXPECT_EQ(complaint_about(bytes.substr(0, end)), "m.png: ends too early for 1000 x 1000 pixels");
}

}  // namespace
}  // namespace patrol::io::map_image_test
