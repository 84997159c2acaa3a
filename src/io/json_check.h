#pragma once

#include <cstddef>
#include <string>

namespace patrol::io {

/// Reads a JSON text through without keeping any of it. Throws InputError, naming the file, the line and what stands there, when it is
/// not JSON, holds a number that is too large to be one, says a key twice in one object, or has a list of more than `max_entries`
/// (a file of a million goals is refused at the first one too many, not after seconds of reading).
void check_json(const std::string& file, const std::string& text, std::size_t max_entries);

}  // namespace patrol::io
