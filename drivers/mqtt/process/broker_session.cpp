#include "drivers/mqtt/process/broker_session.hpp"

#include <fmt/format.h>
#include <mosquitto.h>
#include <mqtt_protocol.h>
#include <poll.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <mutex>
#include <utility>

#include "drivers/mqtt/process/reasons.hpp"

namespace cellmirror::mqtt {

namespace {

constexpr int kFirstRefusal = 128;             // of the reason codes of MQTT 5 (2.4)
constexpr std::uint32_t kMostPacket = 65'536;  // that the broker may send, so that it cannot fill the memory
constexpr int kTlsReads = 16;
constexpr int kSubscriptionQos = 2;  // the publisher's choice counts: 4.3
constexpr const char* kSystemAuthorities = "/etc/ssl/certs";

// Without this callback OpenSSL would ask for the password of a key on the terminal.
int no_password(char* /*buffer*/, int /*size*/, int /*write*/, void* /*data*/) { return 0; }

struct Properties {
  mosquitto_property* list = nullptr;

  Properties() = default;
  ~Properties() { mosquitto_property_free_all(&list); }
  Properties(const Properties&) = delete;
  Properties& operator=(const Properties&) = delete;
};

std::string text_property(const mosquitto_property* properties, int which) {
  char* text = nullptr;
  if (mosquitto_property_read_string(properties, which, &text, false) == nullptr) return {};
  std::string out(text);
  std::free(text);
  return out;
}

std::string binary_property(const mosquitto_property* properties, int which) {
  void* data = nullptr;
  std::uint16_t size = 0;
  if (mosquitto_property_read_binary(properties, which, &data, &size, false) == nullptr) return {};
  std::string out(static_cast<const char*>(data), size);
  std::free(data);
  return out;
}

// Once a process; what it allocates stays until the end.
void prepare_library() {
  static std::once_flag once;
  std::call_once(once, [] { mosquitto_lib_init(); });
}

}  // namespace

struct BrokerSession::Impl {
  mosquitto* client = nullptr;
  bool old_protocol = false;
  bool tls = false;
  std::uint16_t port = 0;
  int keep_alive_s = 10;
  Events report;
  std::optional<Error> end;
  std::map<int, std::int32_t> numbers;                 // cellmirror's, by the library's
  std::vector<std::pair<int, std::string>> confirmed;  // by the library's numbers; a refusal may be given
  std::string library_error;                           // the last one that it logged

  Impl() = default;
  ~Impl() { mosquitto_destroy(client); }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  static Impl& of(void* object) { return *static_cast<Impl*>(object); }

  void ended(const Error& why) {
    if (!end) end = why;
  }
  void check(int code) {
    if (code != MOSQ_ERR_SUCCESS) ended(connection_lost(code, library_error));
  }

  static void on_connect(mosquitto*, void* object, int code, int /*flags*/, const mosquitto_property*) {
    Impl& self = of(object);
    if (code == 0) {
      self.report.accepted();
    } else {
      self.ended(connect_refused(code, self.old_protocol));
    }
  }

  static void on_disconnect(mosquitto*, void* object, int code, const mosquitto_property*) {
    Impl& self = of(object);
    self.ended(connection_lost(code, self.library_error));
  }

  static void on_publish(mosquitto*, void* object, int number, int code, const mosquitto_property*) {
    of(object).confirmed.emplace_back(
        number, code >= kFirstRefusal ? std::string(mosquitto_reason_string(code)) : std::string());
  }

  static void on_subscribe(mosquitto*, void* object, int, int count, const int* granted, const mosquitto_property*) {
    for (int i = 0; i < count; ++i) {
      if (granted[i] >= kFirstRefusal) of(object).report.subscription_refused(mosquitto_reason_string(granted[i]));
    }
  }

  static void on_message(mosquitto*, void* object, const mosquitto_message* message,
                         const mosquitto_property* properties) {
    MessageReceived event;
    event.topic = message->topic;
    event.retained = message->retain;
    event.response_topic = text_property(properties, MQTT_PROP_RESPONSE_TOPIC);
    event.correlation = binary_property(properties, MQTT_PROP_CORRELATION_DATA);
    const auto* first = static_cast<const std::byte*>(message->payload);
    of(object).report.received(event, {first, static_cast<std::size_t>(std::max(message->payloadlen, 0))});
  }

  static void on_log(mosquitto*, void* object, int level, const char* text) {
    if (level == MOSQ_LOG_ERR) of(object).library_error = text;
  }

  void set_callbacks() const {
    mosquitto_connect_v5_callback_set(client, on_connect);
    mosquitto_disconnect_v5_callback_set(client, on_disconnect);
    mosquitto_publish_v5_callback_set(client, on_publish);
    mosquitto_subscribe_v5_callback_set(client, on_subscribe);
    mosquitto_message_v5_callback_set(client, on_message);
    mosquitto_log_callback_set(client, on_log);
  }

  [[nodiscard]] int set_tls(const ConnectBroker& config) const {
    if (!config.tls) return MOSQ_ERR_SUCCESS;
    const auto given = [](const std::string& file) { return file.empty() ? nullptr : file.c_str(); };
    const int code =
        mosquitto_tls_set(client, given(config.ca_file), config.ca_file.empty() ? kSystemAuthorities : nullptr,
                          given(config.certificate), given(config.key), no_password);
    if (code != MOSQ_ERR_SUCCESS) return code;
    return mosquitto_tls_opts_set(client, 1, "tlsv1.2", nullptr);  // or later
  }

  [[nodiscard]] int set_up(const ConnectBroker& wanted) const {
    int code =
        mosquitto_int_option(client, MOSQ_OPT_PROTOCOL_VERSION, old_protocol ? MQTT_PROTOCOL_V311 : MQTT_PROTOCOL_V5);
    if (code == MOSQ_ERR_SUCCESS) code = mosquitto_int_option(client, MOSQ_OPT_TCP_NODELAY, 1);
    if (code == MOSQ_ERR_SUCCESS) code = set_tls(wanted);
    if (code == MOSQ_ERR_SUCCESS && wanted.has_credentials)
      code = mosquitto_username_pw_set(client, wanted.user.c_str(), wanted.password.c_str());
    if (code == MOSQ_ERR_SUCCESS)
      code = mosquitto_will_set(client, wanted.will_topic.c_str(), static_cast<int>(wanted.will_payload.size()),
                                wanted.will_payload.data(), wanted.will_qos, wanted.will_retain);
    return code;
  }

  void read_and_write(short events) {
    if ((events & (POLLIN | POLLERR | POLLHUP)) != 0) {
      // TLS may have decrypted further packets already, which poll() does not report.
      for (int i = 0; i < (tls ? kTlsReads : 1) && !end; ++i) check(mosquitto_loop_read(client, 1));
    }
    if (!end && mosquitto_want_write(client)) check(mosquitto_loop_write(client, 1));
    if (!end) check(mosquitto_loop_misc(client));
  }
};

BrokerSession::BrokerSession(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
BrokerSession::~BrokerSession() = default;

Result<std::unique_ptr<BrokerSession>> BrokerSession::make(const ConnectBroker& wanted, Events events) {
  prepare_library();
  auto impl = std::make_unique<Impl>();
  impl->client = mosquitto_new(wanted.client_id.c_str(), true, impl.get());
  if (impl->client == nullptr) return fail("the library for MQTT has no memory");
  impl->old_protocol = wanted.old_protocol;
  impl->tls = wanted.tls;
  impl->port = wanted.port;
  impl->keep_alive_s = wanted.keep_alive_s;
  impl->report = std::move(events);
  impl->set_callbacks();
  if (const int code = impl->set_up(wanted); code != MOSQ_ERR_SUCCESS) {
    const Error why = connection_lost(code, impl->library_error);
    return fail(fmt::format("the connection cannot be prepared: {}", why.what),
                why.remedy.empty() ? "look at ca_file, certificate and key of [mqtt]" : why.remedy);
  }
  return std::unique_ptr<BrokerSession>(new BrokerSession(std::move(impl)));
}

Result<void> BrokerSession::connect(const std::string& host) {
  Properties properties;
  if (!impl_->old_protocol) mosquitto_property_add_int32(&properties.list, MQTT_PROP_MAXIMUM_PACKET_SIZE, kMostPacket);
  const int code = mosquitto_connect_bind_v5(impl_->client, host.c_str(), impl_->port, impl_->keep_alive_s, nullptr,
                                             properties.list);
  if (code != MOSQ_ERR_SUCCESS) impl_->ended(connection_lost(code, impl_->library_error));
  if (impl_->end) return std::unexpected(*impl_->end);
  return {};
}

const std::optional<Error>& BrokerSession::end() const { return impl_->end; }

void BrokerSession::subscribe(const std::string& topic) {
  impl_->check(mosquitto_subscribe(impl_->client, nullptr, topic.c_str(), kSubscriptionQos));
}

void BrokerSession::publish(const PublishMessage& message, std::span<const std::byte> payload) {
  Properties properties;
  if (!message.correlation.empty() && !impl_->old_protocol)
    mosquitto_property_add_binary(&properties.list, MQTT_PROP_CORRELATION_DATA, message.correlation.data(),
                                  static_cast<std::uint16_t>(message.correlation.size()));
  int number = 0;
  const int code = mosquitto_publish_v5(impl_->client, &number, message.topic.c_str(), static_cast<int>(payload.size()),
                                        payload.data(), message.qos, message.retain, properties.list);
  if (code == MOSQ_ERR_SUCCESS) {
    impl_->numbers[number] = message.number;
  } else {
    impl_->report.confirmed({message.number, true, connection_lost(code, impl_->library_error).text()});
  }
  report_confirmed();
}

void BrokerSession::report_confirmed() {
  for (auto& [number, refusal] : std::exchange(impl_->confirmed, {})) {
    const auto found = impl_->numbers.find(number);
    if (found == impl_->numbers.end()) continue;
    impl_->report.confirmed({found->second, false, std::move(refusal)});
    impl_->numbers.erase(found);
  }
}

int BrokerSession::socket() const { return mosquitto_socket(impl_->client); }

bool BrokerSession::wants_to_write() const { return mosquitto_want_write(impl_->client); }

void BrokerSession::read_and_write(short events) {
  if (socket() < 0) {
    impl_->ended(connection_lost(MOSQ_ERR_CONN_LOST, {}));
  } else {
    impl_->read_and_write(events);
  }
  report_confirmed();
}

void BrokerSession::disconnect() { mosquitto_disconnect(impl_->client); }

}  // namespace cellmirror::mqtt
