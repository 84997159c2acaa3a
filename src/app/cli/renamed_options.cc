#include "app/cli/renamed_options.h"

#include <array>
#include <string_view>

#include <fmt/format.h>

#include "core/error.h"

namespace patrol::app {
namespace {

struct RenamedCommand {
  std::string_view before;
  std::string_view now;
};

constexpr auto kRenamedCommands = std::to_array<RenamedCommand>({
    {"collect", "merge"},
    {"send", "upload"},
    {"train-neighbours", "train-neighbors"},
});

struct RenamedOption {
  std::string_view command;  ///< present name of the command; empty for all commands
  std::string_view before;
  std::string_view now;
};

constexpr auto kRenamedOptions = std::to_array<RenamedOption>({
    {"run", "--report-to", "--monitor-url"},
    {"run", "--report-token-file", "--monitor-token-file"},
    {"score", "--max-dt", "--max-dt-s"},
    {"score", "--ref-x", "--reference-x-m"},
    {"localizability", "--step-m", "--grid-step-m"},
    {"replay", "--cut", "--style (story: highlights, plain: continuous)"},
    {"replay", "--slow", "--highlight-speed"},
    {"sweep", "--stop-when-decided", "--early-stop"},
    {"sweep", "--margin", "--equivalence-margin"},
    {"", "--run-limit-s", "--run-timeout-s"},
    {"", "--keep", "--keep-runs"},
    {"", "--skip-bad-lines", "--skip-invalid"},
    {"train-neighbors", "--held-out", "--validation"},
    {"solve", "--doubt-loops", "--robust-loops"},
    {"monitor", "--data", "--data-dir"},
    {"monitor", "--token", "--token-file"},
    {"upload", "--to", "--monitor-url"},
    {"upload", "--token", "--token-file"},
    {"upload", "--limit-s", "--timeout-s"},
});

}  // namespace

void refuse_renamed(int argc, const char* const* argv) {
  if (argc < 2) return;
  const std::string_view command = argv[1];
  for (const RenamedCommand& renamed : kRenamedCommands) {
    if (renamed.before == command) throw InputError(fmt::format("{}: renamed to {}", command, renamed.now));
  }
  for (int i = 2; i < argc; ++i) {
    const std::string_view word = argv[i];
    const std::string_view option = word.substr(0, word.find('='));
    if (word == "--") return;
    for (const RenamedOption& renamed : kRenamedOptions) {
      if (renamed.before != option || !(renamed.command.empty() || renamed.command == command)) continue;
      throw InputError(fmt::format("{}: renamed to {}", option, renamed.now));
    }
  }
}

}  // namespace patrol::app
