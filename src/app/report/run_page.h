#pragma once

#include <filesystem>

#include "app/report/run_contents.h"
#include "report/blocks.h"

namespace patrol::app {

/// Report page of one run. `page_file`: path of the page, which determines whether a large video can be linked.
report::Page run_page(const RunContents& run, const std::filesystem::path& page_file);

}  // namespace patrol::app
