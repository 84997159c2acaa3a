#include "slam/graph/loop_closure_statistics.h"

namespace patrol::slam {

void LoopClosureStatistics::add(MatchFailure failure) {
  ++searched;
  switch (failure) {
    case MatchFailure::kNone:
      ++closed;
      break;
    case MatchFailure::kNotFound:
      ++not_found;
      break;
    case MatchFailure::kAmbiguous:
      ++ambiguous;
      break;
    case MatchFailure::kNoOverlap:
      ++no_overlap;
      break;
    case MatchFailure::kMismatch:
      ++mismatched;
      break;
  }
}

}  // namespace patrol::slam
