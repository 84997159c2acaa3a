#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace patrol::monitor {

/// Reads the access token, which robots and users of the page present to make changes, from the first line of a file.
/// Throws InputError when it has fewer than 16 characters or characters not allowed in an HTTP header.
std::string load_token(const std::filesystem::path& file);
/// Throws InputError, beginning with `place`, for a token that `load_token` would not accept.
void check_token(const std::string& location, const std::string& token);

/// Reads the token from the file `token` of the folder. Creates the file with 256 random bits, readable by its owner
/// only, if it does not exist.
std::string load_or_create_token(const std::filesystem::path& folder);

/// Compares two tokens in constant time, so that the time does not reveal the matching length.
bool is_same_token(std::string_view a, std::string_view b);

}  // namespace patrol::monitor
