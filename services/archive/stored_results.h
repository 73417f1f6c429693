/// @file
/// What the archive holds of the results of a run that goes on: those that have been announced.

#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "pipelines/core/expected.h"
#include "services/products/products.h"

namespace spindrift {

/// Only what is announced: see is_announced of each kind of product.
class StoredResults {
 public:
  /// The last one of each instance on the bus; of a fix with its best alternate only.
  std::vector<Product> in_force() const;

  /// Whether it has been given before, were it with other numbers. A fix that is no longer
  /// AMBIGUOUS has not.
  bool hold(const Product& product) const;

  /// Those of an instance in the order of their numbers.
  void add(Product product);

 private:
  struct Given {
    Product last;
    std::vector<std::int64_t> settled = {};  ///< In order; so are the others.
    std::vector<std::int64_t> open = {};
  };
  /// By kind and instance.
  std::map<std::pair<std::size_t, std::string>, Given> given_;
};

/// @return as find_stored_passes.
Expected<StoredResults> find_stored_results(const std::filesystem::path& archive,
                                            const std::string& run_id);

}  // namespace spindrift
