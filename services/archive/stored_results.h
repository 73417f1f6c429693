/// @file
/// Reads the announced results of a run that is continued.

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

/// Holds the announced products of a run (see is_announced of each kind of product).
class StoredResults {
 public:
  /// Returns each instance's last product; of a fix's alternates only the best.
  std::vector<Product> in_force() const;

  /// Returns whether this product was given before, even if with other numbers. A fix that is
  /// resolved now and was AMBIGUOUS before counts as new.
  bool hold(const Product& product) const;

  /// Adds a product. Those of one instance must come in the order of their numbers.
  void add(Product product);

 private:
  struct Given {
    Product last;
    std::vector<std::int64_t> settled = {};  ///< Sorted, as `open` is.
    std::vector<std::int64_t> open = {};
  };
  std::map<std::pair<std::size_t, std::string>, Given> given_;
};

/// @return Errors as find_stored_passes.
Expected<StoredResults> find_stored_results(const std::filesystem::path& archive,
                                            const std::string& run_id);

}  // namespace spindrift
