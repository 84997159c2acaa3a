#include "app/report/run_page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/report/error_plots.h"
#include "app/report/event_timeline.h"
#include "app/report/run_map.h"
#include "core/geometry/angles.h"
#include "report/page.h"
#include "tests/support/small_run.h"
#include "tests/support/temporary_file.h"

namespace patrol::app::run_page_test {
namespace {

using test::small_run;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::Pair;

template <typename Wanted>
std::vector<Wanted> blocks_of(const std::vector<report::Block>& blocks) {
  std::vector<Wanted> found;
  for (const report::Block& block : blocks) {
    if (const auto* wanted = std::get_if<Wanted>(&block)) found.push_back(*wanted);
  }
  return found;
}

std::vector<std::string> titles_of(const report::Page& page) {
  std::vector<std::string> titles;
  for (const report::Section& section : page.sections) titles.push_back(section.title);
  return titles;
}

Event event_at(double at_s, EventKind kind) {
  return {.stamp = from_seconds(at_s), .kind = kind, .subject = "box", .text = "", .T_map_body = {}};
}

TEST(RunPage, BeginsWithTheVerdict) {
  const report::Page page = run_page(small_run(), "report.html");
  EXPECT_TRUE(std::holds_alternative<report::VerdictBlock>(page.sections.front().blocks.front()));
  EXPECT_THAT(titles_of(page), ElementsAre("", "Key metrics", "Map", "Error over time", "Settings"));
}

TEST(RunPage, ARunWithoutMissionSaysSo) {
  RunContents run = small_run();
  run.scenario.mission.clear();
  EXPECT_THAT(run_page(run, "report.html").facts, Contains(Pair("mission", "none")));
}

TEST(RunPage, IsTheSameBytesTwice) {
  EXPECT_EQ(report::to_html(run_page(small_run(), "report.html")),
            report::to_html(run_page(small_run(), "report.html")));
}

TEST(RunPage, NamesAndEventsOfARunAreNoMarkup) {
  RunContents run = small_run();
  run.name = run.origin_comment = run.scenario.mission = "<img src=x>";
  run.record.events = {event_at(1.0, EventKind::kForeign)};
  run.record.events[0].foreign_kind = "</script><b>";
  run.record.events[0].subject = run.record.events[0].text = "<img src=x>";
  run.record.collisions = {{.stamp = from_seconds(2.0), .first = "<img src=x>", .second = "</script>"}};
  const std::string html = report::to_html(run_page(run, "report.html"));
  EXPECT_THAT(html, Not(HasSubstr("<img")));
  EXPECT_THAT(html, Not(HasSubstr("</script><b>")));
}

TEST(RunPage, OfARunThatWasCutOffBeforeAnyEstimateStillTellsItsPath) {
  RunContents run = small_run();
  run.is_complete = false;
  run.metrics = io::Metrics::object();
  run.record.T_map_body.clear();
  run.record.covariances.clear();
  run.record.T_odom_body.clear();
  run.record.map = {};
  EXPECT_THAT(report::to_html(run_page(run, "report.html")), HasSubstr("INCOMPLETE"));
}

TEST(RunPage, OfARunThatWasCutOffRightAfterItsFirstEstimateHasNoErrors) {
  RunContents run = small_run();
  run.record.T_world_body.resize(1);
  run.record.T_map_body.erase(run.record.T_map_body.begin());
  EXPECT_TRUE(blocks_of<report::LinePlot>(error_blocks(run)).empty());
}

TEST(RunPage, EmbedsASmallReplayAndPlaysALargeOneFromTheFileNextToThePage) {
  const test::TemporaryFolder folder;
  RunContents run = small_run();
  run.directory.root = folder.path();
  const auto replays = [&](const std::filesystem::path& page_file) {
    for (const report::Section& section : run_page(run, page_file).sections) {
      if (section.title == "Replay") return blocks_of<report::VideoBlock>(section.blocks);
    }
    return std::vector<report::VideoBlock>{};
  };
  EXPECT_TRUE(replays(folder / "report.html").empty());
  test::write_bytes(folder / "replay.mp4", "film");
  EXPECT_EQ(replays(folder / "report.html").at(0).mp4, "film");
  std::filesystem::resize_file(folder / "replay.mp4", 7 << 20);
  EXPECT_EQ(replays(folder / "report.html").at(0).url, "replay.mp4");
  EXPECT_THAT(report::to_html(run_page(run, folder / "report.html")),
              HasSubstr("<video controls preload=\"metadata\" src=\"replay.mp4\">"));
  EXPECT_TRUE(replays(folder / "elsewhere/report.html").empty());
}

TEST(ErrorBlocks, ShowTheEstimatesErrorItsBoundAndOdometrys) {
  const std::vector<report::LinePlot> plots = blocks_of<report::LinePlot>(error_blocks(small_run()));
  ASSERT_EQ(plots.size(), 3u);  // no trust
  EXPECT_EQ(plots[0].title, "Position error");
  EXPECT_NEAR(plots[0].curves[0].points.back().y(), 0.1, 1e-9);
  EXPECT_NEAR(plots[0].curves[1].points.back().y(), 2.0 * 0.05, 1e-9);  // 2 sqrt(0.03^2 + 0.04^2)
  EXPECT_NEAR(plots[1].curves[0].points.back().y(), 0.5, 1e-9);         // 5 % of 10 m
  EXPECT_NEAR(plots[2].curves[1].points.back().y(), to_deg(2.0 * 0.01), 1e-9);
}

TEST(ErrorBlocks, ShadeFaultsAndWhereTheRobotSaysThatItIsLost) {
  RunContents run = small_run();
  run.scenario.faults = {{.sensor = "imu", .kind = "freeze", .start_s = 2.0, .duration_s = 100.0}};
  run.record.confidences = {{.stamp = from_seconds(3.0), .confidence = 1.0},
                            {.stamp = from_seconds(4.0), .is_lost = true},
                            {.stamp = from_seconds(5.0), .confidence = 1.0}};
  const std::vector<report::PlotSpan> spans = spans_of(run);
  ASSERT_EQ(spans.size(), 2u);
  EXPECT_EQ(spans[0].to, 10.0);  // the run's end
  EXPECT_EQ(spans[1].from, 4.0);
  EXPECT_EQ(spans[1].to, 5.0);
}

TEST(Occasions, HaveALaneForEachKindAndMarkTroublesOnTheCurves) {
  RunContents run = small_run();
  run.record.events = {event_at(1.0, EventKind::kStationReached), event_at(2.0, EventKind::kGasAlarm),
                       event_at(3.0, EventKind::kStationReached), event_at(4.0, EventKind::kRecovery)};
  run.record.collisions = {{.stamp = from_seconds(5.0), .first = "trunk", .second = "wall"}};
  std::vector<std::string> names;
  for (const auto& lane : make_lanes(run)) names.push_back(lane.name);
  EXPECT_THAT(names, ElementsAre("station_reached", "gas_alarm", "recovery", "collision"));
  EXPECT_EQ(marks_of(run).size(), 3u);
  EXPECT_EQ(make_lanes(run).back().marks[0].text, "trunk touched wall.");
}

TEST(MapBlocks, DrawThePathsInWorldAndBreakThemWhereTheRobotIsLifted) {
  RunContents run = small_run();
  for (std::size_t i = 50; i < run.record.T_world_body.size(); ++i)
    run.record.T_world_body[i].pose.position.y() += 20.0;
  const report::MapBlock map = blocks_of<report::MapBlock>(map_blocks(run)).at(0);
  EXPECT_EQ(map.paths[0].pieces_m.size(), 2u);
  EXPECT_EQ(map.paths[1].pieces_m.size(), 1u);
  EXPECT_NEAR(map.paths[1].pieces_m[0].front().x(), 5.0, 1e-9);
  EXPECT_NEAR(map.paths[1].pieces_m[0].front().y(), 6.1, 1e-9);
  EXPECT_FALSE(map.picture.has_errors);
}

TEST(MapBlocks, MarkAPlaceOnceAndJoinWhatLiesTogether) {
  RunContents run = small_run();
  run.record.events = {event_at(0.5, EventKind::kStationReached), event_at(8.0, EventKind::kDocked),
                       event_at(8.1, EventKind::kDocked)};
  const std::vector<report::MapMark> marks = blocks_of<report::MapBlock>(map_blocks(run)).at(0).marks;
  ASSERT_EQ(marks.size(), 2u);
  EXPECT_EQ(marks[0].label, "start, box");
  EXPECT_EQ(marks[1].label, "dock");
}

}  // namespace
}  // namespace patrol::app::run_page_test
