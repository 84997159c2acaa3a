#pragma once

#include <string>

#include "render/report/blocks.h"

namespace patrol::render {

/// The whole page in one file: style, scripts, pictures and data in it, nothing fetched from anywhere (its own content security policy
/// forbids it). The same page gives the same bytes.
std::string to_html(const Page& page);

}  // namespace patrol::render
