#include "ipc/web/http_request.hpp"

#include <algorithm>
#include <charconv>

#include "rt_core/base/text.hpp"

namespace cellmirror::web {

namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

// tchar of RFC 9110, section 5.6.2.
bool is_token_character(char c) {
  constexpr std::string_view kOthers = "!#$%&'*+-.^_`|~";
  return is_digit(c) || is_letter(c) || kOthers.find(c) != std::string_view::npos;
}

bool is_token(std::string_view text) { return !text.empty() && std::ranges::all_of(text, is_token_character); }

// field-value of RFC 9110, section 5.5: visible characters, blanks, tabs, and bytes beyond ASCII.
bool is_field_value(std::string_view text) {
  return std::ranges::all_of(text, [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte == '\t' || (byte >= 0x20 && byte != 0x7F);
  });
}

int hexadecimal(char c) {
  if (is_digit(c)) return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

ReadHead refuse(int status, std::string why) {
  ReadHead out;
  out.refused = RefusedRequest{status, std::move(why)};
  return out;
}

// Removes and returns the part before `separator`; the separator is removed too.
std::string_view take_until(std::string_view& text, std::string_view separator) {
  const std::size_t end = text.find(separator);
  if (end == std::string_view::npos) return std::exchange(text, {});
  const std::string_view part = text.substr(0, end);
  text.remove_prefix(end + separator.size());
  return part;
}

bool leaves_its_folder(std::string_view path) {
  if (path.find('\\') != std::string_view::npos || path.find('\0') != std::string_view::npos) return true;
  while (!path.empty()) {
    if (take_until(path, "/") == "..") return true;
  }
  return false;
}

std::optional<RefusedRequest> read_target(std::string_view target, HttpRequest& request) {
  if (target.size() > kMaxTargetBytes) return RefusedRequest{414, "the URL is too long"};
  const bool visible = std::ranges::all_of(target, [](char c) { return c > 0x20 && c < 0x7F; });
  if (!target.starts_with('/') || !visible) return RefusedRequest{400, "the path does not begin with /"};
  request.query = target;
  std::string_view rest = request.query;
  const auto path = percent_decoded(take_until(rest, "?"));
  if (!path || leaves_its_folder(*path)) return RefusedRequest{400, "the URL is malformed"};
  request.path = *path;
  request.query = std::string(rest);
  return std::nullopt;
}

std::optional<RefusedRequest> read_request_line(std::string_view line, HttpRequest& request) {
  const std::string_view method = take_until(line, " ");
  const std::string_view target = take_until(line, " ");
  if (!is_token(method) || target.empty()) return RefusedRequest{400, "not an HTTP request"};
  request.method = method;
  if (line != "HTTP/1.1" && line != "HTTP/1.0") return RefusedRequest{505, "only HTTP/1.1 is supported"};
  return read_target(target, request);
}

std::optional<RefusedRequest> read_headers(std::string_view lines, HttpRequest& request) {
  while (!lines.empty()) {
    std::string_view line = take_until(lines, "\r\n");
    const std::size_t colon = line.find(':');
    // A folded line (obs-fold) begins with a space, which is not a token.
    if (colon == std::string_view::npos || !is_token(line.substr(0, colon)) || !is_field_value(line.substr(colon + 1)))
      return RefusedRequest{400, "a header is malformed"};
    if (request.headers.size() == kMaxHeaders) return RefusedRequest{431, "too many headers"};
    request.headers.emplace_back(lower_case(line.substr(0, colon)), trimmed(line.substr(colon + 1)));
  }
  return std::nullopt;
}

std::size_t count(const HttpRequest& request, std::string_view name) {
  return static_cast<std::size_t>(
      std::ranges::count(request.headers, name, [](const auto& header) { return header.first; }));
}

std::optional<RefusedRequest> read_framing(HttpRequest& request, std::size_t most_body) {
  if (count(request, "host") != 1) return RefusedRequest{400, "a request needs exactly one header Host"};
  if (request.header("transfer-encoding") != nullptr) return RefusedRequest{501, "chunked bodies are not supported"};
  const std::size_t lengths = count(request, "content-length");
  if (lengths == 0) return std::nullopt;
  const std::string& text = *request.header("content-length");
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (lengths > 1 || text.empty() || !std::ranges::all_of(text, is_digit))
    return RefusedRequest{400, "Content-Length is malformed"};
  if (error != std::errc{} || end != text.data() + text.size() || value > most_body)
    return RefusedRequest{413, "the body is too large"};
  request.body_bytes = static_cast<std::size_t>(value);
  return std::nullopt;
}

}  // namespace

const std::string* HttpRequest::header(std::string_view name) const {
  const auto found =
      std::ranges::find(headers, name, [](const auto& header) { return std::string_view(header.first); });
  return found == headers.end() ? nullptr : &found->second;
}

bool HttpRequest::header_has(std::string_view name, std::string_view word) const {
  return std::ranges::any_of(headers, [&](const auto& header) {
    if (header.first != name) return false;
    std::string_view rest = header.second;
    while (!rest.empty()) {
      if (equal_ignoring_case(trimmed(take_until(rest, ",")), word)) return true;
    }
    return false;
  });
}

ReadHead read_http_head(std::string_view bytes, std::size_t most_body) {
  const std::size_t end = bytes.substr(0, kMaxHeadBytes).find("\r\n\r\n");
  if (end == std::string_view::npos) {
    if (bytes.size() >= kMaxHeadBytes) return refuse(431, "the head of the request is too long");
    // Refused early where the first line cannot be a request line.
    const std::string_view first = bytes.substr(0, bytes.find("\r\n"));
    if (!std::ranges::all_of(first, [](char c) { return c >= 0x20 && c < 0x7F; }) && !first.ends_with('\r'))
      return refuse(400, "not an HTTP request");
    return {};
  }
  std::string_view head = bytes.substr(0, end + 2);
  ReadHead out;
  out.bytes = end + 4;
  out.refused = read_request_line(take_until(head, "\r\n"), out.request);
  if (!out.refused) out.refused = read_headers(head, out.request);
  if (!out.refused) out.refused = read_framing(out.request, most_body);
  return out;
}

std::optional<std::string> percent_decoded(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      out += text[i];
      continue;
    }
    if (i + 2 >= text.size()) return std::nullopt;
    const int high = hexadecimal(text[i + 1]);
    const int low = hexadecimal(text[i + 2]);
    if (high < 0 || low < 0) return std::nullopt;
    out += static_cast<char>(high * 16 + low);
    i += 2;
  }
  return out;
}

std::optional<std::vector<std::pair<std::string, std::string>>> query_parts(std::string_view query) {
  constexpr std::size_t kMostParts = 32;
  std::vector<std::pair<std::string, std::string>> parts;
  while (!query.empty()) {
    std::string part(take_until(query, "&"));
    std::ranges::replace(part, '+', ' ');
    std::string_view value = part;
    const auto name = percent_decoded(take_until(value, "="));
    const auto decoded = percent_decoded(value);
    if (!name || !decoded || parts.size() == kMostParts) return std::nullopt;
    if (!name->empty()) parts.emplace_back(*name, *decoded);
  }
  return parts;
}

}  // namespace cellmirror::web
