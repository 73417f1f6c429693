/// @file
/// Binds values of the domain to the parameters of a statement.

#pragma once

#include <SQLiteCpp/Statement.h>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "pipelines/spin/types/pulse.h"
#include "services/telemetry/places.h"

namespace spindrift {

inline void bind(SQLite::Statement& statement, int index, std::int64_t value) {
  statement.bind(index, value);
}
inline void bind(SQLite::Statement& statement, int index, RunPlace place) {
  statement.bind(index, place.number);
}
inline void bind(SQLite::Statement& statement, int index, bool value) {
  statement.bind(index, value ? 1 : 0);
}
inline void bind(SQLite::Statement& statement, int index, double value) {
  statement.bind(index, value);
}
inline void bind(SQLite::Statement& statement, int index, const std::string& value) {
  statement.bindNoCopy(index, value);
}
// The text must be a literal as given by a name_of(...): NUL-terminated and valid forever.
inline void bind(SQLite::Statement& statement, int index, std::string_view literal) {
  statement.bindNoCopy(index, literal.data());
}
inline void bind(SQLite::Statement& statement, int index, PulseChannel channel) {
  bind(statement, index, name_of(channel));
}
template <class T>
void bind(SQLite::Statement& statement, int index, const std::optional<T>& value) {
  if (value) {
    bind(statement, index, *value);
  } else {
    statement.bind(index);
  }
}

/// Executes a statement. Text is bound without a copy, so `values` must outlive the call.
template <class... Values>
void execute(SQLite::Statement& statement, const Values&... values) {
  statement.tryReset();  // Returns the status of the last step, reported then.
  int index = 0;
  (bind(statement, ++index, values), ...);
  statement.exec();
}

}  // namespace spindrift
