#include <chrono>
#include <thread>

#include <fmt/format.h>

#include "app/cli/commands.h"
#include "app/monitor/delivery.h"
#include "app/common/process_cost.h"
#include "app/common/progress_bar.h"
#include "core/error.h"

namespace patrol::app {

ExitCode upload_command(const UploadOptions& options) {
  if (!std::filesystem::exists(options.run / "outbox.jsonl")) throw InputError(fmt::format("{}: has no results to send: there is no outbox.jsonl", options.run.string()));
  Outbox outbox(options.run);
  Sender sender(outbox, platform_from(options.to, options.token_file));
  const std::size_t num_refused = outbox.num_refused(), num_before = outbox.num_waiting();
  const InterruptGuard interrupt;
  ProgressBar bar;

  double progress_s = wall_seconds();
  for (auto outcome = Sender::Outcome::kSent; outcome != Sender::Outcome::kEmpty;) {
    outcome = sender.send_next();
    if (outcome == Sender::Outcome::kSent) {
      progress_s = wall_seconds();
      bar.show(fmt::format("sending: {} of {} results wait", outbox.num_waiting(), num_before));
    } else if (outcome == Sender::Outcome::kRefusedToken) {
      throw InputError(fmt::format("{}: {}", options.to, sender.why()));
    } else if (outcome == Sender::Outcome::kUnreachable) {
      if (interrupt.is_interrupted() || wall_seconds() - progress_s > options.limit_s) break;
      std::this_thread::sleep_for(std::chrono::milliseconds(500));
    }
    if (interrupt.is_interrupted()) break;
  }

  const std::size_t waiting = outbox.num_waiting(), refused = outbox.num_refused() - num_refused;
  if (refused > 0) fmt::print(stderr, "patrol: {} refused {} results: they lie in {}\n", options.to, refused, (options.run / "outbox.refused.jsonl").string());
  if (waiting > 0) {
    fmt::print(stderr, "patrol: {} results still wait in {}: {}\n", waiting, outbox.file().string(), sender.why());
    return ExitCode::kProgramFailed;
  }
  fmt::print("sent: {} results to {}\n", num_before - refused, options.to);
  return ExitCode::kDone;
}

}  // namespace patrol::app
