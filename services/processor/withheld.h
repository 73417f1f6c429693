/// @file
/// Products that are not for the archive.

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
  /// Leaves out products that are withheld, and adds why to the notices. In the place of an answer
  /// the one before stands once more, DOUBTFUL.
  template <class Output, class PassProduct>
  void take_from(Output& output, LastAnswers<PassProduct>& answers) {
    for (PassProduct& product : std::exchange(output.products, {})) {
      const auto why = why_withheld(product);
      if (!why) {
        answers.note(product);
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
