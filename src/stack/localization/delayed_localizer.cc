#include "stack/localization/delayed_localizer.h"

namespace patrol::stack {

DelayedLocalizer::DelayedLocalizer(std::unique_ptr<Localizer> localizer, Time delay, bool has_thread)
    : localizer_(std::move(localizer)),
      delay_(delay),
      worker_(std::make_unique<BackgroundWorker>(has_thread && localizer_->is_mapping())) {}

void DelayedLocalizer::begin_update(const LevelScan& scan, const Pose2& T_odom_body, Time received) {
  Pending& pending =
      pending_.emplace_back(Pending{.ticket = 0,
                                    .correction = std::make_unique<PoseCorrection>(PoseCorrection{
                                        .due = received, .stamp = scan.stamp, .T_odom_body = T_odom_body})});
  PoseCorrection& correction = *pending.correction;
  if (is_mapping()) correction.due += delay_;
  pending.ticket = execute([localizer = localizer_.get(), &correction, scan] {
    correction.estimate = localizer->update(scan, correction.T_odom_body, correction.output);
  });
}

std::optional<PoseCorrection> DelayedLocalizer::take_due(Time now) {
  if (pending_.empty() || pending_.front().correction->due > now) return std::nullopt;
  const Pending next = std::move(pending_.front());
  pending_.pop_front();
  worker_->wait(next.ticket);
  return std::move(*next.correction);
}

Localizer& DelayedLocalizer::wait() {
  worker_->wait(last_ticket_);
  return *localizer_;
}

/// The worker computes SLAM only: a localizer on a given map is faster than the change of threads.
BackgroundWorker::Ticket DelayedLocalizer::execute(std::function<void()> task) {
  if (is_mapping()) return last_ticket_ = worker_->submit(std::move(task));
  task();
  return 0;
}

}  // namespace patrol::stack
