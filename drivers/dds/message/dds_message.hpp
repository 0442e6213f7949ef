// Messages between cellmirror and cellmirror-dds, the process of the DDS library. They carry samples as bytes; only
// cellmirror decodes these. Pure.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "drivers/dds/message/guid.hpp"
#include "ipc/sandbox/channel.hpp"
#include "ipc/sandbox/message_bytes.hpp"
#include "rt_core/ports/dds_network.hpp"
#include "rt_core/ports/stream_config.hpp"

namespace cellmirror::dds {

inline constexpr std::size_t kMaxPayloadBytes = 1U << 20U;  // of a sample; longer ones come without their content
inline constexpr std::size_t kStartBytes = 20;              // who asks, of a request (service_mapping.hpp)
inline constexpr std::size_t kMaxUserData = 4096;           // of an endpoint; longer ones come as none

inline constexpr ChannelConfig kDdsChannel{
    .to_child_bytes = 4U << 20U, .to_owner_bytes = 4U << 20U, .longest_message = 3U << 20U};

// --- to the process -------------------------------------------------------------------------------------------------

// Opens the participant. The first message, sent once. Paths are absolute.
struct OpenParticipant {
  int domain = 0;
  std::string address;
  DdsSecurityConfig security;
  DdsNetworkConfig network;

  void fields(auto& bytes) {
    bytes(domain, address, security.identity_ca, security.certificate, security.private_key, security.permissions_ca,
          security.governance, security.permissions);
    bytes(network.multicast);
    bytes.choice(network.link, DdsLink::lossy);
    bytes.list(network.discovery_servers, [&](DdsServer& server) { bytes(server.address, server.port, server.id); });
    bytes.list(network.peers, [&](DdsPeer& peer) { bytes(peer.address, peer.port); });
  }
};

// Makes a reader or writer. The id is new.
struct AddEndpoint {
  std::uint32_t id = 0;
  bool writer = false;
  std::string topic;
  std::string type;
  std::string partition;  // empty: in none
  std::string user_data;
  bool reliable = false;
  std::int32_t depth = 1;
  bool large = false;               // a writer's samples are larger than a datagram
  bool transient_local = false;     // a writer gives its history to readers that come later, a reader asks for it
  bool counts_overwritten = false;  // a writer reports samples that it overwrites before a reader has confirmed them

  void fields(auto& bytes) {
    bytes(id, writer, topic, type, partition, user_data, reliable, depth, large, transient_local, counts_overwritten);
  }
};

struct RemoveEndpoint {
  std::uint32_t id = 0;
  void fields(auto& bytes) { bytes(id); }
};

// Writes a sample, whose bytes follow.
struct WriteSample {
  static constexpr bool kCarriesBytes = true;

  std::uint32_t id = 0;
  bool reply = false;
  Guid request_guid{};  // of the request that this replies to
  std::int64_t request_number = 0;

  void fields(auto& bytes) { bytes(id, reply, request_guid, request_number); }
};

// Closes the participant, so that its peers know at once, and ends the process.
struct CloseParticipant {
  void fields(auto&) {}
};

// --- from the process -----------------------------------------------------------------------------------------------

struct ParticipantOpened {
  Guid guid{};
  void fields(auto& bytes) { bytes(guid); }
};

struct ParticipantRefused {
  std::string what;
  void fields(auto& bytes) { bytes(what); }
};

struct EndpointAdded {
  std::uint32_t id = 0;
  Guid guid{};
  void fields(auto& bytes) { bytes(id, guid); }
};

struct EndpointRefused {
  std::uint32_t id = 0;
  std::string what;
  void fields(auto& bytes) { bytes(id, what); }
};

// A received sample, whose bytes follow. A sample of more than kMaxPayloadBytes comes without them.
struct SampleReceived {
  static constexpr bool kCarriesBytes = true;

  std::uint32_t id = 0;
  std::int64_t taken_ns = 0;  // CLOCK_MONOTONIC
  Guid writer{};
  std::int64_t number = 0;
  Guid related{};              // of the related sample identity; zeros: none
  std::uint64_t received = 0;  // bytes that came
  std::array<std::uint8_t, kStartBytes> start{};

  void fields(auto& bytes) { bytes(id, taken_ns, writer, number, related, received, start); }
};

// An endpoint of another participant is now matched with the endpoint `id`, or no longer.
struct PeerMatched {
  std::uint32_t id = 0;
  Guid peer{};
  bool matched = false;
  std::int32_t count = 0;  // matched now

  void fields(auto& bytes) { bytes(id, peer, matched, count); }
};

// Number of writers whose offer does not match the request of the reader `id`.
struct PeersIncompatible {
  std::uint32_t id = 0;
  std::uint64_t total = 0;
  void fields(auto& bytes) { bytes(id, total); }
};

// An endpoint of another participant announces USER_DATA, or is gone.
struct PeerAnnounced {
  Guid peer{};
  bool gone = false;
  std::string user_data;
  void fields(auto& bytes) { bytes(peer, gone, user_data); }
};

// Number of samples of a writer that the library refused or overwrote before a reader had confirmed them.
struct SamplesDropped {
  std::uint32_t id = 0;
  std::uint64_t total = 0;
  void fields(auto& bytes) { bytes(id, total); }
};

// A line of the library's log.
struct LibraryLog {
  bool warning = false;
  std::string category;
  std::string text;
  void fields(auto& bytes) { bytes(warning, category, text); }
};

using DdsRequest = std::variant<OpenParticipant, AddEndpoint, RemoveEndpoint, WriteSample, CloseParticipant>;
using DdsEvent = std::variant<ParticipantOpened, ParticipantRefused, EndpointAdded, EndpointRefused, SampleReceived,
                              PeerMatched, PeersIncompatible, PeerAnnounced, SamplesDropped, LibraryLog>;

// Replaces the content of `out`. The bytes of a sample are sent behind it.
void encode(DdsRequest& request, std::vector<std::byte>& out);
void encode(DdsEvent& event, std::vector<std::byte>& out);
// Return nothing if the bytes are not such a message, or if bytes follow a message that carries none.
[[nodiscard]] std::optional<ReceivedMessage<DdsRequest>> decode_request(std::span<const std::byte> bytes);
[[nodiscard]] std::optional<ReceivedMessage<DdsEvent>> decode_event(std::span<const std::byte> bytes);

}  // namespace cellmirror::dds
