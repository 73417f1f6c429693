/// @file
/// Products that are not for the archive.

#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "pipelines/core/notice.h"
#include "services/products/not_finite.h"
#include "services/products/products.h"

namespace spindrift {

/// A number that is none breaks a rule of the archive, and everything that is stored with it would
/// be refused: such a product is withheld. The run goes on, and its samples are stored.
/// @return NotFinite, or nothing: the archive takes the product.
template <class... Kinds>
std::optional<Notice> why_withheld(const std::variant<Kinds...>& product) {
  const auto found = std::visit([](const auto& value) { return not_finite(value); }, product);
  if (!found) {
    return std::nullopt;
  }
  return Notice{
      .code = NoticeCode::NotFinite,
      .values = {{"table", std::string{found->table}}, {"column", std::string{found->column}}}};
}

/// Remembers what was said, so that each reason is among the notices once.
class Withheld {
 public:
  /// Leaves out products that are withheld, and adds why to the notices.
  template <class Output>
  void take_from(Output& output) {
    std::erase_if(output.products, [&](const auto& product) {
      const auto why = why_withheld(product);
      if (why && std::find(said_.begin(), said_.end(), *why) == said_.end()) {
        said_.push_back(*why);
        output.notices.push_back(*why);
      }
      return why.has_value();
    });
  }

 private:
  std::vector<Notice> said_;
};

}  // namespace spindrift
