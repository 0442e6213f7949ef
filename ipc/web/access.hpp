// Who may ask: against other pages in the same browser (origin), names that were bent to this machine (DNS rebinding),
// and everybody who does not know the token. Pure.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "ipc/web/http_request.hpp"

namespace cellmirror::web {

class AccessRules {
 public:
  // `address`: a numeric address where the server listens; `origins`: e.g. "https://monitor.example.org", of pages that
  // may ask beside its own, as those behind a proxy.
  AccessRules(std::string address, int port, std::vector<std::string> origins);

  // Whether the header Host names this server. On loopback: 127.0.0.1, localhost, [::1]; elsewhere any numeric address;
  // the hosts of `origins` in both cases. A name that somebody else made point to this machine is none of them.
  [[nodiscard]] bool host_allowed(std::string_view host) const;
  // Programs that are no browsers send no Origin: null is allowed.
  [[nodiscard]] bool origin_allowed(const std::string* origin) const;

 private:
  [[nodiscard]] bool is_own_host(std::string_view host) const;

  bool loopback_;
  std::string port_;  // ":8420"
  std::vector<std::string> origins_;
};

// Whether only this machine can reach the address.
[[nodiscard]] bool is_loopback(std::string_view address);
// "http://host[:port]" or "https://...", nothing behind it.
[[nodiscard]] bool is_origin(std::string_view text);

// In a time that depends on the length of `given` alone. An empty token is never right.
[[nodiscard]] bool token_matches(std::string_view given, std::string_view token);
// Of "Authorization: Bearer TOKEN"; empty: there is none.
[[nodiscard]] std::string_view bearer_token(const HttpRequest& request);

// Scripts in browsers cannot add headers to the opening of a WebSocket, but they can name subprotocols: this one, and
// next to it "cellmirror.token." with the token. The server selects the first one.
inline constexpr std::string_view kSubprotocol = "cellmirror.live";
[[nodiscard]] bool offers_subprotocol(const HttpRequest& request);
// The bearer token, or that of the subprotocols; empty: there is none.
[[nodiscard]] std::string opening_token(const HttpRequest& request);

}  // namespace cellmirror::web
