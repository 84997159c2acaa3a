#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "app/run/stack_port.h"
#include "app/scenario/scenario.h"
#include "stack/stack.h"

namespace patrol::app {

/// Surroundings of the stack of a run.
struct StackContext {
  std::string scenario;  ///< name of the scenario
  std::filesystem::path data_root;
  std::filesystem::path output;          ///< file for the output of a stack in another process
  std::string output_name = {};          ///< place of that output in error texts; empty: the name of the file
  std::function<bool()> is_interrupted;  ///< polled while Patrol waits for such a stack
  bool has_thread = false;               ///< whether the built-in stack and its SLAM have threads of their own
};

/// Creates the built-in stack, or the connection to the stack of `stack.command`. Throws InputError if the settings of
/// the scenario are inconsistent.
std::unique_ptr<StackPort> make_stack_port(const Scenario& scenario, const ScenarioFiles& files, StackContext context);

/// Creates the built-in stack. `has_thread`: whether SLAM has a thread of its own, with the same results. Throws
/// InputError if the settings of the scenario are inconsistent.
stack::Stack make_stack(const Scenario& scenario, const ScenarioFiles& files, bool has_thread = false);

}  // namespace patrol::app
