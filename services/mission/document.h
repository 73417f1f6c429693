/// @file
/// Reads a configuration file, checks it against its schema and collects every problem.

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
  std::string text;  ///< Text of the file.
  toml::table table;
  TomlValues values;  ///< Only the valid ones.
  std::vector<TomlProblem> problems;
};

/// @param path Path for messages. @return InvalidConfiguration for what is not TOML.
Expected<toml::table> parsed_toml(const std::filesystem::path& path, const std::string& text);

/// @return InvalidConfiguration for an unreadable file and for what is not TOML; violations of the
///         schema are in `problems`.
Expected<TomlDocument> read_document(const std::filesystem::path& path, const TableRule& schema);

/// Checks a text that was read before. @param path Path for messages.
Expected<TomlDocument> parse_document(const std::filesystem::path& path, std::string text,
                                      const TableRule& schema);

/// Adds a problem that the schema cannot express. @param key Key whose line is named, if any.
void add_problem(TomlDocument& document, std::string_view key, std::string text);

/// @return InvalidConfiguration with every problem, one a line: "FILE:LINE: KEY = VALUE: what is
///         allowed", with the line if one is known.
Expected<void> soundness(const TomlDocument& document);

}  // namespace spindrift
