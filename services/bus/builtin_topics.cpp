#include "services/bus/builtin_topics.h"

#include <algorithm>
#include <cstdint>
#include <memory>

#include "pipelines/core/shown.h"

namespace spindrift::bus {

std::vector<std::string> partitions_of(const dds_qos_t* qos) {
  std::uint32_t count = 0;
  char** names = nullptr;
  std::vector<std::string> partitions;
  if (dds_qget_partition(qos, &count, &names) && count > 0) {
    partitions.assign(names, names + count);
    std::for_each(names, names + count, dds_free);
    dds_free(names);
  }
  return partitions.empty() ? std::vector<std::string>{""} : partitions;
}

std::string property(const dds_qos_t* qos, const char* name) {
  char* value = nullptr;
  if (!dds_qget_prop(qos, name, &value)) {
    return "unknown";
  }
  const std::unique_ptr<char, decltype(&dds_free)> owner{value, &dds_free};
  return shown(value);
}

}  // namespace spindrift::bus
