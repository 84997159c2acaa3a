#include "link/shared_core.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

namespace patrol::link {

SharedCore::SharedCore(pid_t process)
    : file_(process > 0 ? ::open(fmt::format("/proc/{0}/task/{0}/stat", process).c_str(), O_RDONLY | O_CLOEXEC) : -1) {}

SharedCore::~SharedCore() {
  if (file_ >= 0) ::close(file_);
}

bool SharedCore::bind() {
  const std::optional<std::size_t> core = read_core();
  if (!core || ::sched_getaffinity(0, sizeof(cores_), &cores_) != 0 || !CPU_ISSET(*core, &cores_)) return false;
  cpu_set_t one{};
  CPU_SET(*core, &one);
  return ::sched_setaffinity(0, sizeof(one), &one) == 0;
}

void SharedCore::release() { ::sched_setaffinity(0, sizeof(cores_), &cores_); }

/// Returns the core on which the thread runs, or ran last.
std::optional<std::size_t> SharedCore::read_core() const {
  if (file_ < 0) return std::nullopt;
  constexpr int kFieldsToCore = 37;  // from the state, which follows the name in parentheses
  std::array<char, 1024> text{};
  const ssize_t size = ::pread(file_, text.data(), text.size(), 0);
  std::string_view rest(text.data(), size > 0 ? static_cast<std::size_t>(size) : 0);
  rest.remove_prefix(std::min(rest.rfind(')'), rest.size()));
  for (int field = 0; field < kFieldsToCore && !rest.empty(); ++field)
    rest.remove_prefix(std::min(rest.find(' ') + 1, rest.size()));
  std::size_t core = 0;
  const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), core);
  return error == std::errc() && core < CPU_SETSIZE ? std::optional(core) : std::nullopt;
}

}  // namespace patrol::link
