#pragma once

#include <map>
#include <string>

#include "io/yaml/expectations.h"

namespace patrol::app {

/// Replaces the values in the section `expect:` of a scenario's text, and appends the metrics that are not in it, in
/// the order of the rules (limit_rules.h). Every other line and the comments stay; a comment "measured ..." behind a
/// value is replaced. `measured`: such comments by metric. Lines of metrics without a new value stay.
///
/// Throws InputError with source and line if the section or one of its values is not written as "  metric: value" on a
/// line of its own. `source`: name of the file for messages.
std::string edit_expect_section(const std::string& source, const std::string& text,
                                const io::Expectations& expectations,
                                const std::map<std::string, std::string>& measured);

}  // namespace patrol::app
