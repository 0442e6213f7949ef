#include "drivers/mqtt/process/reasons.hpp"

#include <fmt/format.h>
#include <mosquitto.h>
#include <mqtt_protocol.h>

#include <cerrno>
#include <cstring>

#include "rt_core/base/text.hpp"

namespace cellmirror::mqtt {

namespace {

constexpr int kFirstError = 128;  // of the reason codes of MQTT 5 (2.4)
constexpr std::size_t kMostDetails = 200;
// mosquitto 2.0 ends the connection without a reason if another client connects with the same id.
constexpr const char* kRemedyOfLost =
    "look at the broker and at the network, and whether another client has the same client_id";

std::string remedy_of(int code) {
  switch (code) {
    case MQTT_RC_UNSUPPORTED_PROTOCOL_VERSION:
      return R"(set protocol = "3.1.1" in [mqtt])";
    case MQTT_RC_CLIENTID_NOT_VALID:
      return "set another client_id in [mqtt]";
    case MQTT_RC_BAD_USERNAME_OR_PASSWORD:
      return "correct the file that credentials of [mqtt] names";
    case MQTT_RC_NOT_AUTHORIZED:
    case MQTT_RC_BANNED:
      return "give the user of [mqtt] the right to connect, or correct its credentials";
    case MQTT_RC_SESSION_TAKEN_OVER:
      return "another client has the same client_id: give each gateway its own in [mqtt]";
    default:
      return {};
  }
}

// The codes of 3.1.1 as those of 5.
int code_of_old(int code) {
  switch (code) {
    case 1:
      return MQTT_RC_UNSUPPORTED_PROTOCOL_VERSION;
    case 2:
      return MQTT_RC_CLIENTID_NOT_VALID;
    case 3:
      return MQTT_RC_SERVER_UNAVAILABLE;
    case 4:
      return MQTT_RC_BAD_USERNAME_OR_PASSWORD;
    case 5:
      return MQTT_RC_NOT_AUTHORIZED;
    default:
      return code;
  }
}

}  // namespace

Error connect_refused(int code, bool old_protocol) {
  if (old_protocol) code = code_of_old(code);
  // A broker that does not know MQTT 5 answers with the code of 3.1.1.
  if (code == 1) code = MQTT_RC_UNSUPPORTED_PROTOCOL_VERSION;
  return {fmt::format("the broker refuses the connection: {}", mosquitto_reason_string(code)), remedy_of(code)};
}

Error connection_lost(int code, const std::string& details) {
  const std::string more = details.empty() ? std::string() : fmt::format(" ({})", printable(details, kMostDetails));
  if (code >= kFirstError)
    return {fmt::format("the broker ended the connection: {}{}", mosquitto_reason_string(code), more), remedy_of(code)};
  switch (code) {
    case MOSQ_ERR_SUCCESS:
    case MOSQ_ERR_CONN_LOST:
      return {"the connection was lost" + more, kRemedyOfLost};
    case MOSQ_ERR_ERRNO:
      return {fmt::format("the connection was lost: {}{}", std::strerror(errno), more), kRemedyOfLost};
    case MOSQ_ERR_KEEPALIVE:
      return {"the broker does not answer" + more, "look at its load and at the network"};
    case MOSQ_ERR_TLS:
      return {"TLS failed" + more,
              "look at ca_file, certificate and key of [mqtt], and at the name in the broker's "
              "certificate"};
    default:
      return {fmt::format("{}{}", mosquitto_strerror(code), more), {}};
  }
}

}  // namespace cellmirror::mqtt
