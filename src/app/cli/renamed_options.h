#pragma once

namespace patrol::app {

/// Throws InputError if the command line has a command or an option under a former name; the message has the present
/// one.
void refuse_renamed(int argc, const char* const* argv);

}  // namespace patrol::app
