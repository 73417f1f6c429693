/// @file
/// A configuration file: read, checked against its schema, every problem kept.

#pragma once

#include <toml++/toml.h>

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "pipelines/core/expected.h"
#include "services/mission/document_check.h"
#include "services/mission/scalar.h"
#include "services/mission/schema.h"

namespace spindrift {

struct TomlDocument {
  std::filesystem::path path;
  std::string text;  ///< As read.
  toml::table table;
  TomlValues values;  ///< Only the good ones.
  std::vector<TomlProblem> problems;
};

/// @param path Named in problems. @return InvalidConfiguration for what is not TOML.
Expected<toml::table> parsed_toml(const std::filesystem::path& path, const std::string& text);

/// @return InvalidConfiguration for what cannot be read or is not TOML; what breaks the schema
///         stands in `problems`.
Expected<TomlDocument> read_document(const std::filesystem::path& path, const TableRule& schema);

/// Likewise of a text that was read before. @param path Named in problems.
Expected<TomlDocument> parse_document(const std::filesystem::path& path, std::string text,
                                      const TableRule& schema);

/// Adds what the schema cannot say. @param key To blame: its line is named where it has one.
void add_problem(TomlDocument& document, std::string_view key, std::string text);

/// @return InvalidConfiguration with every problem, one a line:
///         "FILE:LINE: KEY = VALUE: what is allowed"; the line where one is to blame.
Expected<void> soundness(const TomlDocument& document);

}  // namespace spindrift
