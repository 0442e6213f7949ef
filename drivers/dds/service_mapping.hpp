// How ROS 2's middleware maps services on DDS: by what a request tells who asks, and a reply whom it answers. Pure: no
// DDS library, no clock. Two mappings, told apart for each request:
// - Identity (rmw_fastrtps, rmw_connextdds): the reply has the request's sample identity in its inline QoS (DDS-RPC
//   1.0, 7.8.2.5). rmw_fastrtps names the client's reader of replies in the request's inline QoS, and is answered
//   under that name; others are answered under the name of their writer.
// - Header (rmw_cyclonedds 1.3 to 3.2, Humble to Rolling): 16 bytes in front of the content, within its alignment: the
//   client (8 bytes, a number of its own process) and the request's number there (int64). The reply repeats them. Such
//   a client announces `clientid=` in the USER_DATA of its writer and of its reader of replies, and never names a
//   reader in the inline QoS.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/dds/cdr.hpp"
#include "drivers/dds/ros_graph.hpp"
#include "drivers/dds/sample_name.hpp"

namespace cellmirror::dds {

struct RequestHeader {
  std::uint64_t client = 0;
  std::int64_t number = 0;

  bool operator==(const RequestHeader&) const = default;
};

// Whose request is answered.
struct RequestName {
  SampleName sample;
  std::optional<RequestHeader> header = {};  // none: mapped by identity

  bool operator==(const RequestName&) const = default;
};

struct ServiceRequest {
  RequestName name;
  CdrReader content;  // of the payload
};

// A sample on a topic of requests.
struct RequestSample {
  std::span<const std::byte> payload;  // outlives what is made of it
  SampleName name;
  Guid related{};                 // of the inline QoS; zeros: none
  bool announces_client = false;  // the writer, in its USER_DATA
};

// None: there is no whole header, so that nobody can be answered.
[[nodiscard]] std::optional<ServiceRequest> open_request(const RequestSample& sample);

// Around the content of a reply.
void begin_reply(const RequestName& to, CdrWriter& out);
// A reply without a header reaches clients with one too, which take its first bytes for theirs: there are enough of
// them, so that none compares what it did not read.
void end_reply(CdrWriter& out);

// What every client passes over. Fast DDS (2.9) sends a new reader what it does not get of the history, and a heartbeat
// that counts the first sample for it, before that sample; Cyclone DDS (0.10) takes nothing up to its first heartbeat
// of a writer. So this is the first sample for a reader of Cyclone DDS, and no reply is lost.
void write_reply_to_nobody(std::vector<std::byte>& out);

// The value of `clientid` in USER_DATA (`key=value;...`), at most kMostClientId characters of it; none: it has no such
// key.
inline constexpr std::size_t kMostClientId = 64;  // rmw_cyclonedds: at most 47
[[nodiscard]] std::optional<std::string_view> client_id(std::string_view user_data);

// The readers and writers of others that announce a client. One thread at a time.
class ClientEndpoints {
 public:
  static constexpr std::size_t kMost = 4096;

  // `client`: none, it announces none (any more). False where there is no room for another one.
  bool note(const Guid& endpoint, std::optional<std::string_view> client);
  [[nodiscard]] bool contains(const Guid& endpoint) const { return clients_.contains(endpoint); }
  // Whether one of the `readers` of replies belongs to whom the reply is for. True where that cannot be known.
  [[nodiscard]] bool reaches(const RequestName& to, std::span<const Guid> readers) const;

 private:
  std::map<Guid, std::string> clients_;
};

}  // namespace cellmirror::dds
