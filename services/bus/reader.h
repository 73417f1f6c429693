/// @file
/// A typed reader of samples in the middleware's memory, with counts of lost ones.

#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "services/bus/loan.h"
#include "services/bus/participant.h"
#include "services/bus/qos.h"
#include "services/bus/topics.h"

namespace spindrift::bus {

/// Cyclone's counts since the reader was created.
struct ReaderStatus {
  std::uint32_t writers;   ///< Number matched now.
  std::uint32_t lost;      ///< Lost samples that Cyclone knows of, which need not be all.
  std::uint32_t rejected;  ///< Attempts that a full reader refused; the writer tries again.
  std::vector<std::string> incompatible_writers;  ///< Currently visible; see endpoints.h.

  /// Adds the status of another reader.
  ReaderStatus& operator+=(const ReaderStatus& other);
};

/// The part of a reader that does not depend on the type of its samples.
class UntypedReader {
 public:
  /// @param accepts As for Reader; empty accepts all.
  static Expected<UntypedReader> create(const Participant& participant, const char* topic,
                                        const dds_topic_descriptor_t* type, const Qos& qos,
                                        std::function<bool(const void*)> accepts);

  const Entity& entity() const { return reader_; }
  const Entity& data() const { return data_; }
  Expected<ReaderStatus> status() const;

 private:
  using Filter = std::function<bool(const void*)>;

  UntypedReader(std::unique_ptr<Filter> filter, Entity reader, Entity data)
      : filter_{std::move(filter)}, reader_{std::move(reader)}, data_{std::move(data)} {}

  std::unique_ptr<Filter> filter_;  // Declared before the reader, which uses it.
  Entity reader_;
  Entity data_;
};

template <class Sample>
class Reader {
 public:
  /// @param accepts Whether the reader keeps a sample; empty keeps all. It is called on threads of
  ///        Cyclone while the reader is locked, so it must be quick and must not call DDS. Refused
  ///        samples are acknowledged and leave no instance behind.
  /// @return Unavailable, naming the topic, when Cyclone refuses.
  static Expected<Reader> create(const Participant& participant, const Topic<Sample>& topic,
                                 const Qos& qos, std::function<bool(const Sample&)> accepts = {}) {
    std::function<bool(const void*)> filter;
    if (accepts) {
      filter = [accepts = std::move(accepts)](const void* sample) {
        return accepts(*static_cast<const Sample*>(sample));
      };
    }
    return UntypedReader::create(participant, topic.name, topic.type, qos, std::move(filter))
        .map([](UntypedReader&& reader) { return Reader{std::move(reader)}; });
  }

  /// Calls `handler(const Sample&)`, or `handler` with the sample and its time of writing in
  /// nanoseconds of the writer's clock, for up to 256 samples, which are only valid during the
  /// call. The end of a source is not passed on. @return The number of samples taken, possibly 0.
  template <class Handler>
  Expected<std::size_t> take(Handler&& handler) const {
    const Loan loan{reader_.entity()};
    for (std::size_t i = 0; i < loan.count().value_or(0); ++i) {
      if (const void* sample = loan[i]; sample != nullptr) {
        if constexpr (std::is_invocable_v<Handler, const Sample&, std::int64_t>) {
          handler(*static_cast<const Sample*>(sample), loan.written_ns(i));
        } else {
          handler(*static_cast<const Sample*>(sample));
        }
      }
    }
    return loan.count();
  }

  /// Returns the condition "there is something to take", for a WaitSet.
  const Entity& data() const { return reader_.data(); }

  /// Safe to call from any thread. @return Unavailable when Cyclone refuses.
  Expected<ReaderStatus> status() const { return reader_.status(); }

 private:
  explicit Reader(UntypedReader&& reader) : reader_{std::move(reader)} {}

  UntypedReader reader_;
};

}  // namespace spindrift::bus
