#include "render/video/join_videos.h"

#include <filesystem>
#include <vector>

#include <gtest/gtest.h>

#include "core/error.h"
#include "render/video/inspect_video.h"
#include "render/video/video_writer.h"
#include "tests/support/temporary_file.h"

namespace patrol::render::join_videos_test {
namespace {

void write_video(const std::filesystem::path& file, int num_frames) {
  VideoWriter video(file, 64, 48, 25.0);
  for (int i = 0; i < num_frames; ++i) video.add(Frame(64, 48, {static_cast<std::uint8_t>(8 * i), 40, 60}));
  video.finish();
}

TEST(JoinVideos, FramesFollowEachOtherAndChaptersAreAdded) {
  const test::TemporaryFolder folder;
  write_video(folder / "0.mp4", 10);
  write_video(folder / "1.mp4", 5);
  join_videos({folder / "0.mp4", folder / "1.mp4"}, 10, {{0.0, 0.6, "Whole"}}, folder / "film.mp4");
  const VideoInfo info = inspect_video(folder / "film.mp4");
  EXPECT_EQ(info.num_frames, 15);
  EXPECT_NEAR(info.duration_s, 15 / 25.0, 0.05);
  ASSERT_EQ(info.chapters.size(), 1u);
  EXPECT_EQ(info.chapters[0].title, "Whole");
}

TEST(JoinVideos, AnimatedPictureIsMoved) {
  const test::TemporaryFolder folder;
  write_video(folder / "0.webp", 3);
  join_videos({folder / "0.webp"}, 3, {}, folder / "film.webp");
  EXPECT_TRUE(std::filesystem::exists(folder / "film.webp"));
  EXPECT_FALSE(std::filesystem::exists(folder / "0.webp"));
}

TEST(JoinVideos, MissingSegmentLeavesNoFilm) {
  const test::TemporaryFolder folder;
  write_video(folder / "0.mp4", 3);
  EXPECT_THROW(join_videos({folder / "0.mp4", folder / "1.mp4"}, 3, {}, folder / "film.mp4"), InputError);
  EXPECT_FALSE(std::filesystem::exists(folder / "film.mp4"));
}

}  // namespace
}  // namespace patrol::render::join_videos_test
