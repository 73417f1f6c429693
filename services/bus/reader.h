/// @file
/// A typed reader: samples out of the middleware's own memory, and what became of the others.

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
  std::uint32_t writers;   ///< Matched now.
  std::uint32_t lost;      ///< Samples that Cyclone knows it lost; it does not know of all.
  std::uint32_t rejected;  ///< Attempts that a full reader refused; the writer tries again.
  std::vector<std::string> incompatible_writers;  ///< In sight now; see endpoints.h.

  /// Of several readers together.
  ReaderStatus& operator+=(const ReaderStatus& other);
};

/// Everything about a reader that does not depend on the type of its samples.
class UntypedReader {
 public:
  /// @param accepts See Reader; empty: all.
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

  std::unique_ptr<Filter> filter_;  // Before the reader, which it outlives.
  Entity reader_;
  Entity data_;
};

template <class Sample>
class Reader {
 public:
  /// @param accepts Whether the reader keeps a sample; empty: every one. Called on threads of
  /// Cyclone within the reader's lock: quick, and nothing of DDS. What is refused is acknowledged,
  /// and leaves no instance behind.
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

  /// Calls `handler(const Sample&)`, or with when it was written as well, nanoseconds by the clock
  /// of the writer, for each of up to 256 samples; the sample is gone afterwards. The end of a
  /// source is no sample. @return how many were taken: 0 when there were none.
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

  /// The condition "there is something to take", for a WaitSet.
  const Entity& data() const { return reader_.data(); }

  /// From any thread. @return Unavailable when Cyclone refuses.
  Expected<ReaderStatus> status() const { return reader_.status(); }

 private:
  explicit Reader(UntypedReader&& reader) : reader_{std::move(reader)} {}

  UntypedReader reader_;
};

}  // namespace spindrift::bus
