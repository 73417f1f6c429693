#include "services/mission/document_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string_view>

#include "pipelines/core/shown.h"
#include "services/mission/key_check.h"
#include "services/mission/nearest_name.h"

namespace spindrift {
namespace {

std::vector<std::string> names_in(const TableRule& rule) {
  std::vector<std::string> names;
  for (const auto& [name, key] : rule.keys) {
    names.push_back(name);
  }
  for (const auto& [name, table] : rule.tables) {
    names.push_back(name);
  }
  return names;
}

class Check {
 public:
  explicit Check(std::string kind) : kind_{std::move(kind)} {}

  void document(const TableRule& schema, const toml::table& table) { given(schema, table, ""); }

  CheckedToml result() && { return std::move(result_); }

 private:
  static std::string joined(const std::string& path, std::string_view name) {
    return path.empty() ? std::string{name} : fmt::format("{}.{}", path, name);
  }

  void problem(const toml::source_region& where, std::string text) {
    result_.problems.push_back({where.begin.line, std::move(text)});
  }

  void given(const TableRule& rule, const toml::table& table, const std::string& path) {
    // A key that was probably misspelt is not also reported as missing.
    const auto meant = unknown_names(rule, table, path);
    for (const auto& [name, key_rule] : rule.keys) {
      if (const toml::node* const node = table.get(name)) {
        key(key_rule, *node, joined(path, name));
      } else if (!meant.contains(name)) {
        absent_key(key_rule, table, joined(path, name));
      }
    }
    for (const auto& [name, table_rule] : rule.tables) {
      const toml::node* const node = table.get(name);
      if (node == nullptr) {
        if (!meant.contains(name)) {
          absent_table(table_rule, joined(path, name));
        }
      } else if (table_rule.many) {
        many(table_rule, *node, joined(path, name));
      } else {
        one(table_rule, *node, joined(path, name));
      }
    }
    exactly_one(rule, table, meant, path);
    order(rule, table, path);
  }

  void one(const TableRule& rule, const toml::node& node, const std::string& path) {
    if (const toml::table* const table = node.as_table()) {
      given(rule, *table, path);
    } else {
      problem(node.source(), fmt::format("{} = {}: must be a table", path, shown(node)));
    }
  }

  void many(const TableRule& rule, const toml::node& node, const std::string& path) {
    const toml::array* const array = node.as_array();
    if (array == nullptr) {
      problem(node.source(),
              fmt::format("{} = {}: must be an array of tables, [[{}]]", path, shown(node), path));
      return;
    }
    for (std::size_t i = 0; i < array->size(); ++i) {
      one(rule, (*array)[i], fmt::format("{}[{}]", path, i));
    }
  }

  std::set<std::string> unknown_names(const TableRule& rule, const toml::table& table,
                                      const std::string& path) {
    std::vector<std::string> absent = names_in(rule);
    std::erase_if(absent, [&](const std::string& name) { return table.contains(name); });
    std::set<std::string> meant;
    for (const auto& [key, node] : table) {
      const std::string name{key.str()};
      if (rule.keys.contains(name) || rule.tables.contains(name)) {
        continue;
      }
      if (const auto moved = rule.moved.find(name); moved != rule.moved.end()) {
        problem(key.source(), fmt::format("{} = {}: moved to {}", joined(path, name), shown(node),
                                          moved->second));
        continue;
      }
      const std::string nearest = nearest_name(shown(name), absent);
      problem(key.source(),
              fmt::format("{}: unknown; {}", joined(path, shown(name)),
                          nearest.empty()
                              ? fmt::format("allowed here: {}", fmt::join(names_in(rule), ", "))
                              : fmt::format("did you mean {}?", nearest)));
      meant.insert(nearest);
    }
    return meant;
  }

  void key(const KeyRule& rule, const toml::node& node, const std::string& path) {
    if (const auto wrong = objection(rule, node)) {
      problem(node.source(), fmt::format("{} = {}: {}", path, shown(node), *wrong));
    } else {
      result_.values.emplace(path, value_by(rule, node));
    }
  }

  void absent_key(const KeyRule& rule, const toml::table& table, const std::string& path) {
    if (rule.default_value) {
      result_.values.emplace(path, *rule.default_value);
    } else if (!rule.optional) {
      problem(table.source(),
              fmt::format("{}: missing: {} ({})", path, allowed_by(rule), rule.about));
    }
  }

  void absent_table(const TableRule& rule, const std::string& path) {
    if (rule.required == "always" || (!rule.required.empty() && rule.required == kind_)) {
      problem({}, fmt::format("[{}]: missing: {}", path, rule.about));
      return;
    }
    if (rule.many) {
      return;
    }
    for (const auto& [name, key_rule] : rule.keys) {
      if (key_rule.default_value) {
        result_.values.emplace(joined(path, name), *key_rule.default_value);
      }
    }
    for (const auto& [name, table_rule] : rule.tables) {
      absent_table(table_rule, joined(path, name));
    }
  }

  void exactly_one(const TableRule& rule, const toml::table& table,
                   const std::set<std::string>& meant, const std::string& path) {
    const auto& names = rule.exactly_one_of;
    const auto present = std::count_if(names.begin(), names.end(), [&](const std::string& name) {
      return table.contains(name) || meant.contains(name);
    });
    if (!names.empty() && present != 1) {
      problem(table.source(), fmt::format("{}: must have exactly one of {}, has {}", path,
                                          fmt::join(names, ", "), present));
    }
  }

  void order(const TableRule& rule, const toml::table& table, const std::string& path) {
    for (const auto& [name, key_rule] : rule.keys) {
      const auto& lower = key_rule.not_below_keys;
      static_cast<void>(
          std::any_of(lower.begin(), lower.end(), [&, &limited = name](const std::string& key) {
            return is_below(table, path, limited, key);
          }));
    }
  }

  /// Reports a value below its lower key. It skips the pair when either value is invalid or absent.
  bool is_below(const toml::table& table, const std::string& path, const std::string& name,
                const std::string& lower_name) {
    const auto value = result_.values.find(joined(path, name));
    const auto lower = result_.values.find(joined(path, lower_name));
    if (value == result_.values.end() || lower == result_.values.end() ||
        !below(value->second, lower->second)) {
      return false;
    }
    const toml::node* const node = table.get(table.contains(name) ? name : lower_name);
    problem(node->source(),
            fmt::format("{} = {}: must not be below {} = {}", value->first, text_of(value->second),
                        lower_name, text_of(lower->second)));
    return true;
  }

  std::string kind_;
  CheckedToml result_;
};

}  // namespace

CheckedToml check_document(const TableRule& schema, const toml::table& document) {
  Check check{document["spacecraft"]["kind"].value_or(std::string{})};
  check.document(schema, document);
  return std::move(check).result();
}

}  // namespace spindrift
