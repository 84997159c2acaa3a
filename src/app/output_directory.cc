#include "app/output_directory.h"

#include <fnmatch.h>

#include <algorithm>
#include <fstream>
#include <system_error>

#include <fmt/format.h>

#include "core/error.h"

namespace patrol::app {
namespace {

bool is_among(const std::string& name, const std::vector<std::string>& patterns) {
  return std::any_of(patterns.begin(), patterns.end(), [&](const std::string& pattern) { return ::fnmatch(pattern.c_str(), name.c_str(), 0) == 0; });
}

/// What an earlier one left and is made anew. Throws when there is anything else.
std::vector<std::filesystem::path> earlier_files(const std::filesystem::path& root, const OutputKind& kind) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(root)) {
    const std::string name = entry.path().filename().string();
    if (entry.path() == incomplete_marker(root) || is_among(name, kind.kept)) continue;
    if (is_among(name, kind.made)) {
      files.push_back(entry.path());
    } else {
      throw InputError(fmt::format("{}: holds {}, which is not part of a {}; name an empty or new directory", root.string(), name, kind.name));
    }
  }
  return files;
}

}  // namespace

std::filesystem::path incomplete_marker(const std::filesystem::path& root) { return root / "INCOMPLETE"; }

void begin_output(const std::filesystem::path& root, const OutputKind& kind) {
  std::error_code error;
  std::filesystem::create_directories(root, error);
  if (error) throw InputError(fmt::format("{}: cannot be made a directory: {}", root.string(), error.message()));
  for (const std::filesystem::path& file : earlier_files(root, kind)) std::filesystem::remove_all(file, error);
  std::ofstream marker(incomplete_marker(root));
  marker << kind.unfinished << "\n";
  if (!marker.flush()) throw InputError(fmt::format("{}: cannot be written to", root.string()));
}

void complete_output(const std::filesystem::path& root) { std::filesystem::remove(incomplete_marker(root)); }

}  // namespace patrol::app
