#include "app/check/run_check.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

#include "app/check/blocked_beams.h"
#include "app/check/check_drive.h"
#include "app/check/maneuver_figures.h"
#include "app/check/scan_reach.h"
#include "app/common/temporary_folder.h"
#include "io/files/atomic_file.h"

namespace patrol::app {
namespace {

/// Drives a maneuver. A maneuver with a picture keeps the state at its place, or the last one before.
ManeuverResult drive(const CheckRobot& robot, const Maneuver& maneuver, const std::filesystem::path& folder,
                     const std::function<void(double time_s)>& on_time) {
  const std::filesystem::path world_xml = folder / (maneuver.name + ".xml");
  io::save_text(world_xml, maneuver.world.mjcf);
  ManeuverResult result{.maneuver = maneuver, .record = {}, .figures = {}, .failures = {}, .picture = std::nullopt};
  std::optional<CheckDrive> drive;
  const auto on_sample = [&](double time_s) {
    on_time(time_s);
    if (!drive || !maneuver.picture_ahead_m) return;
    const DriveSample& last = drive->record().samples.back();
    if (last.T_start_center.x > *maneuver.picture_ahead_m && result.picture) return;
    result.picture =
        PictureScene{.world_mjcf = maneuver.world.mjcf, .state = drive->state(), .caption = maneuver.title};
  };
  drive.emplace(robot, world_xml, maneuver.settle_s, on_sample);
  for (const DriveSegment& segment : maneuver.segments) drive->run(segment);
  result.record = drive->record();
  result.figures = maneuver.measure(robot, maneuver, result.record);
  result.failures = failures_of(robot, maneuver, result.record, result.figures);
  return result;
}

}  // namespace

bool CheckResult::is_passed() const { return num_failed() == 0; }

std::size_t CheckResult::num_failed() const {
  return static_cast<std::size_t>(
      std::ranges::count_if(maneuvers, [](const ManeuverResult& each) { return !each.is_passed(); }));
}

CheckResult run_check(const CheckRobot& robot, const CheckProgress& progress) {
  const TemporaryFolder folder("check");
  const std::vector<Maneuver> maneuvers = maneuvers_of(robot);
  double total_s = 0.0, done_s = 0.0;
  for (const Maneuver& maneuver : maneuvers) total_s += maneuver.duration_s;
  CheckResult result{.robot = robot,
                     .warnings = warnings_of(blocked_beams(robot, folder.path()), robot.scan_leveling),
                     .maneuvers = {}};
  std::ranges::move(scan_reach_warnings(robot), std::back_inserter(result.warnings));
  std::ranges::move(scan_plane_warnings(robot), std::back_inserter(result.warnings));
  for (const Maneuver& maneuver : maneuvers) {
    const auto on_time = [&](double time_s) {
      progress(maneuver.title, (done_s + std::min(time_s, maneuver.duration_s)) / total_s);
    };
    result.maneuvers.push_back(drive(robot, maneuver, folder.path(), on_time));
    done_s += maneuver.duration_s;
  }
  return result;
}

}  // namespace patrol::app
