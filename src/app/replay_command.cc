#include "app/commands.h"
#include <stdexcept>
namespace patrol::app {
ExitCode replay_command(const ReplayOptions&) { throw std::runtime_error("replay: not built yet"); }
}
