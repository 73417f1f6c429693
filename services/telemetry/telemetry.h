/// @file
/// Traits of a kind of telemetry: names, columns and limits of what is possible.

#pragma once

#include <cstddef>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>

namespace spindrift {

/// The types on the bus, with their names in the IDL. Several topics may share one.
enum class BusMessage { Pulse, CodedFrame, VectorSample, StarFix, OrbitState };

/// A member of a value, with its name in files and in the archive. The member's type sets the
/// format: a `double` is required, an `optional` may be missing, an enumeration is written by name.
template <class Access>
struct Column {
  std::string_view name;
  Access of;  ///< Returns a member of a value for reading or writing.
};
template <class Access>
Column(const char*, Access) -> Column<Access>;

/// Traits of a kind of telemetry, a value type of a pipeline with a member `t`. Each kind has a
/// specialisation in a header of its own beside this one:
///
///     static constexpr std::string_view kName;    name of the kind, "gyro"
///     static constexpr std::string_view kPlural;  name of several samples, "gyro samples"
///     static constexpr const char* kTopic;        topic on the bus; its message has the columns
///     static constexpr BusMessage kMessage;       as members behind t_tai_ns, in the same order
///     static constexpr std::string_view kTable;   table in the archive
///     static constexpr std::string_view kSensor;  table of the mission file that describes the
///                                                 sensor; empty: there is none
///     static constexpr std::tuple kColumns;       Columns behind t_tai_ns
///     static std::string why_impossible(const Value&);  value and what is allowed; empty: it is
///                                                       possible
///     static constexpr std::size_t place(const Value&); only if samples may have equal times:
///                                                       index of the sample among them
template <class Value>
struct Telemetry;

/// Calls `see(name, member)` for each column, in order.
template <class Value, class See>
constexpr void for_each_column(Value& value, See&& see) {
  std::apply([&](const auto&... column) { (see(column.name, column.of(value)), ...); },
             Telemetry<std::remove_const_t<Value>>::kColumns);
}

/// Number of columns after t_tai_ns.
template <class Value>
inline constexpr std::size_t kColumnCount =
    std::tuple_size_v<std::remove_const_t<decltype(Telemetry<Value>::kColumns)>>;

}  // namespace spindrift
