#include "app/campaign/batch/work_folder.h"

#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <system_error>

#include <fmt/format.h>

#include "core/error.h"

namespace patrol::app {
namespace {

std::string host_name() {
  std::array<char, 256> name{};
  ::gethostname(name.data(), name.size() - 1);
  return name.data();
}

/// Removes the folders HOST-PID-... of this host that belong to the process `wanted` or to ended processes.
void remove_stale(const std::filesystem::path& folder, const std::string& host, pid_t wanted) {
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(host + "-")) continue;
    pid_t pid = 0;
    std::from_chars(name.data() + host.size() + 1, name.data() + name.size(), pid);
    const bool is_gone = pid > 0 && ::kill(pid, 0) != 0 && errno == ESRCH;
    if (is_gone || pid == wanted) std::filesystem::remove_all(entry.path(), ignored);
  }
}

}  // namespace

WorkFolder::WorkFolder(const std::filesystem::path& root)
    : folder_(root / "work"), prefix_(fmt::format("{}-{}-", host_name(), ::getpid())) {
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  if (error) throw InputError(fmt::format("{}: cannot create the directory: {}", folder_.string(), error.message()));
  remove_stale(folder_, host_name(), ::getpid());
}

WorkFolder::~WorkFolder() {
  remove_stale(folder_, host_name(), ::getpid());
  std::error_code ignored;
  std::filesystem::remove(folder_, ignored);  // fails if another process works in it
}

}  // namespace patrol::app
