#include "io/files/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "core/error.h"
#include "io/files/bounded_read.h"
#include "io/files/output_error.h"

namespace patrol::io {
namespace {

/// Descriptor of a file opened for reading; negative on failure. Opening a pipe does not wait for a writer.
class InputFile {
 public:
  explicit InputFile(const std::filesystem::path& file)
      : descriptor_(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {}
  ~InputFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  int descriptor() const { return descriptor_; }

 private:
  int descriptor_;
};

}  // namespace

void save_text(const std::filesystem::path& file, std::string_view text) {
  // Use a name that is unique to the process: other processes may write the same file.
  const std::filesystem::path temporary = file.string() + "." + std::to_string(::getpid()) + ".part";
  errno = 0;
  std::ofstream out(temporary, std::ios::binary | std::ios::trunc);
  const bool is_open = out.is_open();
  out << text << std::flush;
  const int cause = errno;
  out.close();
  std::error_code error;
  if (out) std::filesystem::rename(temporary, file, error);
  if (!out || error) {
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    if (!out && (is_open || is_out_of_space(cause))) {
      throw OutputError(
          fmt::format("{}: cannot be written: {}", file.string(), std::strerror(cause != 0 ? cause : EIO)));
    }
    throw InputError(file.string() + ": cannot be written");
  }
}

std::string load_text(const std::filesystem::path& file) { return load_text(file, kMaxFileBytes); }

std::string load_text(const std::filesystem::path& file, std::uintmax_t max_bytes) {
  const auto refuse = [&](const std::string& what) { return InputError(file.string() + ": " + what); };
  const InputFile in(file);
  if (in.descriptor() < 0) {
    const bool is_missing = errno == ENOENT || errno == ENOTDIR;
    throw refuse(is_missing ? "file not found" : fmt::format("cannot be read: {}", std::strerror(errno)));
  }
  struct stat status {};
  if (::fstat(in.descriptor(), &status) != 0) throw refuse("cannot be read");
  if (!S_ISREG(status.st_mode)) throw refuse("cannot be read: is not a regular file");
  const std::string too_large = fmt::format("is too large: at most {} bytes are read", max_bytes);
  if (static_cast<std::uintmax_t>(status.st_size) > max_bytes) throw refuse(too_large);

  std::string text;
  std::vector<char> block(std::size_t{1} << 16);
  text.reserve(static_cast<std::size_t>(status.st_size));
  for (ssize_t count = 0; (count = ::read(in.descriptor(), block.data(), block.size())) != 0;) {
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw refuse(fmt::format("cannot be read: {}", std::strerror(errno)));
    text.append(block.data(), static_cast<std::size_t>(count));
    // files in /proc have size 0, and files may grow while they are read
    if (text.size() > max_bytes) throw refuse(too_large);
  }
  return text;
}

}  // namespace patrol::io
