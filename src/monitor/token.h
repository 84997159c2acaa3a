#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace patrol::monitor {

/// A secret that robots and people at the page show when they change something.
///
/// The first line of a file. Throws InputError when it has fewer than 16 characters, or some that cannot stand in an HTTP header.
std::string load_token(const std::filesystem::path& file);
void check_token(const std::string& place, const std::string& token);

/// From the folder's file `token`; made of 256 random bits, for its owner's eyes alone, when there is none.
std::string token_of_folder(const std::filesystem::path& folder);

/// In a time that does not tell how much of it is right.
bool is_same_token(std::string_view a, std::string_view b);

}  // namespace patrol::monitor
