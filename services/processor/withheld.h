/// @file
/// Products that must not be stored.

#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "pipelines/core/assessment.h"
#include "pipelines/core/notice.h"
#include "services/processor/last_answers.h"
#include "services/products/not_finite.h"
#include "services/products/products.h"

namespace spindrift {

/// Returns why a product is withheld: a value that is not finite violates a constraint of the
/// archive, which would refuse the whole batch. The run goes on, and its samples are stored.
/// @return A NotFinite notice; empty when the archive accepts the product.
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

/// Removes withheld products and remembers the reasons, so that each is reported once.
class Withheld {
 public:
  /// Removes withheld products from `output` and adds the reasons to its notices. In place of a
  /// withheld answer the previous answer is repeated as DOUBTFUL.
  template <class Output, class PassProduct>
  void take_from(Output& output, LastAnswers<PassProduct>& answers) {
    for (PassProduct& product : std::exchange(output.products, {})) {
      const auto why = why_withheld(product);
      if (!why) {
        answers.remember(product);
        output.products.push_back(std::move(product));
        continue;
      }
      if (std::find(said_.begin(), said_.end(), *why) == said_.end()) {
        said_.push_back(*why);
        output.notices.push_back(*why);
      }
      if (auto before = answers.instead_of(product, {ReasonCode::Withheld, why->values})) {
        output.products.push_back(*std::move(before));
      }
    }
  }

 private:
  std::vector<Notice> said_;
};

}  // namespace spindrift
