#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "app/monitor/delivery.h"
#include "app/monitor/outbox.h"
#include "app/run/run_loop.h"

namespace patrol::app {

/// Who reports, and from where.
struct ReportedRun {
  std::string robot;
  std::string run;       ///< of this run alone
  std::string world;
  std::string scenario;
};

/// "short-seed1-20261122T104533Z-9f3c": two runs never have the same.
std::string new_run_name(const std::string& scenario, std::uint64_t seed);

struct ReporterSettings {
  double pose_period_s = 1.0;   ///< simulated
  double map_period_s = 10.0;   ///< simulated; a map that has not changed is not sent again
  double drain_limit_s = 10.0;  ///< at the end of the run, for what has not been delivered
};

/// Tells the monitoring platform what the robot's own software says, and nothing else: the ground truth passes by. Nothing of it comes
/// back into the run.
class Reporter final : public RunObserver {
 public:
  /// Writes into `root` from `begin` on.
  Reporter(std::filesystem::path root, ReportedRun run, Platform platform, const ReporterSettings& settings = {});

  void begin(const ScenarioFiles& files) override;
  void see(const stack::StackMessage& message) override;
  void see(const GroundTruth&) override {}
  bool go_on(Time, double) override { return true; }

  /// The run has ended: "finished", "failed" or "interrupted", and what became of it. Waits for the delivery, within the limit.
  void finish(const std::string& state, const std::string& message);

  std::size_t num_results() const { return static_cast<std::size_t>(sequence_); }
  std::size_t num_waiting() const { return outbox_ ? outbox_->num_waiting() : 0; }
  std::size_t num_refused() const { return outbox_ ? outbox_->num_refused() : 0; }
  /// Why what waits could not be delivered.
  std::string why_not() const { return delivery_ ? delivery_->why_not() : ""; }

 private:
  void tell(Time stamp, const char* kind, std::string data);
  void tell_map(const MapUpdate& update);
  void tell_status(const char* state, const std::string& message, std::string stations);

  std::filesystem::path root_;
  ReportedRun run_;
  Platform platform_;
  ReporterSettings settings_;
  std::unique_ptr<Outbox> outbox_;
  std::unique_ptr<Delivery> delivery_;
  std::int64_t sequence_ = 0;
  Time newest_{};
  Time next_pose_{}, next_map_{};
  OccupancyGrid told_map_;
  std::optional<MapUpdate> untold_map_;
};

}  // namespace patrol::app
