#pragma once

#include <string>
#include <string_view>

namespace patrol::io {

/// Returns the present path of a settings key that was renamed, such as `stack.navigation.blocked_timeout_s` for
/// `stack.plan.patience_s`. Paths are dotted, from the root of the document. Returns the path unchanged if no part of
/// it was renamed.
std::string renamed_setting(std::string_view path);

}  // namespace patrol::io
