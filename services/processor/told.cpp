#include "services/processor/told.h"

#include "services/base/warning.h"
#include "services/products/notice_of.h"

namespace spindrift {

RunNotice told(std::string_view code, const nlohmann::json& values, const std::string& text,
               std::optional<TaiTime> t) {
  warn(code, values, text);
  return notice_of(code, values, text, t);
}

}  // namespace spindrift
