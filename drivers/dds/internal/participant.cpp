#include "drivers/dds/internal/participant.hpp"

#include <fmt/core.h>

#include <exception>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <map>
#include <mutex>
#include <utility>

#include "drivers/dds/internal/endpoint_qos.hpp"
#include "drivers/dds/internal/library_guid.hpp"
#include "rt_core/base/log.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror::dds {

namespace {

namespace fd = eprosima::fastdds::dds;

}  // namespace

Result<void> Participant::open(const std::string& partition) {
  fd::PublisherQos publishers;
  fd::SubscriberQos subscribers;
  if (!partition.empty()) {
    publishers.partition().push_back(partition.c_str());
    subscribers.partition().push_back(partition.c_str());
  }
  publisher_ = of_->library().create_publisher(publishers);
  subscriber_ = of_->library().create_subscriber(subscribers);
  if (publisher_ == nullptr || subscriber_ == nullptr) return fail("DDS refused a publisher or subscriber");
  return {};
}

Result<std::shared_ptr<Participant>> Participant::shared(int domain, const std::string& interface_address,
                                                         const DdsSecurityConfig& security,
                                                         const std::string& partition) {
  static std::mutex mutex;
  static std::map<std::pair<DomainParticipant*, std::string>, std::weak_ptr<Participant>> participants;
  auto of = DomainParticipant::shared(domain, interface_address, security);
  if (!of) return std::unexpected(of.error());
  const std::scoped_lock lock(mutex);
  auto& entry = participants[{of->get(), partition}];
  if (auto existing = entry.lock()) return existing;
  try {
    std::shared_ptr<Participant> made(new Participant(std::move(*of)));
    if (auto opened = made->open(partition); !opened) return std::unexpected(opened.error());
    entry = made;
    return made;
  } catch (const std::exception& error) {
    return fail(fmt::format("DDS domain {} on {}: {}", domain, interface_address, error.what()));
  }
}

Participant::~Participant() {
  const std::scoped_lock lock(of_->mutex());
  try {
    if (publisher_ != nullptr) of_->library().delete_publisher(publisher_);
    if (subscriber_ != nullptr) of_->library().delete_subscriber(subscriber_);
  } catch (const std::exception& error) {
    log_warning("dds.participant", "endpoints stay until the end of the library's participant: {}", error.what());
  }
}

Result<fd::DataReader*> Participant::add_reader(const EndpointConfig& config, fd::DataReaderListener* listener) {
  const std::scoped_lock lock(of_->mutex());
  try {
    const auto of_topic = of_->topic(config);
    if (!of_topic) return std::unexpected(of_topic.error());
    fd::DataReader* made =
        subscriber_->create_datareader(*of_topic, reader_qos(config, of_->presence().messages()), listener);
    if (made == nullptr) return fail(fmt::format("DDS refused a reader of {}", printable(config.topic)));
    of_->add_reader(guid_of(made->guid()));
    return made;
  } catch (const std::exception& error) {
    return fail(fmt::format("a DDS reader of {}: {}", printable(config.topic), error.what()));
  }
}

Result<fd::DataWriter*> Participant::add_writer(const EndpointConfig& config, fd::DataWriterListener* listener) {
  const std::scoped_lock lock(of_->mutex());
  try {
    const auto of_topic = of_->topic(config);
    if (!of_topic) return std::unexpected(of_topic.error());
    const fd::DataWriterQos qos = writer_qos(config, of_->presence().messages(), of_->link());
    fd::DataWriter* made = publisher_->create_datawriter(*of_topic, qos, listener);
    if (made == nullptr) return fail(fmt::format("DDS refused a writer of {}", printable(config.topic)));
    of_->add_writer(guid_of(made->guid()));
    return made;
  } catch (const std::exception& error) {
    return fail(fmt::format("a DDS writer of {}: {}", printable(config.topic), error.what()));
  }
}

void Participant::remove(fd::DataReader* reader) {
  const std::scoped_lock lock(of_->mutex());
  const Guid guid = guid_of(reader->guid());
  subscriber_->delete_datareader(reader);
  of_->remove_reader(guid);
}

void Participant::remove(fd::DataWriter* writer) {
  const std::scoped_lock lock(of_->mutex());
  const Guid guid = guid_of(writer->guid());
  publisher_->delete_datawriter(writer);
  of_->remove_writer(guid);
}

}  // namespace cellmirror::dds
