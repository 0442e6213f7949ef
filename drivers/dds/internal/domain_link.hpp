// DDS participants of this process. Each runs the DDS library in a confined process (cellmirror-dds). When that process
// fails it is replaced, and all readers and writers are made again.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "drivers/dds/internal/service_clients.hpp"
#include "drivers/dds/message/dds_message.hpp"
#include "drivers/dds/ros_graph.hpp"
#include "ipc/sandbox/sandbox.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/ports/ros_presence.hpp"

namespace cellmirror::dds {

// Events of a reader or writer. The link's thread calls them one at a time, and not after remove().
class EndpointEvents {
 public:
  virtual ~EndpointEvents() = default;
  virtual void sample(const SampleReceived& /*sample*/, std::span<const std::byte> /*payload*/) {}
  virtual void matched(const PeerMatched& /*event*/) {}
  virtual void incompatible(std::uint64_t /*total*/) {}
  virtual void dropped(std::uint64_t /*total*/) {}
  // A new process has made the endpoint. A writer with samples for late readers sends these again.
  virtual void added() {}
  // The process has ended, so no peer is matched any more.
  virtual void lost() {}
};

// One object for each combination of domain, interface and security; it lives as long as it is referenced. Any thread.
class DomainLink {
 public:
  // Waits up to 5 s until the participant is open. Succeeds as well if the process fails meanwhile, since the link then
  // tries again by itself.
  [[nodiscard]] static Result<std::shared_ptr<DomainLink>> shared(int domain, const std::string& interface_address,
                                                                  const DdsSecurityConfig& security);
  ~DomainLink();
  DomainLink(const DomainLink&) = delete;
  DomainLink& operator=(const DomainLink&) = delete;

  [[nodiscard]] const RosPresence& presence() const { return presence_; }
  [[nodiscard]] const ServiceClients& clients() const { return clients_; }

  // Returns the id of the new endpoint. Waits up to 2 s for the library; a process that is away makes the endpoint when
  // it is back. `events` has to exist until remove().
  [[nodiscard]] Result<std::uint32_t> add(AddEndpoint wanted, EndpointEvents& events);
  void remove(std::uint32_t id);
  // Writes a sample. Returns false if there is no process, or if it does not read.
  bool write(const WriteSample& sample, std::span<const std::byte> payload);
  // Sandbox::outage().
  [[nodiscard]] std::string outage() const { return sandbox_->outage(); }

 private:
  struct Endpoint {
    AddEndpoint wanted;
    EndpointEvents* events = nullptr;
    bool there = false;  // in the process that runs now
    std::optional<Guid> guid;
    std::string refusal;
  };
  class GraphWriter;
  DomainLink(OpenParticipant wanted, RosPresence presence, std::string subject);
  [[nodiscard]] Result<void> open();
  void send(DdsRequest request);
  void on_started();
  [[nodiscard]] bool on_message(std::span<const std::byte> message);
  void on_ended();

  // Handlers of the decoded events. They return false for an event that the process may not send now.
  bool take(const ParticipantOpened& event, std::span<const std::byte> rest);
  bool take(const ParticipantRefused& event, std::span<const std::byte> rest);
  bool take(const EndpointAdded& event, std::span<const std::byte> rest);
  bool take(const EndpointRefused& event, std::span<const std::byte> rest);
  bool take(const SampleReceived& event, std::span<const std::byte> rest);
  bool take(const PeerMatched& event, std::span<const std::byte> rest);
  bool take(const PeersIncompatible& event, std::span<const std::byte> rest);
  bool take(const PeerAnnounced& event, std::span<const std::byte> rest);
  bool take(const SamplesDropped& event, std::span<const std::byte> rest);
  bool take(const LibraryLog& event, std::span<const std::byte> rest);
  // Null for an endpoint that was removed while the message was on its way.
  [[nodiscard]] Endpoint* endpoint(std::uint32_t id);
  void publish_graph();

  const OpenParticipant wanted_;
  const RosPresence presence_;
  ServiceClients clients_;
  std::atomic<bool> ready_{false};  // the process knows the participant and all endpoints: others may follow
  std::mutex mutex_;                // of what follows; held during the calls of EndpointEvents
  std::condition_variable changed_;
  std::map<std::uint32_t, Endpoint> endpoints_;
  std::uint32_t last_id_ = 0;
  bool opened_ = false;  // the process that runs now has the participant
  std::optional<std::string> refused_;
  RosGraph graph_;
  std::unique_ptr<GraphWriter> graph_writer_;  // null: nothing is published
  std::vector<std::byte> head_;                // reused by write(), under its own mutex
  std::mutex write_mutex_;
  std::unique_ptr<Sandbox> sandbox_;  // last: its thread calls the above
};

}  // namespace cellmirror::dds
