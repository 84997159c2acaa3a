#pragma once

#include "core/time.h"

namespace patrol {

/// Returns the first time after `now` of a cycle that contains `due`. Cycles that were missed are skipped. `now` is not
/// before `due`; `period` is positive.
inline Time next_in_cycle(Time due, Time period, Time now) { return due + ((now - due) / period + 1) * period; }

}  // namespace patrol
