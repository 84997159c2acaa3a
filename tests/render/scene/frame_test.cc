#include "render/scene/frame.h"

#include <cstdint>

#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/support/temporary_file.h"

namespace patrol::render::frame_test {
namespace {

Frame colourful(int width, int height) {
  Frame frame(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      frame.at(x, y) = {static_cast<std::uint8_t>(7 * x), static_cast<std::uint8_t>(11 * y),
                        static_cast<std::uint8_t>(x * y)};
    }
  }
  return frame;
}

TEST(Png, ReadsBackEveryPixelThatWasWritten) {
  const test::TemporaryFolder folder;
  const Frame frame = colourful(37, 23);
  save_png(folder / "frame.png", frame);
  EXPECT_EQ(load_png(folder / "frame.png"), frame);
}

TEST(Png, GivesTheSameBytesForTheSameFrame) {
  const test::TemporaryFolder folder;
  save_png(folder / "a.png", colourful(40, 30));
  save_png(folder / "b.png", colourful(40, 30));
  EXPECT_EQ(test::read_bytes(folder / "a.png"), test::read_bytes(folder / "b.png"));
}

TEST(Png, NamesThePlaceThatCannotBeWritten) {
  EXPECT_THROW(save_png("/nowhere/at/all/frame.png", colourful(2, 2)), InputError);
}

TEST(Png, RefusesAFileThatIsNone) {
  const test::TemporaryFolder folder;
  test::write_bytes(folder / "frame.png", "not a picture");
  EXPECT_THROW(load_png(folder / "frame.png"), InputError);
}

TEST(FrameTest, StartsAtTheUpperLeftCorner) {
  Frame frame(3, 2, {1, 2, 3});
  frame.at(1, 0) = {9, 8, 7};
  EXPECT_EQ(frame.bytes()[3], 9);
  EXPECT_EQ(frame.bytes()[5], 7);
  EXPECT_EQ(frame.bytes()[9], 1);
}

}  // namespace
}  // namespace patrol::render::frame_test
