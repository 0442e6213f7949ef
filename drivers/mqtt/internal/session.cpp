#include "drivers/mqtt/internal/session.hpp"

#include <fmt/format.h>
#include <mosquitto.h>
#include <mqtt_protocol.h>
#include <poll.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <mutex>
#include <utility>

#include "drivers/mqtt/internal/reasons.hpp"

namespace cellmirror::mqtt {

namespace {

constexpr int kFirstRefusal = 128;             // of the reason codes of MQTT 5 (2.4)
constexpr std::uint32_t kMostPacket = 65'536;  // that the broker may send, so that it cannot fill the memory
constexpr int kTlsReads = 16;
constexpr int kSubscriptionQos = 2;  // the publisher's choice counts: 4.3
constexpr const char* kSystemAuthorities = "/etc/ssl/certs";

// Where a key has a password there is nobody to ask: without this one OpenSSL asks on the terminal.
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

struct Session::Impl {
  mosquitto* client = nullptr;
  bool old_protocol = false;
  bool tls = false;
  std::uint16_t port = 0;
  int keep_alive_s = 10;
  std::function<void(const Incoming&)> received;
  bool accepted = false;
  std::optional<Error> end;
  std::string refused_subscription;
  std::vector<Confirmation> confirmations;
  std::string library_error;  // the last one that it logged

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
      self.accepted = true;
    } else {
      self.ended(connect_refused(code, self.old_protocol));
    }
  }

  static void on_disconnect(mosquitto*, void* object, int code, const mosquitto_property*) {
    Impl& self = of(object);
    self.ended(connection_lost(code, self.library_error));
  }

  static void on_publish(mosquitto*, void* object, int number, int code, const mosquitto_property*) {
    of(object).confirmations.push_back(
        {number, code >= kFirstRefusal ? std::string(mosquitto_reason_string(code)) : std::string()});
  }

  static void on_subscribe(mosquitto*, void* object, int, int count, const int* granted, const mosquitto_property*) {
    for (int i = 0; i < count; ++i) {
      if (granted[i] >= kFirstRefusal) of(object).refused_subscription = mosquitto_reason_string(granted[i]);
    }
  }

  static void on_message(mosquitto*, void* object, const mosquitto_message* message,
                         const mosquitto_property* properties) {
    const std::string response = text_property(properties, MQTT_PROP_RESPONSE_TOPIC);
    const std::string correlation = binary_property(properties, MQTT_PROP_CORRELATION_DATA);
    of(object).received(
        {.topic = message->topic,
         .payload = {static_cast<const char*>(message->payload), static_cast<std::size_t>(message->payloadlen)},
         .retained = message->retain,
         .response_topic = response,
         .correlation = correlation});
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

  [[nodiscard]] int set_tls(const MqttConfig& config) const {
    if (!config.tls) return MOSQ_ERR_SUCCESS;
    const auto given = [](const std::string& file) { return file.empty() ? nullptr : file.c_str(); };
    const int code =
        mosquitto_tls_set(client, given(config.ca_file), config.ca_file.empty() ? kSystemAuthorities : nullptr,
                          given(config.certificate), given(config.key), no_password);
    if (code != MOSQ_ERR_SUCCESS) return code;
    return mosquitto_tls_opts_set(client, 1, "tlsv1.2", nullptr);  // or later
  }

  [[nodiscard]] int set_up(const MqttConfig& config, const std::optional<Credentials>& credentials,
                           const Outgoing& will) const {
    int code =
        mosquitto_int_option(client, MOSQ_OPT_PROTOCOL_VERSION, old_protocol ? MQTT_PROTOCOL_V311 : MQTT_PROTOCOL_V5);
    if (code == MOSQ_ERR_SUCCESS) code = mosquitto_int_option(client, MOSQ_OPT_TCP_NODELAY, 1);
    if (code == MOSQ_ERR_SUCCESS) code = set_tls(config);
    if (code == MOSQ_ERR_SUCCESS && credentials)
      code = mosquitto_username_pw_set(client, credentials->user.c_str(), credentials->password.c_str());
    if (code == MOSQ_ERR_SUCCESS)
      code = mosquitto_will_set(client, will.topic.c_str(), static_cast<int>(will.payload.size()), will.payload.data(),
                                will.qos, will.retain);
    return code;
  }

  void read_and_write(short events) {
    if ((events & (POLLIN | POLLERR | POLLHUP)) != 0) {
      // With TLS several, since more than one packet may have been decrypted already, of which poll() knows nothing.
      for (int i = 0; i < (tls ? kTlsReads : 1) && !end; ++i) check(mosquitto_loop_read(client, 1));
    }
    if (!end && mosquitto_want_write(client)) check(mosquitto_loop_write(client, 1));
    if (!end) check(mosquitto_loop_misc(client));
  }
};

Session::Session(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Session::~Session() = default;

Result<std::unique_ptr<Session>> Session::make(const MqttConfig& config, const std::string& client_id,
                                               const std::optional<Credentials>& credentials, const Outgoing& will,
                                               const std::function<void(const Incoming&)>& received) {
  prepare_library();
  auto impl = std::make_unique<Impl>();
  impl->client = mosquitto_new(client_id.c_str(), true, impl.get());
  if (impl->client == nullptr) return fail("the library for MQTT has no memory");
  impl->old_protocol = config.old_protocol;
  impl->tls = config.tls;
  impl->port = config.port;
  impl->keep_alive_s = config.keep_alive_s;
  impl->received = received;
  impl->set_callbacks();
  if (const int code = impl->set_up(config, credentials, will); code != MOSQ_ERR_SUCCESS) {
    const Error why = connection_lost(code, impl->library_error);
    return fail(fmt::format("the connection cannot be prepared: {}", why.what),
                why.remedy.empty() ? "look at ca_file, certificate and key of [mqtt]" : why.remedy);
  }
  return std::unique_ptr<Session>(new Session(std::move(impl)));
}

Result<void> Session::connect(const std::string& host) {
  Properties properties;
  if (!impl_->old_protocol) mosquitto_property_add_int32(&properties.list, MQTT_PROP_MAXIMUM_PACKET_SIZE, kMostPacket);
  const int code = mosquitto_connect_bind_v5(impl_->client, host.c_str(), impl_->port, impl_->keep_alive_s, nullptr,
                                             properties.list);
  if (code != MOSQ_ERR_SUCCESS) impl_->ended(connection_lost(code, impl_->library_error));
  if (impl_->end) return std::unexpected(*impl_->end);
  return {};
}

bool Session::accepted() const { return impl_->accepted && !impl_->end; }
const std::optional<Error>& Session::end() const { return impl_->end; }
const std::string& Session::refused_subscription() const { return impl_->refused_subscription; }

Result<void> Session::subscribe(const std::string& topic) {
  const int code = mosquitto_subscribe(impl_->client, nullptr, topic.c_str(), kSubscriptionQos);
  if (code != MOSQ_ERR_SUCCESS) return std::unexpected(connection_lost(code, impl_->library_error));
  return {};
}

Result<int> Session::publish(const Outgoing& message) {
  Properties properties;
  if (!message.correlation.empty() && !impl_->old_protocol)
    mosquitto_property_add_binary(&properties.list, MQTT_PROP_CORRELATION_DATA, message.correlation.data(),
                                  static_cast<std::uint16_t>(message.correlation.size()));
  int number = 0;
  const int code =
      mosquitto_publish_v5(impl_->client, &number, message.topic.c_str(), static_cast<int>(message.payload.size()),
                           message.payload.data(), message.qos, message.retain, properties.list);
  if (code != MOSQ_ERR_SUCCESS) return std::unexpected(connection_lost(code, impl_->library_error));
  return number;
}

std::vector<Session::Confirmation> Session::take_confirmations() { return std::exchange(impl_->confirmations, {}); }

void Session::wait(int wake, Nanoseconds timeout) {
  const int socket = mosquitto_socket(impl_->client);
  if (socket < 0) return impl_->ended({"the connection was lost", {}});
  const bool writes = mosquitto_want_write(impl_->client);
  std::array<pollfd, 2> waited{pollfd{socket, static_cast<short>(writes ? POLLIN | POLLOUT : POLLIN), 0},
                               pollfd{wake, POLLIN, 0}};
  const std::int64_t ns = std::max<std::int64_t>(0, timeout.count());
  const timespec limit{ns / 1'000'000'000, ns % 1'000'000'000};
  ::ppoll(waited.data(), waited.size(), &limit, nullptr);
  impl_->read_and_write(waited[0].revents);
}

void Session::disconnect() { mosquitto_disconnect(impl_->client); }

}  // namespace cellmirror::mqtt
