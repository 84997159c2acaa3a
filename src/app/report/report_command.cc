#include <fmt/format.h>

#include "app/commands.h"
#include "app/report/run_page.h"
#include "core/error.h"
#include "io/atomic_file.h"
#include "render/report/page.h"

namespace patrol::app {

ExitCode report_command(const ReportOptions& options) {
  const std::filesystem::path out = options.out.value_or(options.directory / "report.html");
  std::string html;
  try {
    html = render::to_html(run_page(read_run_contents(options.directory), out));
  } catch (const io::Metrics::exception& error) {
    throw InputError(fmt::format("{}: metrics.json is not as a run leaves it: {}", options.directory.string(), error.what()));
  }
  io::save_text(out, html);
  fmt::print("{}: {:.2f} MB\n", out.string(), 1e-6 * static_cast<double>(html.size()));
  return ExitCode::kDone;
}

}  // namespace patrol::app
