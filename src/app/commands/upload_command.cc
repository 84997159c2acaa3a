#include <chrono>
#include <thread>

#include <fmt/format.h>

#include "app/commands/commands.h"
#include "app/common/process_cost.h"
#include "app/common/progress_bar.h"
#include "app/monitor/delivery.h"
#include "core/error.h"

namespace patrol::app {

ExitCode upload_command(const UploadOptions& options) {
  if (!std::filesystem::exists(options.run / "outbox.jsonl"))
    throw InputError(fmt::format("{}: no results to upload: outbox.jsonl not found", options.run.string()));
  Outbox outbox(options.run);
  Sender sender(outbox, make_monitor_server(options.monitor_url, options.token_file));
  const std::size_t num_rejected_before = outbox.num_rejected(), num_before = outbox.num_pending();
  const InterruptGuard interrupt;
  ProgressBar bar;

  double progress_s = wall_seconds();
  for (auto outcome = Sender::Outcome::kSent; outcome != Sender::Outcome::kEmpty;) {
    outcome = sender.send_next();
    if (outcome == Sender::Outcome::kSent) {
      progress_s = wall_seconds();
      bar.show(fmt::format("uploading: {} of {} results pending", outbox.num_pending(), num_before));
    } else if (outcome == Sender::Outcome::kInvalidToken) {
      throw InputError(fmt::format("{}: {}", options.monitor_url, sender.last_error()));
    } else if (outcome == Sender::Outcome::kUnreachable) {
      if (interrupt.is_interrupted() || wall_seconds() - progress_s > options.timeout_s) break;
      std::this_thread::sleep_for(std::chrono::milliseconds(500));
    }
    if (interrupt.is_interrupted()) break;
  }

  const std::size_t num_pending = outbox.num_pending(), num_rejected = outbox.num_rejected() - num_rejected_before;
  if (num_rejected > 0)
    fmt::print(stderr, "patrol: {} rejected {} results, kept in {}\n", options.monitor_url, num_rejected,
               (options.run / "outbox.refused.jsonl").string());
  if (num_pending > 0) {
    fmt::print(stderr, "patrol: {} results pending in {}: {}\n", num_pending, outbox.file().string(),
               sender.last_error());
    return ExitCode::kProgramFailed;
  }
  fmt::print("uploaded: {} results to {}\n", num_before - num_rejected, options.monitor_url);
  return ExitCode::kDone;
}

}  // namespace patrol::app
