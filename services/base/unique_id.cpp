#include "services/base/unique_id.h"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <random>
#include <string_view>

#include "services/base/wall_clock.h"

namespace spindrift {

std::string unique_id() {
  constexpr std::string_view kDigits = "0123456789abcdefghjkmnpqrstvwxyz";
  std::random_device random;
  std::string id;
  for (int shift = 30; shift >= 0; shift -= 5) {
    id += kDigits[(static_cast<std::uint64_t>(tai_ns(tai_now())) / 1'000'000'000U >> shift) % 32U];
  }
  std::generate_n(std::back_inserter(id), 10, [&] { return kDigits[random() % 32U]; });
  return id;
}

}  // namespace spindrift
