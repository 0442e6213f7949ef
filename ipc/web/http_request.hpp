// A strict parser for the head of an HTTP/1.1 request (RFC 9112). Pure: bytes in, no I/O.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace cellmirror::web {

inline constexpr std::size_t kMaxHeadBytes = 8 * 1024;
inline constexpr std::size_t kMaxHeaders = 64;
inline constexpr std::size_t kMaxTargetBytes = 2048;

struct HttpRequest {
  std::string method;
  std::string path;   // decoded; begins with '/', contains no "..", no NUL and no backslash
  std::string query;  // as received, without '?'
  std::vector<std::pair<std::string, std::string>> headers;  // names in lower case; values trimmed
  std::size_t body_bytes = 0;                                // Content-Length

  // The value of the first header of that name (in lower case); null: there is none.
  [[nodiscard]] const std::string* header(std::string_view name) const;
  // Whether a comma-separated header contains that word, ignoring case.
  [[nodiscard]] bool header_has(std::string_view name, std::string_view word) const;
};

struct RefusedRequest {
  int status = 400;  // RFC 9110, section 15
  std::string why;
};

struct ReadHead {
  std::size_t bytes = 0;                  // of the head; 0: incomplete
  std::optional<RefusedRequest> refused;  // then the request is not valid
  HttpRequest request;
};

// Larger bodies than `most_body` and chunked bodies are refused.
[[nodiscard]] ReadHead read_http_head(std::string_view bytes, std::size_t most_body);

// Decodes %XX; none where % is not followed by two hexadecimal digits.
[[nodiscard]] std::optional<std::string> percent_decoded(std::string_view text);
// "a=1&b=x%20y", in order; '+' means a space. None where it is malformed or has more than 32 parts.
[[nodiscard]] std::optional<std::vector<std::pair<std::string, std::string>>> query_parts(std::string_view query);

}  // namespace cellmirror::web
