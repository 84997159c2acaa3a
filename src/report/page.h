#pragma once

#include <string>

#include "report/blocks.h"

namespace patrol::report {

/// Complete page in one file with style, scripts, pictures and data. Nothing is fetched: the page's content security
/// policy forbids it. Equal pages give equal bytes.
std::string to_html(const Page& page);

}  // namespace patrol::report
