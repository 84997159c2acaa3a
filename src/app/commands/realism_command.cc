#include <optional>
#include <string>

#include <fmt/format.h>

#include "app/commands/commands.h"
#include "app/common/output_directory.h"
#include "app/common/print_result.h"
#include "app/realism/realism_check.h"
#include "io/files/atomic_file.h"
#include "io/files/csv.h"
#include "io/json/metrics_json.h"
#include "io/yaml/settings_yaml.h"
#include "report/page.h"

namespace patrol::app {
namespace {

const OutputKind kRealism = {.name = "realism check",
                             .marker_text = "The realism check is incomplete.",
                             .outputs = {"metrics.json", "residuals.csv", "settings.yaml", "index.html"},
                             .required_file = "settings.yaml",
                             .preserved = {"*.part"}};

}  // namespace

ExitCode realism_command(const RealismOptions& options) {
  std::optional<RealismInput> input;
  const RealismSettings settings = realism_settings(options.input, options.overrides, options.skip_invalid);
  input = read_realism_input(options.input, settings);
  std::optional<RealismResult> result;
  if (input) result = compare(*input, settings, input->source.device, "realism");
  const OutputLock lock = begin_output(options.out, kRealism);  // not earlier: a damaged log must leave no output
  if (!result) {
    fmt::print(stderr, "patrol: interrupted; {} is incomplete\n", options.out.string());
    return ExitCode::kProgramFailed;
  }
  const io::Metrics metrics = metrics_of(*result);
  const RealismContents contents{.kind = "realism",
                                 .title = fmt::format("Realism of {} in {}", input->source.log.filename().string(),
                                                      input->source.world_xml.stem().string()),
                                 .facts = facts_of(*input, settings),
                                 .notes = notes_of(*input, settings, *result)};
  io::save_metrics(options.out / "metrics.json", metrics);
  io::save_csv(options.out / "residuals.csv", residual_table(binned_residuals(*result)));
  io::save_settings(options.out / "settings.yaml", settings);
  io::save_text(options.out / "index.html", report::to_html(realism_page(contents, *result)));
  complete_output(options.out);
  print_result(options.form,
               fmt::format("{}{}{}\n", io::to_text(input->scans.summary), summary_text(*result),
                           (options.out / "index.html").string()),
               metrics);
  return ExitCode::kDone;
}

}  // namespace patrol::app
