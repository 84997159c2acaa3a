#include <fmt/format.h>

#include "app/commands/commands.h"
#include "app/common/progress_bar.h"
#include "app/scenario/data_folders.h"
#include "app/scenario/mounts.h"
#include "app/scenario/scenario.h"
#include "importer/site/course.h"

namespace patrol::app {
namespace {

/// Radius of the circle around the benchmark's robot, which is 0.508 m long and 0.43 m wide.
constexpr double kBenchmarkRadius_m = 0.333;

/// Returns the courses of the benchmark for the size and the speed of a robot.
importer::CourseSettings settings_for(const std::string& robot) {
  const std::filesystem::path data_root = find_data_root({});
  const Scenario scenario = default_scenario(robot, data_root);
  const RobotDescription description = load_robot(robot, data_root, scenario.mounts).description;
  return {.scale = description.outline_radius_m() / kBenchmarkRadius_m,
          .max_speed_mps = scenario.stack.navigation.local_planner.dwa.max_speed_mps};
}

/// Writes courses until the user interrupts. Returns how many were written.
int write_courses(const GenerateOptions& options, const importer::CourseSettings& settings,
                  const InterruptGuard& guard) {
  ProgressBar bar;
  int num_written = 0;
  while (num_written < options.count && !guard.is_interrupted()) {
    const std::uint64_t number = options.number + static_cast<std::uint64_t>(num_written);
    const std::string name = fmt::format("course_{:03}", number);
    importer::write_site(site_of_course(importer::draw_course(number, settings), settings, name, options.robot),
                         options.out / name);
    ++num_written;
    bar.show(fmt::format("{} of {} courses", num_written, options.count),
             static_cast<double>(num_written) / options.count);
  }
  return num_written;
}

}  // namespace

ExitCode generate_command(const GenerateOptions& options) {
  const importer::CourseSettings settings = settings_for(options.robot);
  const InterruptGuard guard;
  if (const int num_written = write_courses(options, settings, guard); num_written < options.count) {
    fmt::print(stderr, "patrol: interrupted; {} of {} courses written\n", num_written, options.count);
    return ExitCode::kProgramFailed;
  }
  fmt::print("{} courses for {}: sizes of the benchmark times {:.2f}, maximum speed {:g} m/s; {}\n", options.count,
             options.robot, settings.scale, settings.max_speed_mps, options.out.string());
  return ExitCode::kDone;
}

}  // namespace patrol::app
