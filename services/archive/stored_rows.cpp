#include "services/archive/stored_rows.h"

#include "services/archive/connection.h"
#include "services/telemetry/time_order.h"

namespace spindrift {

Expected<PlacedValues> find_telemetry(const std::filesystem::path& archive,
                                      const std::string& spacecraft_id,
                                      const std::string& preferred_source, TaiTime from,
                                      TaiTime to) {
  return read_archive(archive, [&](SQLite::Database& database) {
    SenderNames senders{preferred_source};
    PlacedValues all;
    all.for_each([&]<class Value>(PlacedOfKind<Value>& of_kind) {
      for (const Value& value : read_between<Value>(database, spacecraft_id, from, to, senders)) {
        of_kind.push_back({.place = {}, .value = value});
      }
    });
    put_in_order(all);
    return all;
  });
}

}  // namespace spindrift
