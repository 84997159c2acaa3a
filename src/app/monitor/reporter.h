#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "app/monitor/delivery.h"
#include "app/record/outbox.h"
#include "app/run/run_loop.h"

namespace patrol::app {

/// Identification of a run on the monitoring server.
struct ReportedRun {
  std::string robot;
  std::string run;  ///< unique name of the run
  std::string world;
  std::string scenario;
};

/// Unique name of a run: "short-seed1-20261122T104533Z-9f3c".
std::string new_run_name(const std::string& scenario, std::uint64_t seed);

struct ReporterSettings {
  double pose_period_s = 1.0;     ///< simulated
  double map_period_s = 10.0;     ///< simulated; an unchanged map is not sent again
  double drain_timeout_s = 10.0;  ///< time limit at the end of the run for pending results
};

/// Observer that reports messages of the robot's stack to the monitoring server. Ground truth is ignored. Does not
/// influence the run.
class Reporter final : public RunObserver {
 public:
  /// `root`: folder of the outbox, written from `begin` on.
  Reporter(std::filesystem::path root, ReportedRun run, MonitorServer server, const ReporterSettings& settings = {});

  void begin(const ScenarioFiles& files) override;
  void on_message(const stack::StackMessage& message) override;
  void on_ground_truth(const GroundTruth&) override {}
  bool keep_running(Time, double) override { return true; }

  /// Reports the end of the run: "finished", "failed" or "interrupted", with a message. Waits for the upload, within
  /// the limit.
  void finish(const std::string& state, const std::string& message);

  std::size_t num_results() const { return static_cast<std::size_t>(sequence_); }
  std::size_t num_pending() const { return outbox_ ? outbox_->num_pending() : 0; }
  std::size_t num_rejected() const { return outbox_ ? outbox_->num_rejected() : 0; }
  /// Reason why pending results were not delivered.
  std::string last_error() const { return delivery_ ? delivery_->last_error() : ""; }

 private:
  void report(Time stamp, const char* kind, std::string data);
  void report_map(const MapUpdate& update);
  void report_status(const char* state, const std::string& message, const std::string& stations);

  std::filesystem::path root_;
  ReportedRun run_;
  MonitorServer server_;
  ReporterSettings settings_;
  std::unique_ptr<Outbox> outbox_;
  std::unique_ptr<Delivery> delivery_;
  std::int64_t sequence_ = 0;
  Time newest_{};
  Time next_pose_{}, next_map_{};
  OccupancyGrid last_sent_map_;
  std::optional<MapUpdate> pending_map_;
};

}  // namespace patrol::app
