// Bytes of a stack in another process: records, then the checks of its messages.
#include <algorithm>
#include <cstring>

#include "app/run/checked_message.h"
#include "io/ros/ros_messages.h"
#include "link/link_error.h"
#include "link/record_parser.h"
#include "tests/fuzz/fuzz_input.h"

namespace {

using namespace patrol;

void decode_control(const io::McapMessage& message) {
  try {
    io::decode<link::HelloReply>(message.cdr);
    io::decode<link::Done>(message.cdr);
    io::decode<link::Failure>(message.cdr);
  } catch (const io::DecodeError&) {}
}

void check(const io::McapMessage& message) {
  decode_control(message);
  try {
    const app::PublishedMessage checked = app::checked_message({.topic = message.channel.topic,
                                                                .type = message.channel.type,
                                                                .definition = message.channel.definition,
                                                                .cdr = std::string(message.cdr)});
    test::require(checked.cdr == message.cdr, "the log has the bytes of the stack");
    if (!checked.content) return;
    if (const auto* command = std::get_if<VelocityCommand>(&*checked.content))
      test::require(std::isfinite(command->vx_mps) && std::isfinite(command->yaw_rate_radps), "commands are finite");
  } catch (const link::LinkError&) {}
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  link::RecordParser parser({.record_bytes = std::size_t{1} << 20, .num_channels = 16, .num_schemas = 16});
  try {
    // In pieces of a length that the input determines.
    const std::size_t piece = size > 0 ? 1 + data[size - 1] : 1;
    for (std::size_t begin = 0; begin < size; begin += piece) {
      const std::size_t count = std::min(piece, size - begin);
      std::memcpy(parser.prepare(count), data + begin, count);
      parser.commit(count);
      while (const auto message = parser.next()) check(*message);
    }
  } catch (const link::LinkError&) {}
  return 0;
}
