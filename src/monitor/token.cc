#include "monitor/token.h"

#include <fcntl.h>
#include <sys/random.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <stdexcept>

#include <fmt/format.h>

#include "core/error.h"
#include "io/files/atomic_file.h"

namespace patrol::monitor {
namespace {

constexpr std::size_t kMinTokenLength = 16;

std::string new_token() {
  std::array<unsigned char, 32> bytes{};
  if (::getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
    throw std::runtime_error("no random bytes available");
  return fmt::format("{:02x}", fmt::join(bytes, ""));
}

}  // namespace

void check_token(const std::string& location, const std::string& token) {
  if (token.size() < kMinTokenLength)
    throw InputError(fmt::format("{}: invalid token: must have at least {} characters", location, kMinTokenLength));
  const bool is_plain = std::all_of(token.begin(), token.end(), [](char c) { return c > 0x20 && c < 0x7f; });
  if (!is_plain)
    throw InputError(
        fmt::format("{}: invalid token: must consist of printable ASCII characters without spaces", location));
}

std::string load_token(const std::filesystem::path& file) {
  std::string token = io::load_text(file);
  token.erase(std::min(token.find_first_of("\r\n"), token.size()));
  check_token(file.string(), token);
  return token;
}

std::string load_or_create_token(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "token";
  if (std::filesystem::exists(file)) return load_token(file);
  std::string token = new_token();
  const std::string line = token + "\n";
  const std::filesystem::path temporary = folder / "token.part";
  ::unlink(temporary.c_str());  // a remaining file may have another owner or mode
  const int out = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  const bool is_written =
      out >= 0 && ::write(out, line.data(), line.size()) == static_cast<ssize_t>(line.size()) && ::fsync(out) == 0;
  if (out >= 0) ::close(out);
  if (!is_written) throw InputError(fmt::format("{}: cannot write", file.string()));
  std::filesystem::rename(temporary, file);
  return token;
}

bool is_same_token(std::string_view a, std::string_view b) {
  unsigned difference = a.size() == b.size() ? 0U : 1U;
  for (std::size_t i = 0; i < a.size() && !b.empty(); ++i)
    difference |= static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i % b.size()]);
  return difference == 0 && !b.empty();
}

}  // namespace patrol::monitor
