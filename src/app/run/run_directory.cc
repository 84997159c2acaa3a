#include "app/run/run_directory.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include "core/error.h"

namespace patrol::app {
namespace {

constexpr std::array<std::string_view, 17> kOurFiles = {
    "scenario.yaml", "log.mcap", "metrics.json", "junit.xml", "estimate.tum", "truth.tum",  "odometry.tum",
    "map.yaml",      "map.pgm",  "truth_map.yaml", "truth_map.pgm", "INCOMPLETE",   "report.html", "replay.mp4",
    "nav.json", "remote.csv", "map_errors.pgm"};

bool is_ours(const std::filesystem::path& file) {
  const std::string name = file.filename().string();
  return std::find(kOurFiles.begin(), kOurFiles.end(), name) != kOurFiles.end() ||
         name.ends_with(".part") || (name.starts_with("still_") && name.ends_with(".png"));
}

void remove_earlier_run(const std::filesystem::path& root) {
  for (const auto& entry : std::filesystem::directory_iterator(root)) {
    if (!is_ours(entry.path())) {
      throw InputError(fmt::format("{}: holds {}, which is not part of a run; name an empty or new directory",
                                   root.string(), entry.path().filename().string()));
    }
  }
  for (const auto& entry : std::filesystem::directory_iterator(root)) std::filesystem::remove(entry.path());
}

}  // namespace

bool RunDirectory::is_complete() const {
  return std::filesystem::exists(metrics()) && !std::filesystem::exists(incomplete_marker());
}

RunDirectory begin_run_directory(const std::filesystem::path& root) {
  std::error_code error;
  std::filesystem::create_directories(root, error);
  if (error) throw InputError(fmt::format("{}: cannot be made a directory: {}", root.string(), error.message()));
  remove_earlier_run(root);
  const RunDirectory directory{root};
  std::ofstream marker(directory.incomplete_marker());
  marker << "This run has not ended: what lies here is not a result.\n";
  if (!marker.flush()) throw InputError(fmt::format("{}: cannot be written to", root.string()));
  return directory;
}

void complete_run_directory(const RunDirectory& directory) {
  std::filesystem::remove(directory.incomplete_marker());
}

RunDirectory open_run_directory(const std::filesystem::path& root) {
  const RunDirectory directory{root};
  if (!std::filesystem::exists(directory.log())) {
    throw InputError(fmt::format("{}: not a run directory: it has no log.mcap", root.string()));
  }
  return directory;
}

}  // namespace patrol::app
