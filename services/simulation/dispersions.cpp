#include "services/simulation/dispersions.h"

#include <fmt/format.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pipelines/core/shown.h"
#include "pipelines/ground_model/link/chance.h"
#include "services/mission/values.h"
#include "services/simulation/scenario.h"

namespace spindrift {
namespace {

struct DispersedValue {
  std::string key;
  std::optional<double> sigma;
  std::optional<double> range;

  double draw(Chance& chance) const {
    return sigma ? *sigma * chance.normal() : *range * chance.either_way();
  }
};

std::string table_name(std::size_t i) { return fmt::format("dispersions[{}]", i); }

std::vector<DispersedValue> dispersions_of(const TomlValues& values) {
  std::vector<DispersedValue> all;
  while (const auto key = value_if<std::string>(values, table_name(all.size()) + ".key")) {
    const std::string table = table_name(all.size());
    all.push_back({.key = *key,
                   .sigma = value_if<double>(values, table + ".sigma"),
                   .range = value_if<double>(values, table + ".range")});
  }
  return all;
}

/// Sets a value, and makes the tables of its path. @param key Dotted, as in TomlValues.
template <class Value>
void set(toml::table& table, const std::string& key, Value&& value) {
  toml::table* at = &table;
  std::size_t from = 0;
  for (std::size_t dot = key.find('.'); dot != std::string::npos; dot = key.find('.', from)) {
    at = at->insert(key.substr(from, dot - from), toml::table{}).first->second.as_table();
    from = dot + 1;
  }
  at->insert_or_assign(key.substr(from), std::forward<Value>(value));
}

void disperse(const DispersedValue& dispersion, const TomlValues& values, Chance& chance,
              toml::table& table) {
  if (const auto* const number = std::get_if<double>(&values.find(dispersion.key)->second)) {
    set(table, dispersion.key, *number + dispersion.draw(chance));
    return;
  }
  toml::array elements;
  for (const double element : value_of<std::vector<double>>(values, dispersion.key)) {
    elements.push_back(element + dispersion.draw(chance));
  }
  set(table, dispersion.key, std::move(elements));
}

/// Returns a seed different from that of the pass, so that the draws are independent.
std::uint64_t seed_of_dispersions(std::int64_t seed) {
  constexpr std::uint64_t kApart = 0x9e3779b97f4a7c15U;
  return static_cast<std::uint64_t>(seed) + kApart;
}

bool holds_numbers(const Scalar& value) {
  return std::holds_alternative<double>(value) ||
         std::holds_alternative<std::vector<double>>(value);
}

/// Returns whether the elements of a key belong together: drawn one by one, those of an inertia or
/// a quaternion would no longer be one.
bool is_one(const std::string& key) {
  const std::size_t name = key.rfind('.') + 1;
  return key == "three_axis.inertia.kg_m2" || key.compare(name, 2, "q_") == 0;
}

}  // namespace

void check_dispersions(TomlDocument& document) {
  const std::vector<DispersedValue> all = dispersions_of(document.values);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto value = document.values.find(all[i].key);
    if (value == document.values.end() && document.table.at_path(all[i].key)) {
      continue;  // The schema has reported what is wrong with it.
    }
    // Nothing can be set in an array of tables, or in a key that is absent.
    const bool can_be = value != document.values.end() && holds_numbers(value->second) &&
                        all[i].key.find('[') == std::string::npos && !is_one(all[i].key);
    if (!can_be) {
      const std::string key = table_name(i) + ".key";
      add_problem(document, key,
                  fmt::format("{} = \"{}\": must be a key of this scenario that holds a number, or "
                              "an array of numbers that is no inertia and no quaternion",
                              key, shown(all[i].key)));
    }
  }
}

Expected<TomlDocument> dispersed(const TomlDocument& document, std::int64_t run) {
  const std::int64_t seed = value_of<std::int64_t>(document.values, "pass.seed") + run;
  toml::table table = document.table;
  Chance chance{seed_of_dispersions(seed)};
  for (const DispersedValue& dispersion : dispersions_of(document.values)) {
    disperse(dispersion, document.values, chance, table);
  }
  set(table, "pass.seed", seed);
  return checked_scenario(document.path, std::move(table));
}

}  // namespace spindrift
