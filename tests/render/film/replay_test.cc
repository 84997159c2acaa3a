#include "render/film/replay.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/error.h"
#include "io/logs/run_log.h"
#include "render/scene/palette.h"
#include "render/video/inspect_video.h"
#include "tests/render/small_scene.h"
#include "tests/support/temporary_file.h"

namespace patrol::render::replay_test {
namespace {

using namespace std::chrono_literals;

/// Two seconds of a robot that walks along x at 0.5 m/s, its state logged at 50 Hz: 0 s ... 1.98 s.
void write_log(const std::filesystem::path& file, std::size_t num_qpos = 7) {
  RobotDescription robot;
  robot.T_body_sensor["lidar"] = {{0.0, 0.0, 0.1}, Eigen::Quaterniond::Identity()};
  io::RunLogWriter log(file, robot);
  for (int tick = 0; tick < 100; ++tick) {
    const Time now = tick * 20ms;
    const double x = 0.5 * to_seconds(now);
    log.write(now, GroundTruth{now, {{x, 0.0, 0.3}, Eigen::Quaterniond::Identity()}, {}});
    log.write(now, PoseEstimate{now, {x, 0.05, 0.0}, Eigen::Matrix3d::Zero()});
    SimState state{.stamp = now, .qpos = {x, 0.0, 0.3, 1.0, 0.0, 0.0, 0.0}, .mocap = {}};
    state.qpos.resize(num_qpos);
    log.write(now, state);
  }
  log.close();
}

sim::AssembledModel model() {
  return {.physics = nullptr, .view = small_scene(kRobotBeforeWall), .start_qpos = {}, .stance = {}};
}

struct ReplaySummary {
  int num_frames = 0;
  Time end{};
  int num_chapters = 0;
  bool log_is_complete = true;
  bool is_interrupted = false;
};

/// Renders and joins a film in `num_parts` parts.
ReplaySummary replay(const std::filesystem::path& log, sim::AssembledModel model, const Pose2& T_world_map,
                     const ReplaySettings& settings, const std::filesystem::path& out,
                     const ReplayProgress& progress = {}, int num_parts = 1) {
  const ReplayFilm film(log, std::move(model), T_world_map, settings, out);
  bool is_whole = true;
  for (int part = 0; part < num_parts && is_whole; ++part) is_whole = film.render(part, num_parts, progress);
  if (is_whole) film.join();
  film.remove_segments();
  return {.num_frames = film.num_frames(),
          .end = film.end(),
          .num_chapters = film.num_chapters(),
          .log_is_complete = film.log_is_complete(),
          .is_interrupted = !is_whole};
}

class Replay : public ::testing::Test {
 protected:
  void SetUp() override { write_log(log); }

  test::TemporaryFolder folder;
  const std::filesystem::path log = folder / "log.mcap";
  const std::filesystem::path film = folder / "replay.mp4";
  ReplaySettings settings{
      .style = FilmStyle::kContinuous, .speed = {.fast = 1.0}, .width = 160, .height = 90, .frames_per_second = 10.0};
};

TEST_F(Replay, FilmsTheRunAtTheRateThatWasAsked) {
  const ReplaySummary summary = replay(log, model(), {}, settings, film);
  EXPECT_EQ(summary.num_frames, 20);
  EXPECT_EQ(summary.end, 1980ms);
  EXPECT_TRUE(summary.log_is_complete);
  const VideoInfo info = inspect_video(film);
  EXPECT_EQ(info.num_frames, 20);
  EXPECT_EQ(info.width, 160);
  EXPECT_NEAR(info.duration_s, 2.0, 0.05);
}

TEST_F(Replay, FourTimesTheSpeedIsAQuarterOfTheFrames) {
  settings.speed.fast = 4.0;
  EXPECT_EQ(replay(log, model(), {}, settings, film).num_frames, 5);
}

TEST_F(Replay, IsTheSameFilmEachTime) {
  settings.style = FilmStyle::kHighlights;
  settings.speed.fast = 2.0;
  replay(log, model(), {}, settings, folder / "one.mp4");
  replay(log, model(), {}, settings, folder / "again.mp4");
  EXPECT_EQ(test::read_bytes(folder / "one.mp4"), test::read_bytes(folder / "again.mp4"));
}

TEST_F(Replay, InThreePartsOfSegmentsIsTheSameFilm) {
  settings.frames_per_segment = 4;
  settings.speed.fast = 1.0;
  const int num_frames = replay(log, model(), {}, settings, folder / "one.mp4").num_frames;
  replay(log, model(), {}, settings, folder / "three.mp4", {}, 3);
  EXPECT_EQ(test::read_bytes(folder / "one.mp4"), test::read_bytes(folder / "three.mp4"));
  const VideoInfo info = inspect_video(folder / "three.mp4");
  EXPECT_EQ(info.num_frames, num_frames);
  EXPECT_NEAR(info.duration_s, num_frames / settings.frames_per_second, 0.5 / settings.frames_per_second);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 3) << "no segments are left";
}

TEST(SegmentSize, IsASixteenthOfTheFilmFrom30To300Frames) {
  EXPECT_EQ(segment_size(1), 30);
  EXPECT_EQ(segment_size(480), 30);
  EXPECT_EQ(segment_size(481), 31);
  EXPECT_EQ(segment_size(1090), 69);
  EXPECT_EQ(segment_size(9000), 300);
}

TEST_F(Replay, IsAnAnimatedPictureOfTheSameFrames) {
  const int num_frames = replay(log, model(), {}, settings, folder / "film.webp").num_frames;
  const std::string bytes = test::read_bytes(folder / "film.webp");
  EXPECT_EQ(bytes.substr(0, 4), "RIFF");
  EXPECT_EQ(bytes.substr(8, 4), "WEBP");
  int num_animated = 0;
  for (std::size_t at = bytes.find("ANMF"); at != std::string::npos; at = bytes.find("ANMF", at + 4)) ++num_animated;
  EXPECT_GE(num_animated, 1);
  EXPECT_LE(num_animated, num_frames);  // equal frames are one
}

// 1.98 s at 8 would be 0.2475 s of film. The fault's scene reaches over the whole run: 1.98 / 2 = 0.99 s, frames at 0
// ... 0.9 s.
TEST_F(Replay, OfAStoryIsSlowAtItsMomentsAndHasThemForChapters) {
  settings.style = FilmStyle::kHighlights;
  settings.speed = {.fast = 8.0, .slow = 2.0};
  settings.announced = {{1s, HighlightKind::kFault, "Fault: dropout of lidar"}};
  const ReplaySummary summary = replay(log, model(), {}, settings, film);
  EXPECT_EQ(summary.num_frames, 10);
  const VideoInfo info = inspect_video(film);
  ASSERT_EQ(info.chapters.size(), 1u);
  EXPECT_EQ(info.chapters[0].title, "Maximum position error: 0.050 m; Fault: dropout of lidar");
  settings.style = FilmStyle::kContinuous;
  EXPECT_EQ(replay(log, model(), {}, settings, film).num_frames, 3);
}

TEST_F(Replay, LeavesNothingWhenItIsInterrupted) {
  EXPECT_TRUE(replay(log, model(), {}, settings, film, [](double) { return false; }).is_interrupted);
  EXPECT_FALSE(std::filesystem::exists(film));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1)
      << "the log, and no part of a film";
}

TEST_F(Replay, TellsHowFarItIs) {
  double last = -1.0;
  replay(log, model(), {}, settings, film, [&](double done) {
    EXPECT_GE(done, last);
    last = done;
    return true;
  });
  EXPECT_DOUBLE_EQ(last, 1.0);
}

TEST_F(Replay, AStillShowsTheWorldAndTheOverlay) {
  settings.width = 640;
  settings.height = 360;
  still(log, model(), {}, settings, 1s, folder / "still.png");
  const Frame frame = load_png(folder / "still.png");
  ASSERT_EQ(frame.width(), 640);
  int green = 0, orange = 0, red = 0;
  for (int y = 60; y < 260; ++y) {  // between figures and legend
    for (int x = 0; x < 640; ++x) {
      const Color& c = frame.at(x, y);
      const auto is_like = [&](Color other) {
        return std::abs(c.r - other.r) < 30 && std::abs(c.g - other.g) < 30 && std::abs(c.b - other.b) < 30;
      };
      green += is_like(kTruthColor);
      orange += is_like(kEstimateColor);
      red += c.r > 60 && c.r > 3 * c.g;
    }
  }
  EXPECT_GT(red, 500) << "the robot";
  EXPECT_GT(green, 20) << "the true path";
  EXPECT_GT(orange, 20) << "the estimated path";
}

/// Where the wall before the robot is, beside the robot.
Color wall_color(const Frame& frame) { return frame.at(frame.width() * 2 / 5, frame.height() * 3 / 10); }

TEST_F(Replay, ShowsTheDustAndTheDimLightOfTheRun) {
  settings.width = 640;  // with room between figures and legend
  settings.height = 360;
  still(log, model(), {}, settings, 1s, folder / "clear.png");
  settings.dust = {.enabled = true, .visibility_m = 0.5};
  still(log, model(), {}, settings, 1s, folder / "dust.png");
  settings.dust.enabled = false;
  settings.light.intensity = 0.5;
  still(log, model(), {}, settings, 1s, folder / "dim.png");
  const Color clear = wall_color(load_png(folder / "clear.png")), dust = wall_color(load_png(folder / "dust.png")),
              dim = wall_color(load_png(folder / "dim.png"));
  EXPECT_EQ(dust, (Color{0, 0, 0})) << "this little world's fog";
  EXPECT_GT(clear.r, 50);
  EXPECT_NEAR(dim.r, std::pow(0.5, 1.0 / 2.2) * clear.r, 2);
}

TEST_F(Replay, ShowsTheMapThatTheRobotWasGiven) {
  settings.width = 640;
  settings.height = 360;
  still(log, model(), {}, settings, 1s, folder / "without.png");
  settings.map = OccupancyGrid({.resolution_m = 0.1, .width = 100, .height = 100, .origin_m = {0.0, 0.0}}, kFree);
  still(log, model(), {}, settings, 1s, folder / "with.png");
  const Frame without = load_png(folder / "without.png"), with = load_png(folder / "with.png");
  int floor = 0;
  for (int y = 180; y < 360; ++y) {
    for (int x = 320; x < 640; ++x) floor += with.at(x, y) != without.at(x, y);
  }
  EXPECT_GT(floor, 90 * 90) << "10 m at a pixel a cell";
}

TEST_F(Replay, RefusesALogOfAnotherRobot) {
  write_log(log, 19);
  EXPECT_THROW(replay(log, model(), {}, settings, film), InputError);
  EXPECT_FALSE(std::filesystem::exists(film));
}

TEST_F(Replay, RefusesALogWithoutStates) {
  io::RunLogWriter empty(log, RobotDescription{});
  empty.write(0s, GroundTruth{});
  empty.close();
  EXPECT_THROW(replay(log, model(), {}, settings, film), InputError);
  EXPECT_THROW(still(log, model(), {}, settings, 1s, folder / "still.png"), InputError);
}

TEST_F(Replay, RefusesASpeedOfNothing) {
  settings.speed.fast = 0.0;
  EXPECT_THROW(replay(log, model(), {}, settings, film), InputError);
}

}  // namespace
}  // namespace patrol::render::replay_test
