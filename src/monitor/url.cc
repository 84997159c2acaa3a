#include "monitor/url.h"

#include <charconv>
#include <string_view>

#include <fmt/format.h>

#include "core/error.h"

namespace patrol::monitor {
namespace {

std::string decoded(std::string_view text) {
  std::string plain;
  for (std::size_t i = 0; i < text.size(); ++i) {
    unsigned char code = 0;
    const bool is_escape = text[i] == '%' && i + 2 < text.size() &&
                           std::from_chars(&text[i + 1], &text[i + 1] + 2, code, 16).ptr == &text[i + 1] + 2;
    if (is_escape) {
      plain += static_cast<char>(code);
      i += 2;
    } else {
      plain += text[i] == '+' ? ' ' : text[i];
    }
  }
  return plain;
}

}  // namespace

void split_target(const std::string& target, std::string& path,
                  std::map<std::string, std::string, std::less<>>& parameters) {
  const std::size_t question = target.find('?');
  path = target.substr(0, question);
  if (question == std::string::npos) return;
  std::string_view rest = std::string_view(target).substr(question + 1);
  while (!rest.empty()) {
    const std::string_view pair = rest.substr(0, rest.find('&'));
    rest.remove_prefix(std::min(rest.size(), pair.size() + 1));
    const std::size_t equals = pair.find('=');
    if (equals != std::string_view::npos)
      parameters.emplace(decoded(pair.substr(0, equals)), decoded(pair.substr(equals + 1)));
  }
}

Url parse_url(const std::string& text) {
  const auto refuse = [&] { return InputError(fmt::format("{}: must be a URL such as http://127.0.0.1:8080", text)); };
  constexpr std::string_view kScheme = "http://";
  std::string_view rest = text;
  if (!rest.starts_with(kScheme)) throw refuse();
  rest.remove_prefix(kScheme.size());
  if (rest.ends_with('/')) rest.remove_suffix(1);
  const std::size_t colon = rest.rfind(':');
  const bool has_port = colon != std::string_view::npos && rest.find(']', colon) == std::string_view::npos;
  Url url{.host = std::string(rest.substr(0, has_port ? colon : rest.size())),
          .port = has_port ? std::string(rest.substr(colon + 1)) : "80"};
  if (url.host.starts_with('[') && url.host.ends_with(']')) url.host = url.host.substr(1, url.host.size() - 2);
  int port = 0;
  const auto [end, error] = std::from_chars(url.port.data(), url.port.data() + url.port.size(), port);
  const bool is_port = error == std::errc() && end == url.port.data() + url.port.size() && port >= 1 && port <= 65535;
  if (url.host.empty() || url.host.find_first_of("/?#@ ") != std::string::npos || !is_port) throw refuse();
  return url;
}

}  // namespace patrol::monitor
