#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "app/run/stack_port.h"
#include "io/mcap/mcap_reader.h"

namespace patrol::app {

/// Stack that publishes what a stack published in an earlier run, at the same times, whatever it receives: the
/// simulator alone is repeated.
class RecordedStack final : public StackPort {
 public:
  /// `tick`: of the simulator. `has_turns`: whether the log has records of turns. Throws InputError.
  RecordedStack(const std::filesystem::path& log_mcap, Time tick, bool has_turns);

  void deliver(link::DeliveredMessage /*message*/) override {}
  void begin_turn(Time now) override { turn_ = now; }
  StackAnswer end_turn() override;
  std::vector<PublishedMessage> finish(Time now) override;
  bool records_turns() const override { return has_turns_; }
  std::map<std::string, double> seconds_by_stage() const override { return {}; }

 private:
  /// Message of the log that has a part in the answers: of the stack, or the record of a turn.
  struct Entry {
    Time log_time{};
    PublishedMessage message;             ///< message of the stack
    std::optional<StackTurnRecord> turn;  ///< record of a turn instead
    bool follows_truth = false;           ///< the ground truth of the same time precedes it: published at the end
  };

  std::optional<Entry> next_entry();
  std::vector<PublishedMessage> take_until_next_turn();

  Time tick_;
  Time turn_{};  ///< last turn
  Time end_{};
  bool has_turns_ = false;
  io::McapReader reader_;
  Time truth_time_ = Time::min();  ///< time of the last message of the ground truth
  std::optional<Entry> next_;
};

/// Reads the records of the turns of a stack; empty for a log of the built-in stack without computing time.
std::vector<StackTurnRecord> read_turn_records(const std::filesystem::path& log_mcap);

}  // namespace patrol::app
