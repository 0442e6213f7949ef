#include "drivers/dds/internal/domain_link.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <tuple>
#include <utility>

#include "drivers/dds/internal/addresses.hpp"
#include "drivers/dds/internal/process_setting.hpp"
#include "drivers/dds/network.hpp"
#include "drivers/dds/presence.hpp"
#include "drivers/dds/type_hashes.hpp"
#include "rt_core/base/log.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror::dds {

namespace {

using namespace std::chrono_literals;

constexpr auto kOpenWithin = 5s;
constexpr auto kAddWithin = 2s;

// Possible causes of a refused participant, for which the library gives no reason.
std::string remedy_for(const DdsSecurityConfig& security) {
  if (!security.enabled()) return "look whether the UDP ports of the domain are free (7400 + 250 * domain and above)";
  return "look at the files of [dds.security]: the key belongs to the certificate, the CAs have signed the others, "
         "the subject in the permissions is that of the certificate, the dates are valid (docs/dds.md)";
}

std::string subject_of(int domain, const std::string& address, const DdsSecurityConfig& security) {
  return fmt::format("DDS domain {} on {}{}", domain, address,
                     security.enabled() ? fmt::format(" as {}", security.certificate) : std::string());
}

ProcessSetting<RosPresence>& presence_setting() {
  static ProcessSetting<RosPresence> setting;
  return setting;
}

ProcessSetting<DdsNetworkConfig>& network_setting() {
  static ProcessSetting<DdsNetworkConfig> setting;
  return setting;
}

}  // namespace

void set_ros_presence(const RosPresence& presence) { presence_setting().set(presence); }

void set_network(const DdsNetworkConfig& network) { network_setting().set(network); }

// The writer of the list of nodes for programs of ROS 2. Guarded by the link's mutex.
class DomainLink::GraphWriter final : public EndpointEvents {
 public:
  explicit GraphWriter(DomainLink& link) : link_(link) {}
  void added() override { link_.publish_graph(); }

  std::uint32_t id = 0;

 private:
  DomainLink& link_;
};

DomainLink::DomainLink(OpenParticipant wanted, RosPresence presence, std::string subject)
    : wanted_(std::move(wanted)), presence_(std::move(presence)) {
  graph_.node = presence_.node_name;
  sandbox_ = std::make_unique<Sandbox>(
      SandboxConfig{.program = "cellmirror-dds",
                    .subject = std::move(subject),
                    .consequence = "its robots and topics have no data",
                    .channel = kDdsChannel},
      SandboxEvents{.started = [this] { on_started(); },
                    .received = [this](std::span<const std::byte> message) { return on_message(message); },
                    .ended = [this](const std::string&) { on_ended(); },
                    .stopping = [this] { send(CloseParticipant{}); }},
      "dds");
}

DomainLink::~DomainLink() { sandbox_->stop(); }

Result<std::shared_ptr<DomainLink>> DomainLink::shared(int domain, const std::string& interface_address,
                                                       const DdsSecurityConfig& security) {
  static std::mutex mutex;
  static std::map<std::tuple<int, std::string, DdsSecurityConfig>, std::weak_ptr<DomainLink>> links;
  if (auto ok = check_domain(domain); !ok) return std::unexpected(ok.error());
  if (auto ok = check_address(interface_address); !ok) return std::unexpected(ok.error());
  const std::scoped_lock lock(mutex);
  auto& entry = links[{domain, interface_address, security}];
  if (auto existing = entry.lock()) return existing;
  std::shared_ptr<DomainLink> made(new DomainLink(
      {.domain = domain, .address = interface_address, .security = security, .network = network_setting().get()},
      presence_setting().get(), subject_of(domain, interface_address, security)));
  if (auto opened = made->open(); !opened) return std::unexpected(opened.error());
  entry = made;
  return made;
}

Result<void> DomainLink::open() {
  if (presence_.distribution) {
    graph_writer_ = std::make_unique<GraphWriter>(*this);
    Endpoint graph;
    graph.wanted = {.id = ++last_id_,
                    .writer = true,
                    .topic = std::string(kRosGraphTopic),
                    .type = std::string(kRosGraphType),
                    .partition = {},
                    .user_data = type_user_data(kRosGraphType, presence_.messages()),
                    .reliable = true,
                    .transient_local = true};
    graph.events = graph_writer_.get();
    graph_writer_->id = graph.wanted.id;
    endpoints_[graph.wanted.id] = std::move(graph);
  }
  if (auto started = sandbox_->start(); !started)
    return fail(fmt::format("DDS domain {} on {}: {}", wanted_.domain, wanted_.address, started.error().what),
                started.error().remedy);
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, kOpenWithin, [this] { return opened_ || refused_; });
  if (!refused_) return {};
  return fail(fmt::format("DDS refused a participant in domain {} on {}{}", wanted_.domain, wanted_.address,
                          refused_->empty() ? "" : ": " + printable(*refused_)),
              remedy_for(wanted_.security));
}

void DomainLink::send(DdsRequest request) {
  std::vector<std::byte> bytes;
  encode(request, bytes);
  static_cast<void>(sandbox_->send(bytes));
}

void DomainLink::on_started() {
  const std::scoped_lock lock(mutex_);
  send(wanted_);
  for (const auto& [id, endpoint] : endpoints_) send(endpoint.wanted);
  ready_ = true;
}

void DomainLink::on_ended() {
  const std::scoped_lock lock(mutex_);
  ready_ = false;
  opened_ = false;
  graph_.readers.clear();
  graph_.writers.clear();
  clients_.forget_all();
  for (auto& [id, endpoint] : endpoints_) {
    endpoint.there = false;
    endpoint.guid.reset();
    endpoint.events->lost();
  }
  changed_.notify_all();
}

bool DomainLink::on_message(std::span<const std::byte> message) {
  const auto event = decode_event(message);
  if (!event) return false;
  return std::visit([&](const auto& one) { return take(one, event->rest); }, event->message);
}

DomainLink::Endpoint* DomainLink::endpoint(std::uint32_t id) {
  const auto found = endpoints_.find(id);
  return found == endpoints_.end() ? nullptr : &found->second;
}

bool DomainLink::take(const ParticipantOpened& event, std::span<const std::byte> /*rest*/) {
  const std::scoped_lock lock(mutex_);
  if (opened_) return false;
  opened_ = true;
  graph_.participant = event.guid;
  changed_.notify_all();
  return true;
}

bool DomainLink::take(const ParticipantRefused& event, std::span<const std::byte> /*rest*/) {
  const std::scoped_lock lock(mutex_);
  if (opened_) return false;
  refused_ = event.what;
  log_warning("dds.participant", "DDS refused a participant in domain {} on {}", wanted_.domain, wanted_.address);
  changed_.notify_all();
  return true;
}

bool DomainLink::take(const EndpointAdded& event, std::span<const std::byte> /*rest*/) {
  const std::scoped_lock lock(mutex_);
  Endpoint* const found = endpoint(event.id);
  if (found == nullptr) return event.id <= last_id_;
  if (found->there) return false;
  found->there = true;
  found->guid = event.guid;
  found->refusal.clear();
  const bool of_graph = graph_writer_ && event.id == graph_writer_->id;
  if (!of_graph) (found->wanted.writer ? graph_.writers : graph_.readers).push_back(event.guid);
  found->events->added();
  if (!of_graph) publish_graph();
  changed_.notify_all();
  return true;
}

bool DomainLink::take(const EndpointRefused& event, std::span<const std::byte> /*rest*/) {
  const std::scoped_lock lock(mutex_);
  Endpoint* const found = endpoint(event.id);
  if (found == nullptr) return event.id <= last_id_;
  found->refusal = event.what.empty() ? "DDS gave no reason" : printable(event.what, 400);
  log_warning("dds.endpoint", "{}", found->refusal);
  changed_.notify_all();
  return true;
}

bool DomainLink::take(const SampleReceived& event, std::span<const std::byte> rest) {
  if (rest.size() > kMaxPayloadBytes) return false;
  const std::scoped_lock lock(mutex_);
  if (Endpoint* const found = endpoint(event.id)) found->events->sample(event, rest);
  return true;
}

bool DomainLink::take(const PeerMatched& event, std::span<const std::byte> /*rest*/) {
  const std::scoped_lock lock(mutex_);
  if (Endpoint* const found = endpoint(event.id)) found->events->matched(event);
  return true;
}

bool DomainLink::take(const PeersIncompatible& event, std::span<const std::byte> /*rest*/) {
  const std::scoped_lock lock(mutex_);
  if (Endpoint* const found = endpoint(event.id)) found->events->incompatible(event.total);
  return true;
}

bool DomainLink::take(const PeerAnnounced& event, std::span<const std::byte> /*rest*/) {
  clients_.note(event.peer, event.user_data, event.gone);
  return true;
}

bool DomainLink::take(const SamplesDropped& event, std::span<const std::byte> /*rest*/) {
  const std::scoped_lock lock(mutex_);
  if (Endpoint* const found = endpoint(event.id)) found->events->dropped(event.total);
  return true;
}

bool DomainLink::take(const LibraryLog& event, std::span<const std::byte> /*rest*/) {
  // One kind for the rate limit: the process chooses the category.
  log_text(event.warning ? LogLevel::warning : LogLevel::info, "dds.library",
           fmt::format("{}: {}", printable(event.category, 40), printable(event.text, 400)));
  return true;
}

// The caller holds the mutex.
void DomainLink::publish_graph() {
  if (!graph_writer_) return;
  const Endpoint* const writer = endpoint(graph_writer_->id);
  if (writer == nullptr || !writer->there) return;
  std::vector<std::byte> bytes;
  encode(graph_, presence_.messages(), bytes);
  static_cast<void>(write({.id = graph_writer_->id}, bytes));
}

Result<std::uint32_t> DomainLink::add(AddEndpoint wanted, EndpointEvents& events) {
  std::unique_lock lock(mutex_);
  const std::uint32_t id = ++last_id_;
  wanted.id = id;
  const std::string topic = wanted.topic;
  const bool ready = opened_;
  endpoints_[id] = {.wanted = wanted, .events = &events, .there = false, .guid = {}, .refusal = {}};
  if (ready_) send(std::move(wanted));  // else on_started() does
  if (!ready) return id;
  changed_.wait_for(lock, kAddWithin, [&] {
    const Endpoint& made = endpoints_.at(id);
    return made.there || !made.refusal.empty() || !opened_;
  });
  const std::string refusal = endpoints_.at(id).refusal;
  if (refusal.empty()) return id;
  endpoints_.erase(id);
  return fail(refusal);
}

void DomainLink::remove(std::uint32_t id) {
  const std::scoped_lock lock(mutex_);
  const auto found = endpoints_.find(id);
  if (found == endpoints_.end()) return;
  if (found->second.guid) {
    std::erase(found->second.wanted.writer ? graph_.writers : graph_.readers, *found->second.guid);
    publish_graph();
  }
  endpoints_.erase(found);
  if (ready_) send(RemoveEndpoint{id});
}

bool DomainLink::write(const WriteSample& sample, std::span<const std::byte> payload) {
  if (!ready_) return false;
  const std::scoped_lock lock(write_mutex_);
  DdsRequest request = sample;
  encode(request, head_);
  return sandbox_->send(head_, payload);
}

}  // namespace cellmirror::dds
