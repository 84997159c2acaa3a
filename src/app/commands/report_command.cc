#include <fmt/format.h>

#include "app/campaign/sweep/sweep_directory.h"
#include "app/commands/commands.h"
#include "app/common/progress_bar.h"
#include "app/report/run_page.h"
#include "app/report/sweep_page.h"
#include "core/error.h"
#include "io/files/atomic_file.h"
#include "report/page.h"

namespace patrol::app {
namespace {

/// Loads the page of a study or of a mapped log, which is generated with its results.
std::string load_page(const std::filesystem::path& root) {
  const std::filesystem::path page = root / "report.html";
  if (!std::filesystem::exists(page))
    throw InputError(fmt::format("{}: incomplete: no report can be generated", root.string()));
  return io::load_text(page);
}

report::Page page_of(const std::filesystem::path& root, const std::filesystem::path& page_file) {
  if (!std::filesystem::exists(SweepDirectory{root}.manifest())) return run_page(read_run_contents(root), page_file);
  const SweepDirectory directory = open_sweep_directory(root);
  const SweepManifest manifest = load_manifest(directory.manifest());
  const SweepRows rows = load_rows(manifest, directory.store());
  const SweepProgress progress = evaluate_progress(manifest, rows);
  if (progress.needed.empty()) return sweep_page(manifest, rows, progress);
  throw InputError(fmt::format("{}: {} of {} runs are missing; finish the sweep first", root.string(),
                               progress.needed.size(), progress.counted.size()));
}

}  // namespace

ExitCode report_command(const ReportOptions& options) {
  const std::filesystem::path out = options.out.value_or(options.directory / "report.html");
  if (out.extension() != ".html") throw InputError(fmt::format("--out {}: must end in .html", out.string()));
  std::string html;
  ProgressBar bar;
  bar.show("report  reading the run");
  try {
    const bool is_generated = std::filesystem::exists(options.directory / "study.json") ||
                              std::filesystem::exists(options.directory / "pose_graph.g2o");
    html = is_generated ? load_page(options.directory) : report::to_html(page_of(options.directory, out));
  } catch (const io::Metrics::exception& error) {
    throw InputError(fmt::format("{}: metrics.json: invalid: {}", options.directory.string(), error.what()));
  }
  io::save_text(out, html);
  fmt::print("{}: {:.2f} MB\n", out.string(), 1e-6 * static_cast<double>(html.size()));
  return ExitCode::kDone;
}

}  // namespace patrol::app
