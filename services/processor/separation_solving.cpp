#include "services/processor/separation_solving.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "services/base/notice_words.h"
#include "services/processor/withheld.h"

namespace spindrift {
namespace {

Expected<ReconstructionProduct> solved_by(ReconstructionMethod method,
                                          const ReconstructionRequest& request,
                                          const std::optional<LauncherAttitude>& launcher) {
  auto separation = reconstruct_separation(request, method, launcher);
  if (!separation) {
    return Unexpected{std::move(separation.error())};
  }
  auto product = std::make_shared<const ReconstructedSeparation>(*std::move(separation));
  if (const auto why = why_withheld(Product{product})) {
    return Unexpected{{ErrorCode::Unobservable, sentence_of(*why)}};
  }
  return product;
}

}  // namespace

std::vector<Product> SolvedSeparation::products() const {
  std::vector<Product> products;
  for (const ReconstructionProduct& method : methods) {
    products.emplace_back(method);
    if (const auto& equations = method->solution.equations) {
      products.emplace_back(*equations);
    }
  }
  return products;
}

SolvedSeparation solve_separation(const ReconstructionRequest& request,
                                  const std::optional<LauncherAttitude>& launcher,
                                  std::optional<ReconstructionMethod> method) {
  SolvedSeparation solved;
  for (const auto one : {ReconstructionMethod::Batch, ReconstructionMethod::Sequential}) {
    if (method.value_or(one) != one) {
      continue;
    }
    if (auto product = solved_by(one, request, launcher)) {
      solved.methods.push_back(*std::move(product));
    } else if (std::find(solved.failures.begin(), solved.failures.end(), product.error().message) ==
               solved.failures.end()) {
      solved.failures.push_back(product.error().message);
    }
  }
  return solved;
}

}  // namespace spindrift
