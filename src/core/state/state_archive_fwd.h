#pragma once

namespace patrol {

class StateArchive;

}  // namespace patrol
