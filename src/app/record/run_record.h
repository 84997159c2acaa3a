#pragma once

#include <filesystem>

#include "score/run_record.h"

namespace patrol::app {

using score::RunRecord;

/// Reads the record from a run's log. Throws InputError if the log is damaged or ends before the first ground truth.
RunRecord read_run_record(const std::filesystem::path& log_mcap);

}  // namespace patrol::app
