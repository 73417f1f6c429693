#include "services/processor/background_task.h"

#include <spdlog/spdlog.h>

#include "pipelines/time/utc.h"
#include "services/base/notice_words.h"
#include "services/processor/what_is_thrown.h"
#include "services/processor/withheld.h"

namespace spindrift {

Expected<std::vector<Product>> solved_or_fault(const std::string& spacecraft_id,
                                               std::string_view what, TaiTime t,
                                               const Solve& solve) {
  Expected<std::vector<Product>> products;
  const auto thrown = what_is_thrown([&] { products = solve(); });
  if (!thrown) {
    return products;
  }
  spdlog::error("{}: {} failed at {}: {}: its run is DOUBTFUL", spacecraft_id, what, format_utc(t),
                *thrown);
  return std::vector<Product>{RunFault{.t = t, .what = *thrown}};
}

Expected<std::vector<Product>> unless_withheld(std::vector<Product> products) {
  for (const Product& product : products) {
    if (const auto why = why_withheld(product)) {
      return Unexpected{{ErrorCode::Unobservable, sentence_of(*why)}};
    }
  }
  return products;
}

}  // namespace spindrift
