#include "services/processor/told.h"

#include "services/standard_error/warning.h"

namespace spindrift {

RunNotice notice_of(std::string_view code, const nlohmann::json& values, const std::string& text,
                    std::optional<TaiTime> t) {
  return {.t = t,
          .code = std::string{code},
          .arguments = values.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace),
          .says = text};
}

RunNotice told(std::string_view code, const nlohmann::json& values, const std::string& text,
               std::optional<TaiTime> t) {
  warn(code, values, text);
  return notice_of(code, values, text, t);
}

}  // namespace spindrift
