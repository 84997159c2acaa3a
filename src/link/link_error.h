#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

namespace patrol::link {

/// Ways in which a connection ends before its time.
enum class LinkFault : std::uint8_t {
  kClosed,       ///< the other side closed the connection or is gone
  kTimeout,      ///< the other side did not answer in time
  kInvalid,      ///< the other side violated the protocol
  kInterrupted,  ///< the user stopped the program
};

/// Connection that ended before its time. The message is one line for the user.
class LinkError : public std::runtime_error {
 public:
  LinkError(LinkFault fault, const std::string& text) : std::runtime_error(text), fault_(fault) {}
  LinkFault fault() const { return fault_; }

 private:
  LinkFault fault_;
};

}  // namespace patrol::link
