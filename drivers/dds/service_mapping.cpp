#include "drivers/dds/service_mapping.hpp"

#include <algorithm>

namespace cellmirror::dds {

namespace {

constexpr std::size_t kRequestHeaderBytes = 16;
constexpr std::string_view kClientKey = "clientid";
constexpr std::uint8_t kReaderBit = 0x04;  // of the last octet of a GUID (RTPS 2.3, 9.3.1.2)

bool is_reader(const Guid& endpoint) { return (endpoint.back() & kReaderBit) != 0; }

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

void write_reply_to_nobody(std::vector<std::byte>& out) {
  CdrWriter writer(out);
  begin_reply({{}, RequestHeader{}}, writer);
  // As content of any reply of an action: refused; no goals; an unknown status without text.
  writer.write(std::uint64_t{0});
  writer.write_text({});
}

std::optional<std::string_view> client_id(std::string_view user_data) {
  while (!user_data.empty()) {
    const std::size_t end = std::min(user_data.find(';'), user_data.size());
    const std::string_view pair = user_data.substr(0, end);
    const std::size_t equals = pair.find('=');
    if (equals != std::string_view::npos && pair.substr(0, equals) == kClientKey)
      return pair.substr(equals + 1, kMostClientId);
    user_data.remove_prefix(std::min(end + 1, user_data.size()));
  }
  return std::nullopt;
}

bool ClientEndpoints::note(const Guid& endpoint, std::optional<std::string_view> client) {
  if (!client) {
    clients_.erase(endpoint);
    return true;
  }
  if (clients_.size() >= kMost && !clients_.contains(endpoint)) return false;
  clients_.insert_or_assign(endpoint, std::string(*client));
  return true;
}

bool ClientEndpoints::reaches(const RequestName& to, std::span<const Guid> readers) const {
  const Guid& asker = to.sample.guid;
  if (!to.header) return !is_reader(asker) || std::ranges::find(readers, asker) != readers.end();
  const auto client = clients_.find(asker);
  if (client == clients_.end()) return false;
  return std::ranges::any_of(readers, [&](const Guid& reader) {
    const auto known = clients_.find(reader);
    return known != clients_.end() && known->second == client->second;
  });
}

}  // namespace cellmirror::dds
