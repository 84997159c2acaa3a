#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace patrol::app {

/// What a command leaves in its directory. Names of files and folders may hold `*`.
struct OutputKind {
  std::string name;               ///< "run"
  std::string unfinished;         ///< what the mark says while the directory is incomplete
  std::vector<std::string> made;  ///< made anew: an earlier one's are removed at the start
  std::vector<std::string> kept;  ///< what lies there stays
};

/// Stands in a directory from the first moment until everything else is written.
std::filesystem::path incomplete_marker(const std::filesystem::path& root);

/// Makes the directory and marks it incomplete. One that holds anything of another kind is refused and left as it was. Throws InputError
/// when it is, or cannot be written.
void begin_output(const std::filesystem::path& root, const OutputKind& kind);

/// Takes the mark away: everything is written.
void complete_output(const std::filesystem::path& root);

}  // namespace patrol::app
