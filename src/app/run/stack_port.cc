#include "app/run/stack_port.h"

#include "core/error.h"

namespace patrol::app {

void StackPort::serialize_state(StateArchive& /*archive*/) {
  throw InputError("--snapshot-every, --from: the state of a stack in another process cannot be saved");
}

}  // namespace patrol::app
