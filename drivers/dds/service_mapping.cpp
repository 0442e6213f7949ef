#include "drivers/dds/service_mapping.hpp"

#include <algorithm>

namespace cellmirror::dds {

namespace {

constexpr std::size_t kRequestHeaderBytes = 16;
constexpr std::string_view kClientKey = "clientid";

}  // namespace

std::optional<ServiceRequest> open_request(const RequestSample& sample) {
  ServiceRequest request{{sample.name}, CdrReader(sample.payload)};
  if (sample.related != Guid{}) {
    request.name.sample.guid = sample.related;
    return request;
  }
  if (!sample.announces_client) return request;
  RequestHeader header;
  header.client = request.content.read<std::uint64_t>();
  header.number = request.content.read<std::int64_t>();
  if (request.content.fault() != CdrFault::none) return std::nullopt;
  request.name.header = header;
  return request;
}

void begin_reply(const RequestName& to, CdrWriter& out) {
  if (!to.header) return;
  out.write(to.header->client);
  out.write(to.header->number);
}

void end_reply(CdrWriter& out) { out.fill_to(kRequestHeaderBytes); }

bool announces_client(std::string_view user_data) {
  while (!user_data.empty()) {
    const std::size_t end = std::min(user_data.find(';'), user_data.size());
    const std::string_view pair = user_data.substr(0, end);
    if (pair.substr(0, pair.find('=')) == kClientKey && pair.size() > kClientKey.size()) return true;
    user_data.remove_prefix(std::min(end + 1, user_data.size()));
  }
  return false;
}

bool ClientWriters::note(const Guid& writer, bool announces) {
  if (!announces) {
    writers_.erase(writer);
    return true;
  }
  if (writers_.size() >= kMost && !writers_.contains(writer)) return false;
  writers_.insert(writer);
  return true;
}

}  // namespace cellmirror::dds
