#include <stdexcept>

#include <fmt/format.h>

#include "app/check/check_output.h"
#include "app/check/check_page.h"
#include "app/check/check_pictures.h"
#include "app/check/run_check.h"
#include "app/commands/commands.h"
#include "app/common/output_directory.h"
#include "app/common/progress_bar.h"
#include "app/common/text_style.h"
#include "app/scenario/data_folders.h"
#include "io/files/atomic_file.h"
#include "io/json/metrics_json.h"
#include "report/page.h"
#include "sim/model_assembly.h"

namespace patrol::app {
namespace {

const OutputKind kCheck = {.name = "check drive",
                           .marker_text = "Incomplete: not every maneuver has ended.",
                           .outputs = {"check.json", "check.html", "*.part"},
                           .required_file = "check.json",
                           .preserved = {}};

CheckResult run_with_progress(const CheckRobot& robot) {
  const InterruptGuard guard;
  ProgressBar bar;
  return run_check(robot, [&](const std::string& title, double fraction) {
    if (guard.is_interrupted()) throw std::runtime_error("interrupted; the check drive is incomplete");
    bar.show(fmt::format("check {}  {:3.0f} %  {}", robot.name, 100.0 * fraction, title), fraction);
  });
}

}  // namespace

ExitCode check_command(const CheckOptions& options) {
  const CheckRobot robot = load_check_robot(options.robot, options.overrides, options.seed, find_data_root({}));
  if (options.mjcf) {
    io::save_text(*options.mjcf, sim::mjcf_of(robot.simulator.robot_urdf, robot.description));
    fmt::print("{}\n", options.mjcf->string());
    return ExitCode::kDone;
  }
  const OutputLock lock = begin_output(options.out, kCheck);
  const CheckResult result = run_with_progress(robot);
  const io::Metrics json = check_json(result);
  io::save_metrics(options.out / "check.json", json);
  const std::filesystem::path page = options.out / "check.html";
  io::save_text(page, report::to_html(check_page(result, render_check_pictures(result))));
  complete_output(options.out);
  print_result(options.form, check_table(result, output_style()) + page.string() + "\n", json);
  return result.is_passed() ? ExitCode::kDone : ExitCode::kExpectationMissed;
}

}  // namespace patrol::app
