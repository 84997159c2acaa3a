#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace patrol::app {

/// Files that a command writes to its directory. Names may contain `*`, and a `/` for files below a folder:
/// "scans/*.ply".
struct OutputKind {
  std::string name;                    ///< "run"
  std::string marker_text;             ///< text of the marker file while the directory is incomplete
  std::vector<std::string> outputs;    ///< outputs, removed at the start if an earlier command of this kind wrote them
  std::string required_file;           ///< in every complete directory; without it or the marker, nothing is removed
  std::vector<std::string> preserved;  ///< files and folders that are never removed
  bool is_concurrent = false;          ///< several processes may write to the directory at the same time
};

/// Marker file of an incomplete directory; it exists from the start until everything else is written.
std::filesystem::path incomplete_marker(const std::filesystem::path& root);

/// Lock on a directory's marker, held by this process until the object is destroyed or the process ends. It is a record
/// lock of fcntl: not inherited by forked processes, and without effect within one process.
class OutputLock {
 public:
  OutputLock() = default;
  explicit OutputLock(int descriptor) : descriptor_(descriptor) {}
  ~OutputLock();
  OutputLock(const OutputLock&) = delete;
  OutputLock& operator=(const OutputLock&) = delete;
  OutputLock(OutputLock&& other) noexcept : descriptor_(other.descriptor_) { other.descriptor_ = -1; }
  OutputLock& operator=(OutputLock&& other) noexcept;

 private:
  int descriptor_ = -1;
};

/// Creates the directory, locks it unless `kind.is_concurrent`, marks it incomplete, and removes the regular files of
/// an earlier command of this kind. Throws InputError, and leaves the directory unchanged, if it contains other
/// entries, if another process writes to it, or if it is not writable. Other entries are unknown names, links, a folder
/// or a device in place of a file, or files of these names without the required file.
[[nodiscard]] OutputLock begin_output(const std::filesystem::path& root, const OutputKind& kind);

/// Removes the marker: the directory is complete.
void complete_output(const std::filesystem::path& root);

}  // namespace patrol::app
