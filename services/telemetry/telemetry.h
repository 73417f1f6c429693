/// @file
/// What the services must know of a kind of telemetry: names, columns, and what can be true.

#pragma once

#include <cstddef>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>

namespace spindrift {

/// The types on the bus, by their names in the IDL. One may serve several topics.
enum class BusMessage { Pulse, CodedFrame, VectorSample, StarFix, OrbitState };

/// A member of a value, by its name in files and in the archive. What its type is, tells how it
/// is written: a `double` must be there, an `optional` one may be missing, an enumeration goes by
/// name.
template <class Access>
struct Column {
  std::string_view name;
  Access of;  ///< The member of a value, to be read or written.
};
template <class Access>
Column(const char*, Access) -> Column<Access>;

/// To be specialised for each kind of telemetry, a value type of a pipeline with a member `t`, in
/// a header of its own beside this one:
///
///     static constexpr std::string_view kName;    of what a file holds, "gyro"
///     static constexpr std::string_view kPlural;  of what is counted, "gyro samples"
///     static constexpr const char* kTopic;        on the bus, whose message has its columns as
///     static constexpr BusMessage kMessage;       members behind t_tai_ns, in the same order
///     static constexpr std::string_view kTable;   in the archive
///     static constexpr std::string_view kSensor;  the table of the mission file that describes
///                                                 what measures it; empty: there is none
///     static constexpr std::tuple kColumns;       of Column, behind t_tai_ns
///     static std::string why_impossible(const Value&);  value and what is allowed; empty: it may
///                                                       be true
///     static constexpr std::size_t place(const Value&); only where there may be several samples
///                                                       of one time: which of them it is
template <class Value>
struct Telemetry;

/// Calls `see(name, member)` for each column, in order.
template <class Value, class See>
constexpr void for_each_column(Value& value, See&& see) {
  std::apply([&](const auto&... column) { (see(column.name, column.of(value)), ...); },
             Telemetry<std::remove_const_t<Value>>::kColumns);
}

/// Columns behind t_tai_ns.
template <class Value>
inline constexpr std::size_t kColumnCount =
    std::tuple_size_v<std::remove_const_t<decltype(Telemetry<Value>::kColumns)>>;

}  // namespace spindrift
