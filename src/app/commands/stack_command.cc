#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "app/commands/commands.h"
#include "app/common/temporary_folder.h"
#include "app/mapping/log_documents.h"
#include "app/mapping/mapping_stack.h"
#include "app/run/built_in_stack.h"
#include "app/run/make_stack_port.h"
#include "app/scenario/data_folders.h"
#include "io/files/atomic_file.h"
#include "link/stack_client.h"

namespace patrol::app {
namespace {

/// Transforms of the sensors, among the messages that preceded the first turn.
io::TransformSet mounts_of(const std::vector<link::DeliveredMessage>& documents) {
  const auto mounts =
      std::ranges::find(documents, std::string(io::kStaticTransforms.topic), &link::DeliveredMessage::topic);
  return mounts != documents.end() ? io::decode<io::TransformSet>(mounts->cdr) : io::TransformSet{};
}

/// Creates the built-in stack by the documents of a hello: for a recorded log the mapping alone.
std::unique_ptr<StackPort> stack_for(link::StackClient& client) {
  const link::Hello& hello = client.hello();
  if (is_recorded_log(hello))
    return std::make_unique<MappingStack>(mapping_settings_of(hello), mounts_of(client.documents()));
  const TemporaryFolder folder("stack");
  const std::filesystem::path file = folder.path() / "documents.yaml";
  io::save_text(file, hello.documents);
  Scenario scenario = load_scenario(file);
  scenario.file.clear();           // messages must not name a file that is removed
  scenario.stack.command.clear();  // the built-in stack needs its sensors in this process as well
  const ScenarioFiles files = load_scenario_files(scenario, find_data_root(file));
  if (scenario.stack.compute.model != "fixed") client.wait_on_simulator_core();  // the simulator waits for each turn
  return std::make_unique<BuiltInStack>(make_stack(scenario, files), stack::ComputeSettings{}, false);
}

void publish(link::StackClient& client, Time now, const std::vector<PublishedMessage>& messages) {
  for (const PublishedMessage& message : messages) {
    std::visit([&]<typename Message>(
                   const Message&) { client.publish_encoded(now, message.topic, io::kRosType<Message>, message.cdr); },
               message.content.value());
  }
}

void take_turns(link::StackClient& client) {
  const std::unique_ptr<StackPort> stack = stack_for(client);
  client.begin("patrol stack", {}, BuiltInStack::kMinTurnPeriod);
  for (bool is_last = false; !is_last;) {
    const link::ReceivedTurn turn =
        client.next_turn([&](link::DeliveredMessage message) { stack->deliver(std::move(message)); });
    is_last = turn.is_last;
    if (is_last) {
      publish(client, turn.now, stack->finish(turn.now));
      client.done({.now = turn.now, .next_turn = {}, .mission_is_over = true});
    } else {
      const StackAnswer answer = stack->take_turn(turn.now);
      publish(client, turn.now, answer.messages);
      client.done({.now = turn.now, .next_turn = answer.next_turn, .mission_is_over = answer.mission_is_over});
    }
  }
}

}  // namespace

ExitCode stack_command(const std::optional<std::string>& address) {
  link::StackClient client =
      address ? link::StackClient::connect(link::parse_address(*address)) : link::StackClient::connect();
  try {
    take_turns(client);
  } catch (const std::exception& error) {
    client.fail(error.what());
    throw;
  }
  return ExitCode::kDone;
}

}  // namespace patrol::app
