#pragma once

#include <string>
#include <vector>

#include "app/exit_code.h"
#include "app/run/run_loop.h"
#include "app/scoring/expectations.h"
#include "io/metrics_json.h"

namespace patrol::app {

/// Something that a scenario declares to happen: a fault, a kidnap.
struct DeclaredEvent {
  std::string what;          ///< "fault imu freeze at 12 s"
  bool is_executed = false;
};

/// What became of a run.
struct RunVerdict {
  std::string end;      ///< "done", "expectation missed", "fall", "time limit"; of a run that came to no score "wrong input", "failed", "crashed",
                        ///< "wall time limit"
  ExitCode code = ExitCode::kDone;
  std::string message;  ///< why it is not done: one line
  io::Metrics metrics;  ///< metrics.json; empty for a run that came to no score
  std::vector<CheckedExpectation> checks;
  std::vector<DeclaredEvent> events;
};

/// How junit.xml names what was declared: "fault imu freeze at 12 s".
std::string name_of(const sim::FaultSettings& fault);
std::string name_of(const KidnapSettings& kidnap);

/// Of a run that came to its end. `kidnaps` are those declared.
RunVerdict verdict_of(const RunOutcome& outcome, const std::vector<KidnapSettings>& kidnaps, io::Metrics metrics,
                      std::vector<CheckedExpectation> checks);

/// How a missed expectation is said: "pose.ate_rmse_m is 0.2, expected <= 0.1".
std::string missed(const CheckedExpectation& check);

io::Metrics to_json(const RunVerdict& verdict);
/// Throws std::exception when it is not one.
RunVerdict verdict_from_json(const io::Metrics& json);

}  // namespace patrol::app
