#include "render/video/video_writer.h"

#include <malloc.h>

#include <cstdint>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "core/error.h"
#include "render/video/inspect_video.h"
#include "tests/support/temporary_file.h"

namespace patrol::render::video_writer_test {
namespace {

void write_film(const std::filesystem::path& file, int num_frames) {
  VideoWriter video(file, 160, 90, 25.0);
  for (int i = 0; i < num_frames; ++i) {
    Frame frame(160, 90, {20, 40, 60});
    for (int y = 30; y < 60; ++y) {
      for (int x = 0; x < 20; ++x) frame.at(x + 4 * i % 140, y) = {220, 180, 20};
    }
    video.add(frame);
  }
  video.finish();
}

TEST(VideoWriter, HoldsEveryFrameAtItsSizeAndRate) {
  const test::TemporaryFolder folder;
  write_film(folder / "film.mp4", 30);
  const VideoInfo info = inspect_video(folder / "film.mp4");
  EXPECT_EQ(info.width, 160);
  EXPECT_EQ(info.height, 90);
  EXPECT_EQ(info.num_frames, 30);
  EXPECT_NEAR(info.duration_s, 30 / 25.0, 0.05);
}

TEST(VideoWriter, SameFramesGiveTheSameBytes) {
  const test::TemporaryFolder folder;
  write_film(folder / "a.mp4", 12);
  write_film(folder / "b.mp4", 12);
  EXPECT_EQ(test::read_bytes(folder / "a.mp4"), test::read_bytes(folder / "b.mp4"));
}

/// Film of moving tiles under noise, with the heap filled with `byte` before it is used.
std::string bytes_of_film_on_heap_of(int byte, const std::filesystem::path& file) {
  constexpr int kTile = 60;
  mallopt(M_PERTURB, byte);
  VideoWriter video(file, 320, 180, 30.0);
  for (int i = 0; i < 12; ++i) {
    Frame frame(320, 180);
    std::uint32_t noise = 1U + static_cast<std::uint32_t>(i);
    for (int y = 0; y < 180; ++y) {
      for (int x = 0; x < 320; ++x) {
        noise = 1664525U * noise + 1013904223U;
        const auto tile = static_cast<std::uint32_t>((x + 9 * i) / kTile * 37 + y / kTile * 91);
        const auto level = static_cast<std::uint8_t>((tile * 2654435761U >> 25) % 100 + (noise >> 30));
        frame.at(x, y) = {level, static_cast<std::uint8_t>(level / 2 + y / 2), level};
      }
    }
    video.add(frame);
  }
  video.finish();
  mallopt(M_PERTURB, 0);
  return test::read_bytes(file);
}

TEST(VideoWriter, TheBytesDoNotDependOnTheFormerContentOfTheHeap) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(bytes_of_film_on_heap_of(5, folder / "a.mp4"), bytes_of_film_on_heap_of(9, folder / "b.mp4"));
}

TEST(VideoWriter, CanBePlayedBeforeAllOfItHasCome) {
  const test::TemporaryFolder folder;
  write_film(folder / "film.mp4", 12);
  const std::string bytes = test::read_bytes(folder / "film.mp4");
  EXPECT_LT(bytes.find("moov"), bytes.find("mdat"));
}

TEST(VideoWriter, LeavesNothingBehindWhenItIsNotFinished) {
  const test::TemporaryFolder folder;
  {
    VideoWriter video(folder / "film.mp4", 160, 90, 25.0);
    video.add(Frame(160, 90));
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(VideoWriter, KeepsItsChapters) {
  const test::TemporaryFolder folder;
  VideoWriter video(folder / "film.mp4", 160, 90, 25.0, {{0.0, 0.4, "Start"}, {0.4, 1.0, "Leak at box 2: 4070 ppm m"}});
  for (int i = 0; i < 25; ++i) video.add(Frame(160, 90));
  video.finish();
  const VideoInfo info = inspect_video(folder / "film.mp4");
  EXPECT_EQ(info.num_frames, 25);
  ASSERT_EQ(info.chapters.size(), 2u);
  EXPECT_NEAR(info.chapters[1].begin_s, 0.4, 1e-3);  // kept in milliseconds
  EXPECT_NEAR(info.chapters[1].end_s, 1.0, 1e-3);
  EXPECT_EQ(info.chapters[1].title, "Leak at box 2: 4070 ppm m");
}

TEST(VideoWriter, RefusesAnOddSize) {
  const test::TemporaryFolder folder;
  EXPECT_THROW(VideoWriter(folder / "film.mp4", 161, 90, 25.0), InputError);
}

TEST(VideoWriter, NamesThePlaceThatCannotBeWritten) {
  EXPECT_THROW(VideoWriter("/nowhere/at/all/film.mp4", 160, 90, 25.0), InputError);
}

TEST(VideoWriter, RefusesANameOfAnUnknownFormat) {
  const test::TemporaryFolder folder;
  EXPECT_THROW(VideoWriter(folder / "film.gif", 160, 90, 25.0), InputError);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace patrol::render::video_writer_test
