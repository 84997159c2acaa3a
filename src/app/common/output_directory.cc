#include "app/common/output_directory.h"

#include <fcntl.h>
#include <fnmatch.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "io/files/output_error.h"

namespace patrol::app {
namespace {

/// Output of an earlier command: files, and the folders around them, outer ones first.
struct EarlierOutput {
  std::vector<std::filesystem::path> files;
  std::vector<std::filesystem::path> folders;
};

bool is_among(const std::string& name, const std::vector<std::string>& patterns) {
  return std::any_of(patterns.begin(), patterns.end(),
                     [&](const std::string& pattern) { return ::fnmatch(pattern.c_str(), name.c_str(), 0) == 0; });
}

/// Whether files below the folder can match one of `patterns`.
bool is_folder_of(const std::string& name, const std::vector<std::string>& patterns) {
  const std::string top = name.substr(0, name.find('/')) + "/";
  return std::any_of(patterns.begin(), patterns.end(),
                     [&](const std::string& pattern) { return pattern.starts_with(top); });
}

[[noreturn]] void throw_cannot_write(const std::filesystem::path& root, int error) {
  const std::string text = fmt::format("{}: cannot write: {}", root.string(), std::strerror(error));
  if (io::is_out_of_space(error)) throw io::OutputError(text);
  throw InputError(text);
}

/// Lists the entries that may be removed. Throws InputError if there are any others.
EarlierOutput earlier_output(const std::filesystem::path& root, const OutputKind& kind) {
  EarlierOutput earlier;
  std::error_code error;
  std::filesystem::recursive_directory_iterator entry(root, error);
  for (; !error && entry != std::filesystem::recursive_directory_iterator(); entry.increment(error)) {
    const std::string name = entry->path().lexically_relative(root).generic_string();
    const std::filesystem::file_type type = entry->symlink_status().type();
    if (type == std::filesystem::file_type::not_found) continue;  // removed by another process
    if (entry.depth() == 0 && is_among(name, kind.preserved)) {
      entry.disable_recursion_pending();
    } else if (type == std::filesystem::file_type::directory && is_folder_of(name, kind.outputs)) {
      earlier.folders.push_back(entry->path());
    } else if (type == std::filesystem::file_type::regular && is_among(name, kind.outputs)) {
      earlier.files.push_back(entry->path());
    } else if (entry->path() != incomplete_marker(root)) {  // checked when it is opened
      throw InputError(
          fmt::format("{}: contains '{}', which is not an output of '{}'; choose an empty or new directory",
                      root.string(), name, kind.name));
    }
  }
  if (error) throw InputError(fmt::format("{}: cannot read: {}", root.string(), error.message()));
  const auto exists = [&](const std::filesystem::path& file) {
    return std::filesystem::is_regular_file(std::filesystem::symlink_status(file));
  };
  if (!earlier.files.empty() && !exists(incomplete_marker(root)) && !exists(root / kind.required_file)) {
    throw InputError(fmt::format("{}: contains {}, but no {} of an earlier {}; choose an empty or new directory",
                                 root.string(), earlier.files.front().lexically_relative(root).generic_string(),
                                 kind.required_file, kind.name));
  }
  return earlier;
}

/// Opens the marker for writing. Throws InputError if it is a link or not a plain file of one name.
OutputLock open_marker(const std::filesystem::path& root, int& descriptor) {
  const std::filesystem::path marker = incomplete_marker(root);
  descriptor = ::open(marker.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, 0666);
  if (descriptor < 0 && errno != ELOOP && errno != EISDIR && errno != ENXIO) throw_cannot_write(root, errno);
  OutputLock lock(descriptor);
  struct stat status {};
  const bool is_plain =
      descriptor >= 0 && ::fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode) && status.st_nlink <= 1;
  if (!is_plain)
    throw InputError(fmt::format("{}: must be a regular file; remove it or choose another directory", marker.string()));
  return lock;
}

/// Whether the open marker still has its name; the process that held it may have removed it.
bool has_marker_name(const std::filesystem::path& root, int descriptor) {
  struct stat opened {
  }, named{};
  return ::fstat(descriptor, &opened) == 0 && ::lstat(incomplete_marker(root).c_str(), &named) == 0 &&
         opened.st_dev == named.st_dev && opened.st_ino == named.st_ino;
}

/// Opens the marker, and locks it unless it is shared. The lock of a killed process is released by the system.
OutputLock take_marker(const std::filesystem::path& root, const OutputKind& kind, int& descriptor) {
  constexpr int kMaxTries = 100;
  for (int i = 0; i < kMaxTries; ++i) {
    OutputLock lock = open_marker(root, descriptor);
    if (kind.is_concurrent) return lock;
    struct flock whole {};
    whole.l_type = F_WRLCK;
    whole.l_whence = SEEK_SET;
    if (::fcntl(descriptor, F_SETLK, &whole) != 0) {
      if (errno != EACCES && errno != EAGAIN) throw_cannot_write(root, errno);
      throw InputError(fmt::format("{}: in use by another process that writes a {}; wait or choose another directory",
                                   root.string(), kind.name));
    }
    if (has_marker_name(root, descriptor)) return lock;
  }
  throw InputError(fmt::format("{}: in use by other processes; choose another directory", root.string()));
}

void write_marker(const std::filesystem::path& root, const OutputKind& kind, int descriptor) {
  const std::string text = kind.marker_text + "\n";
  const bool is_written = ::ftruncate(descriptor, 0) == 0 &&
                          ::pwrite(descriptor, text.data(), text.size(), 0) == static_cast<ssize_t>(text.size());
  if (!is_written) throw_cannot_write(root, errno);
}

}  // namespace

OutputLock::~OutputLock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

OutputLock& OutputLock::operator=(OutputLock&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  return *this;
}

std::filesystem::path incomplete_marker(const std::filesystem::path& root) { return root / "INCOMPLETE"; }

OutputLock begin_output(const std::filesystem::path& root, const OutputKind& kind) {
  std::error_code error;
  if (root.empty()) throw InputError(fmt::format("--out: is empty: must name a directory for the {}", kind.name));
  std::filesystem::create_directories(root, error);
  if (error && io::is_out_of_space(error.value())) throw_cannot_write(root, error.value());
  if (error) throw InputError(fmt::format("{}: cannot create the directory: {}", root.string(), error.message()));
  earlier_output(root, kind);  // throws before anything is written
  int descriptor = -1;
  OutputLock lock = take_marker(root, kind, descriptor);
  write_marker(root, kind, descriptor);
  const EarlierOutput earlier = earlier_output(root, kind);  // again, now under the lock
  for (const std::filesystem::path& file : earlier.files) std::filesystem::remove(file, error);
  std::for_each(earlier.folders.rbegin(), earlier.folders.rend(),
                [&](const std::filesystem::path& folder) { std::filesystem::remove(folder, error); });
  return lock;
}

void complete_output(const std::filesystem::path& root) { std::filesystem::remove(incomplete_marker(root)); }

}  // namespace patrol::app
