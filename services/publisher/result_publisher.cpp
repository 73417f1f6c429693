#include "services/publisher/result_publisher.h"

#include <utility>
#include <variant>

#include "services/publisher/product_messages.h"
#include "services/publisher/to_idl.h"

namespace spindrift {

Expected<ResultPublisher> ResultPublisher::create(const bus::Participant& participant,
                                                  std::string service) {
  const bus::Qos qos = bus::results_qos();
  auto health = bus::Writer<spindrift_Health>::create(participant, bus::kHealthTopic, qos);
  if (!health) {
    return Unexpected{health.error()};
  }
  Writers products;
  Expected<void> made;
  for_each_product_kind([&]<class Kind>() {
    if constexpr (PublishedProduct<Kind>) {
      const auto topic = product_topic<Kind>();
      made = made.and_then([&] {
        return bus::UntypedWriter::create(participant, topic.name, topic.type, qos,
                                          bus::Sending::AtOnce)
            .map([&](bus::UntypedWriter&& writer) {
              products.emplace(kProductKind<Kind>, std::move(writer));
            });
      });
    }
  });
  if (!made) {
    return Unexpected{made.error()};
  }
  return ResultPublisher{std::move(service), std::move(products), std::move(*health)};
}

Expected<void> ResultPublisher::publish(std::string_view spacecraft, std::string_view run_id,
                                        const Product& product) const {
  return std::visit(
      [&]<class Kind>(const Kind& value) -> Expected<void> {
        if constexpr (PublishedProduct<Kind>) {
          return to_idl({.spacecraft = spacecraft, .run_id = run_id, .service = service_}, value)
              .and_then([&](const typename ProductMessage<Kind>::Type& message) {
                return products_.at(kProductKind<Kind>).write(&message);
              });
        } else if constexpr (AnnouncedProduct<Kind>) {
          Expected<void> published;
          for (const auto& part : ProductKind<Kind>::announced_as(value)) {
            published = published.and_then([&] { return publish(spacecraft, run_id, part); });
          }
          return published;
        } else {
          return {};
        }
      },
      product);
}

Expected<void> ResultPublisher::publish(const Health& health) const {
  return to_idl(service_, health).and_then([this](const HealthSample& health_sample) {
    return health_.write(health_sample.sample);
  });
}

Expected<std::vector<std::string>> ResultPublisher::incompatible_readers() const {
  std::vector<std::string> all;
  Expected<void> looked;
  const auto look = [&](const Expected<bus::WriterStatus>& status) {
    if (!status) {
      looked = Unexpected{status.error()};
    } else {
      all.insert(all.end(), status->incompatible_readers.begin(),
                 status->incompatible_readers.end());
    }
  };
  for (const auto& [kind, writer] : products_) {
    look(writer.status());
  }
  look(health_.status());
  return looked.map([&] { return std::move(all); });
}

}  // namespace spindrift
