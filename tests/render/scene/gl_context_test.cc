#include "render/scene/gl_context.h"

#include <cstdlib>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "render/scene/frame.h"
#include "tests/support/temporary_file.h"

namespace patrol::render::gl_context_test {
namespace {

/// tests/render/still_with.cc: each kind of OpenGL needs a process of its own.
int still_with(const std::string& renderer, const std::filesystem::path& out_png) {
  return WEXITSTATUS(std::system(fmt::format("{} {} {}", PATROL_STILL_WITH, renderer, out_png.string()).c_str()));
}

// The same software renderer behind both, reached by two ways; a graphics card rounds edges and textures otherwise.
TEST(GlContext, EglAndOsmesaPaintTheSamePicture) {
  constexpr double kMeanTol = 1.0;  // of 255, over all pixels
  constexpr int kPixelTol = 12;     // of 255; edges and texels may fall otherwise in one of a hundred
  const test::TemporaryFolder folder;
  if (still_with("egl", folder / "egl.png") != 0) GTEST_SKIP() << "EGL gives no OpenGL on this machine";
  ASSERT_EQ(still_with("osmesa", folder / "osmesa.png"), 0);
  const Frame egl = load_png(folder / "egl.png"), osmesa = load_png(folder / "osmesa.png");
  ASSERT_EQ(egl.width(), osmesa.width());
  double sum = 0.0;
  int num_other = 0;
  const int num_bytes = 3 * egl.width() * egl.height();
  for (int i = 0; i < num_bytes; ++i) {
    const int difference = std::abs(egl.bytes()[i] - osmesa.bytes()[i]);
    sum += difference;
    num_other += difference > kPixelTol;
  }
  EXPECT_LT(sum / num_bytes, kMeanTol);
  EXPECT_LT(num_other, num_bytes / 100);
}

TEST(GlContext, KnowsItsRenderersByName) {
  EXPECT_EQ(parse_renderer("auto"), Renderer::kAuto);
  EXPECT_EQ(parse_renderer("egl"), Renderer::kEgl);
  EXPECT_EQ(parse_renderer("osmesa"), Renderer::kOsmesa);
  try {
    parse_renderer("glx");
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "glx: must be one of auto, egl, osmesa");
  }
}

}  // namespace
}  // namespace patrol::render::gl_context_test
