#include "app/common/print_result.h"

#include <fmt/format.h>

namespace patrol::app {

void print_result(ResultForm form, const std::string& text, const io::Metrics& json) {
  if (form == ResultForm::kText) fmt::print("{}", text);
  else fmt::print("{}\n", json.dump(2, ' ', false, io::Metrics::error_handler_t::replace));
}

}  // namespace patrol::app
