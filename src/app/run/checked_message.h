#pragma once

#include <optional>
#include <string>

#include "app/run/stack_port.h"
#include "core/time.h"
#include "link/stack_server.h"

/// Checks of the messages that a stack in another process publishes.
namespace patrol::app {

/// Stamps that the messages of a stack may have, both included.
struct StampRange {
  Time from = Time::min(), to = Time::max();
};

/// Returns a message of a stack in another process with its content. Throws link::LinkError (kInvalid) if a topic that
/// Patrol knows has another type, invalid content or a stamp outside of the range, or is one that only the simulator
/// writes.
PublishedMessage checked_message(link::PublishedMessage message, const StampRange& stamps = {});

/// Returns the frame of the content of a message if it is fixed in the site or in the map; nullopt for frames of the
/// robot.
std::optional<std::string> expected_frame(const stack::StackMessage& content);

/// Returns the frame of a message in `map`, `odom` or `site` if its header or, in a path, that of a pose names another
/// one; nullopt without a difference. An empty frame is none.
std::optional<std::string> unexpected_frame(const PublishedMessage& message);

/// Formats a name that a stack has chosen for one line: its first 200 bytes, with control characters escaped.
std::string quoted_name(const std::string& name);

}  // namespace patrol::app
