#include "drivers/dds/joint_state_publisher.hpp"

#include <fmt/core.h>

#include <exception>
#include <utility>

#include "drivers/dds/internal/bytes_writer.hpp"

namespace cellmirror::dds {

struct JointStatePublisher::Impl {
  explicit Impl(std::unique_ptr<BytesWriter> made) : writer(std::move(made)) {}
  std::unique_ptr<BytesWriter> writer;
};

JointStatePublisher::JointStatePublisher(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
JointStatePublisher::~JointStatePublisher() = default;

Result<std::unique_ptr<JointStatePublisher>> JointStatePublisher::make(const JointStatePublisherConfig& config) {
  auto participant = Participant::shared(config.domain, config.interface_address, config.security, config.partition);
  if (!participant) return std::unexpected(participant.error());
  auto writer = BytesWriter::make(*participant, {config.topic, kJointStateType, config.reliable, config.depth});
  if (!writer) return std::unexpected(writer.error());
  return std::unique_ptr<JointStatePublisher>(new JointStatePublisher(std::make_unique<Impl>(std::move(*writer))));
}

bool JointStatePublisher::publish(const JointState& message) {
  encode(message, impl_->writer->payload());
  return impl_->writer->write();
}

bool JointStatePublisher::publish_bytes(std::span<const std::byte> payload) {
  impl_->writer->payload().assign(payload.begin(), payload.end());
  return impl_->writer->write();
}

int JointStatePublisher::matched_readers() const { return impl_->writer->matched_readers(); }

}  // namespace cellmirror::dds
