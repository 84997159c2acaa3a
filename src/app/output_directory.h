#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace patrol::app {

/// Files that a command writes to its directory. Names may hold `*`, and a `/` for files below a folder: "scans/*.ply".
struct OutputKind {
  std::string name;               ///< "run"
  std::string unfinished;         ///< text of the mark while the directory is incomplete
  std::vector<std::string> made;  ///< removed at the start when an earlier command of this kind wrote them
  std::string proof;              ///< file that every complete directory of this kind holds; without it or the mark nothing is removed
  std::vector<std::string> kept;  ///< files and folders that stay
  bool is_shared = false;         ///< several processes may write to the directory at the same time
};

/// Stands in a directory from the first moment until everything else is written.
std::filesystem::path incomplete_marker(const std::filesystem::path& root);

/// Lock on a directory's mark, held by this process until the object is destroyed or the process ends. Record lock of fcntl: not inherited
/// by forked processes, and void within one process.
class OutputLock {
 public:
  OutputLock() = default;
  explicit OutputLock(int descriptor) : descriptor_(descriptor) {}
  ~OutputLock();
  OutputLock(OutputLock&& other) noexcept : descriptor_(other.descriptor_) { other.descriptor_ = -1; }
  OutputLock& operator=(OutputLock&& other) noexcept;

 private:
  int descriptor_ = -1;
};

/// Makes the directory, locks it unless `kind.is_shared`, marks it incomplete, and removes the regular files of an earlier command of the
/// same kind. Throws InputError, and leaves the directory as it was, when it holds anything else (other names, links, a folder or a device
/// in place of a file; or files of these names but no proof), when another process writes to it, or when it cannot be written.
[[nodiscard]] OutputLock begin_output(const std::filesystem::path& root, const OutputKind& kind);

/// Removes the mark: everything is written.
void complete_output(const std::filesystem::path& root);

}  // namespace patrol::app
