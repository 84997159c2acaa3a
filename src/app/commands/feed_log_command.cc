#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "app/commands/commands.h"
#include "app/common/output_directory.h"
#include "app/common/print_result.h"
#include "app/common/progress_bar.h"
#include "app/mapping/feed_messages.h"
#include "app/mapping/feed_scans.h"
#include "app/mapping/log_documents.h"
#include "app/mapping/log_mapping.h"
#include "app/mapping/mapping_stack.h"
#include "app/run/external_stack.h"
#include "app/run/run_verdict.h"
#include "app/scoring/relation_table.h"
#include "app/scoring/score_run.h"
#include "app/scoring/score_table.h"
#include "core/error.h"
#include "io/json/metrics_json.h"
#include "io/logs/scan_log.h"
#include "io/maps/map_server.h"
#include "io/trajectories/relations.h"
#include "io/trajectories/tum.h"
#include "io/yaml/settings_yaml.h"

namespace patrol::app {
namespace {

const OutputKind kFedLog = {.name = "fed log",
                            .marker_text = "The log is not completely fed.",
                            .outputs = {"log.mcap", "stack.log", "estimate.tum", "online.tum", "map.yaml", "map.pgm",
                                        "metrics.json", "settings.yaml"},
                            .required_file = "settings.yaml",
                            .preserved = {"*.part"}};

/// Connection to a stack that is fed with a recorded log.
struct FedStackSettings {
  double timeout_s = stack::StackSettings{}.timeout_s;  ///< limit of the wall time that the stack takes for a turn
  double memory_limit_mb = 0.0;  ///< limit of the memory of a stack that is started by its command; 0: none
  bool allow_network = false;    ///< permission for an address that other machines reach

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("timeout_s", self.timeout_s, between(0.1, 86400.0));
    visit("memory_limit_mb", self.memory_limit_mb, at_least(0.0));
    visit("allow_network", self.allow_network);
  }
};

/// Settings of `patrol feed LOG --set`: those of `patrol slam`, and the connection.
struct LogFeedSettings {
  LogMappingSettings mapping;
  FedStackSettings stack;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    LogMappingSettings::fields(self.mapping, visit);
    visit("stack", self.stack);
  }
};

/// Settings of `patrol feed LOG --as-recorded --set`.
struct RecordedFeedSettings {
  FedStackSettings stack;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("stack", self.stack);
  }
};

std::unique_ptr<StackPort> connect_stack(const FeedOptions& options, const FedStackSettings& settings,
                                         const InterruptGuard& guard, StackDocuments documents) {
  stack::StackSettings connection;
  connection.timeout_s = settings.timeout_s;
  connection.memory_limit_mb = settings.memory_limit_mb;
  connection.allow_network = settings.allow_network;
  return std::make_unique<ExternalStack>(std::move(documents),
                                         StackConnection{.command = *options.stack,
                                                         .output = options.out / "stack.log",
                                                         .is_interrupted = [&] { return guard.is_interrupted(); }},
                                         connection);
}

std::unique_ptr<StackPort> make_stack_of_log(const FeedOptions& options, const LogFeedSettings& settings,
                                             const InterruptGuard& guard, const io::TransformSet& mounts) {
  if (!options.stack) return std::make_unique<MappingStack>(settings.mapping, mounts);
  return connect_stack(options, settings.stack, guard,
                       log_documents(options.input.filename().string(), settings.mapping, mounts));
}

/// Poses that a stack published, with their errors.
struct FedEstimate {
  std::string topic;
  std::size_t num_poses = 0;
  std::string why_not_scored;  ///< empty: scored by all references
  std::optional<score::RelationError> relations;
  io::Metrics reference;  ///< null: not scored by a reference trajectory

  io::Metrics metrics() const {
    io::Metrics metrics{{"topic", topic}, {"poses", num_poses}};
    if (relations) metrics["relations"] = relation_json(*relations);
    if (!reference.is_null()) metrics["reference"] = reference;
    if (!why_not_scored.empty()) metrics["not_scored"] = why_not_scored;
    return metrics;
  }
  std::string text() const {
    return fmt::format("\n{}: {} poses\n{}{}{}", topic, num_poses, relations ? relation_table(*relations) : "",
                       reference.is_null() ? "" : score_table(reference, {}),
                       why_not_scored.empty() ? "" : fmt::format("not scored: {}\n", why_not_scored));
  }
};

/// References of a recorded log.
struct LogReferences {
  std::optional<std::vector<PoseRelation>> relations;
  std::optional<Trajectory> trajectory;
};

LogReferences load_references(const FeedOptions& options) {
  validate(options.association.of_relations(), "relations");
  LogReferences references;
  if (!options.relations.empty()) references.relations = io::load_relations(options.relations);
  if (!options.reference.empty()) references.trajectory = io::load_tum(options.reference);
  return references;
}

/// Saves poses and scores them as `patrol score` does; none if there are no poses.
std::optional<FedEstimate> score_estimate(const FeedOptions& options, const LogReferences& references,
                                          const std::string& file, const std::string& topic,
                                          std::vector<StampedPose> poses) {
  if (poses.empty()) return std::nullopt;
  std::ranges::stable_sort(poses, {}, &StampedPose::stamp);
  io::save_tum(options.out / file, poses, "T_map_body on " + topic);
  FedEstimate estimate{
      .topic = topic, .num_poses = poses.size(), .why_not_scored = {}, .relations = {}, .reference = nullptr};
  const Trajectory trajectory = io::load_tum(options.out / file, io::SameStamps::kKeepFirst);
  try {
    if (references.relations)
      estimate.relations = score::relation_error(trajectory, *references.relations, options.association.of_relations());
    if (references.trajectory)
      estimate.reference = score_trajectories(trajectory, *references.trajectory, options.association.of_reference());
  } catch (const InputError& error) {  // too few poses, or none at the times of the reference
    estimate.why_not_scored = error.what();
  }
  return estimate;
}

/// Refuses files of the output directory, which would be removed before they are read.
void check_output(const FeedOptions& options) {
  for (const std::filesystem::path& file : {options.input, options.relations, options.reference}) {
    if (!file.empty() &&
        std::filesystem::weakly_canonical(file).parent_path() == std::filesystem::weakly_canonical(options.out))
      throw InputError(fmt::format("--out = {}: must not be the directory of {}", options.out.string(), file.string()));
  }
}

std::string feeding_text(const FeedOptions& options, const RunOutcome& outcome) {
  return fmt::format("fed to {} in {:.1f} s ({:.0f} times real time)\n", options.stack.value_or("the built-in mapping"),
                     outcome.wall_s, to_seconds(outcome.duration) / std::max(1e-9, outcome.wall_s));
}

/// Reason why the estimate has no score by the references of the call; empty with a score and without references.
std::string missing_score(const FeedOptions& options, const std::optional<FedEstimate>& estimate, const char* topic) {
  if (options.relations.empty() && options.reference.empty()) return {};
  return estimate ? estimate->why_not_scored : fmt::format("not published: {}", topic);
}

/// Scores the answers of a stack, and completes the directory. `text`: on the log. `log`: its metrics.
ExitCode complete_fed_log(const FeedOptions& options, const LogReferences& references, std::string text,
                          io::Metrics log, const FedAnswers& fed) {
  if (fed.outcome.end == RunEnd::kInterrupted) {
    fmt::print(stderr, "patrol: interrupted; {} is incomplete\n", options.out.string());
    return ExitCode::kProgramFailed;
  }
  if (fed.map) io::save_map(options.out / "map.yaml", *fed.map);
  const RunStatus status = status_of(fed.outcome.end, {});
  log["duration_s"] = to_seconds(fed.outcome.duration);
  io::Metrics metrics{{"status", name_of(status)},
                      {"log", std::move(log)},
                      {"performance", {{"wall_s", fed.outcome.wall_s}, {"cpu_s", fed.outcome.cpu_s}}}};
  text += feeding_text(options, fed.outcome);
  const auto add = [&](const char* name, const char* topic, const std::vector<StampedPose>& poses) -> std::string {
    const std::optional<FedEstimate> estimate =
        score_estimate(options, references, fmt::format("{}.tum", name), topic, poses);
    metrics[name] = estimate ? estimate->metrics() : io::Metrics(nullptr);
    text += estimate ? estimate->text() : fmt::format("\nnot published: {}\n", topic);
    return missing_score(options, estimate, topic);
  };
  std::string unscored;
  if (fed.trajectory.empty()) {
    unscored = add("estimate", io::kTopic<PoseEstimate>, fed.poses);
  } else {
    unscored = add("estimate", io::kTopic<TrajectoryEstimate>, fed.trajectory);
    add("online", io::kTopic<PoseEstimate>, fed.poses);
  }
  if (!fed.outcome.stack_failure.empty()) {
    metrics["message"] = fed.outcome.stack_failure;
    text += fmt::format("\n{}: {}\n", name_of(status), fed.outcome.stack_failure);
  }
  io::save_metrics(options.out / "metrics.json", metrics);
  complete_output(options.out);
  print_result(options.form, text + fmt::format("\n{}\n", options.out.string()), metrics);
  if (unscored.empty()) return exit_code_of(status);
  fmt::print(stderr, "patrol: the estimate is not scored by the reference: {}\n", unscored);
  return worse(exit_code_of(status), ExitCode::kWrongInput);
}

/// Feeds a stack with the scans and the odometry of a log.
ExitCode feed_scans_of_log(const FeedOptions& options) {
  auto settings = io::parse_settings<LogFeedSettings>(options.overrides);
  const LogReferences references = load_references(options);
  check_scans(*io::open_scan_log(options.input, settings.mapping.log), options.input.string());
  const std::unique_ptr<io::ScanLog> log = io::open_scan_log(options.input, settings.mapping.log);
  const std::string adaptation = adapt_to_log(options.input, settings.mapping);

  InterruptGuard guard;
  std::optional<OutputLock> lock;
  const FedAnswers fed = feed_scans(
      *log, options.input.filename().string(),
      [&](const io::TransformSet& mounts) { return make_stack_of_log(options, settings, guard, mounts); },
      [&] {
        lock.emplace(begin_output(options.out, kFedLog));
        io::save_settings(options.out / "settings.yaml", settings);
      },
      options.out / "log.mcap", guard);
  guard.release();  // a signal ends the scoring
  return complete_fed_log(options, references, io::to_text(log->summary()) + (options.stack ? "" : adaptation),
                          {{"scans", log->summary().num_scans}}, fed);
}

std::string text_of(const RecordedMessages& recorded) {
  std::string text = fmt::format("{} messages on {} topics\n", recorded.num_messages, recorded.channels.size());
  for (const auto& [topic, num_messages] : recorded.left_out)
    text += fmt::format("left out: {}: {} messages, not CDR with a ROS 2 message definition\n", topic, num_messages);
  if (!recorded.is_complete) text += "unexpected end of file: read up to the last complete record\n";
  return text;
}

/// Feeds a stack with the messages of an MCAP log.
ExitCode feed_messages_of_log(const FeedOptions& options) {
  if (!options.stack) throw InputError("--as-recorded: needs --stack: the built-in mapping is fed with scans");
  const auto settings = io::parse_settings<RecordedFeedSettings>(options.overrides);
  const LogReferences references = load_references(options);
  const RecordedMessages recorded = find_recorded_messages(options.input);
  StackDocuments documents = log_documents(options.input.filename().string(), {}, {});
  documents.recorded = recorded.channels;

  InterruptGuard guard;
  std::unique_ptr<StackPort> stack = connect_stack(options, settings.stack, guard, std::move(documents));
  const OutputLock lock = begin_output(options.out, kFedLog);
  io::save_settings(options.out / "settings.yaml", settings);
  const FedAnswers fed = feed_messages(options.input, recorded, std::move(stack), options.out / "log.mcap", guard);
  guard.release();  // a signal ends the scoring
  return complete_fed_log(options, references, text_of(recorded), {{"messages", recorded.num_messages}}, fed);
}

}  // namespace

ExitCode feed_log_command(const FeedOptions& options) {
  check_output(options);
  return options.as_recorded ? feed_messages_of_log(options) : feed_scans_of_log(options);
}

}  // namespace patrol::app
