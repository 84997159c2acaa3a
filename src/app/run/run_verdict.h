#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "app/common/exit_code.h"
#include "app/run/run_loop.h"
#include "app/scoring/expectations.h"
#include "core/named_table.h"
#include "io/json/metrics_json.h"

namespace patrol::app {

/// Event declared by a scenario: a fault or a kidnap.
struct InjectedEvent {
  std::string name;  ///< "fault imu freeze at 12 s"
  bool was_triggered = false;

  /// Returns whether it is a fault, not a kidnap.
  bool is_fault() const { return name.starts_with("fault "); }
};

/// Status of a completed run.
enum class RunStatus : std::uint8_t {
  kDone,
  kExpectationMissed,
  kFall,
  kTimeLimit,
  kWrongInput,
  kFailed,
  kCrashed,
  kWallTimeLimit,
  kStackFailed,
  kStackSilent
};

/// Row of the table of run statuses.
struct RunStatusRow {
  RunStatus value;
  std::string_view name;     ///< text in stored results, tables and reports
  std::string_view summary;  ///< one line of documentation
  ExitCode code;
};

inline constexpr std::array kRunStatuses = std::to_array<RunStatusRow>({
    {RunStatus::kDone, "done", "The run ended and every expectation was met", ExitCode::kDone},
    {RunStatus::kExpectationMissed, "expectation missed", "The run ended and an expectation was missed",
     ExitCode::kExpectationMissed},
    {RunStatus::kFall, "fall", "The robot fell", ExitCode::kExpectationMissed},
    {RunStatus::kTimeLimit, "time limit", "The simulated time reached its limit", ExitCode::kTimeLimit},
    {RunStatus::kWrongInput, "wrong input", "No score: the scenario or one of its files is invalid",
     ExitCode::kWrongInput},
    {RunStatus::kFailed, "failed", "No score: the simulation or the program failed", ExitCode::kProgramFailed},
    {RunStatus::kCrashed, "crashed", "No score: the process of the run crashed", ExitCode::kProgramFailed},
    {RunStatus::kWallTimeLimit, "wall time limit", "No score: the process of the run reached its wall-clock timeout",
     ExitCode::kTimeLimit},
    {RunStatus::kStackFailed, "stack failed", "The stack in another process ended or violated the protocol",
     ExitCode::kProgramFailed},
    {RunStatus::kStackSilent, "stack silent", "The stack in another process did not answer within stack.timeout_s",
     ExitCode::kTimeLimit},
});
static_assert(is_in_order(kRunStatuses));

constexpr std::string_view name_of(RunStatus status) { return row_of(kRunStatuses, status).name; }
constexpr ExitCode exit_code_of(RunStatus status) { return row_of(kRunStatuses, status).code; }
/// Returns whether a run with this status was cut off by a failure or a wall-clock limit: its metrics are those of a
/// part of the mission.
constexpr bool is_failure(RunStatus status) { return status > RunStatus::kTimeLimit; }

/// Result of a run.
struct RunVerdict {
  RunStatus end = RunStatus::kDone;
  std::string message;  ///< reason for a status other than kDone, one line
  io::Metrics metrics;  ///< metrics.json; empty for a run without a score
  std::vector<CheckedExpectation> checks;
  std::vector<InjectedEvent> events;

  ExitCode code() const { return exit_code_of(end); }
};

/// Name of a fault in junit.xml: "fault imu freeze at 12 s".
std::string name_of(const sim::FaultSettings& fault);
/// Name of a kidnap in junit.xml.
std::string name_of(const KidnapSettings& kidnap);

/// Status of a run with a score. A fall and a time limit precede the expectations that are missed because of them.
RunStatus status_of(RunEnd end, const std::vector<CheckedExpectation>& checks);

/// Verdict of a completed run. `kidnaps` are those declared.
RunVerdict verdict_of(const RunOutcome& outcome, const std::vector<KidnapSettings>& kidnaps, io::Metrics metrics,
                      std::vector<CheckedExpectation> checks);

/// Description of a missed expectation: "pose.ate_rmse_m is 0.2, expected <= 0.1".
std::string describe_missed(const CheckedExpectation& check);

io::Metrics to_json(const RunVerdict& verdict);
/// Throws std::exception if `json` is not a verdict.
RunVerdict verdict_from_json(const io::Metrics& json);

}  // namespace patrol::app
