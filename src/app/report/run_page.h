#pragma once

#include <filesystem>

#include "app/report/run_contents.h"
#include "render/report/blocks.h"

namespace patrol::app {

/// The report of one run. `page_file`: where it will lie, which decides whether a large video can be linked.
render::Page run_page(const RunContents& run, const std::filesystem::path& page_file);

}  // namespace patrol::app
