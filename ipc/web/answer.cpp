#include "ipc/web/answer.hpp"

#include <fmt/format.h>

#include <array>
#include <ctime>
#include <memory>
#include <utility>

#include "rt_core/base/wall_clock.hpp"

namespace cellmirror::web {

namespace {

// RFC 9110, section 15, and RFC 6585.
std::string_view reason(int status) {
  switch (status) {
    case 200:
      return "OK";
    case 304:
      return "Not Modified";
    case 400:
      return "Bad Request";
    case 401:
      return "Unauthorized";
    case 403:
      return "Forbidden";
    case 404:
      return "Not Found";
    case 405:
      return "Method Not Allowed";
    case 408:
      return "Request Timeout";
    case 413:
      return "Content Too Large";
    case 414:
      return "URI Too Long";
    case 421:
      return "Misdirected Request";
    case 426:
      return "Upgrade Required";
    case 429:
      return "Too Many Requests";
    case 431:
      return "Request Header Fields Too Large";
    case 501:
      return "Not Implemented";
    case 503:
      return "Service Unavailable";
    case 504:
      return "Gateway Timeout";
    case 505:
      return "HTTP Version Not Supported";
    default:
      return "Error";
  }
}

std::string http_date(Timestamp now) {
  const std::time_t wall = machine_wall_clock_ns(now) / 1'000'000'000;
  std::tm parts{};
  gmtime_r(&wall, &parts);
  std::array<char, 64> text{};
  const std::size_t length = std::strftime(text.data(), text.size(), "%a, %d %b %Y %H:%M:%S GMT", &parts);
  return {text.data(), length};
}

// No resources from other hosts, no framing of the page, no guessing of content types.
constexpr std::string_view kSecurityHeaders =
    "Content-Security-Policy: default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:; "
    "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'\r\n"
    "X-Content-Type-Options: nosniff\r\n"
    "X-Frame-Options: DENY\r\n"
    "Referrer-Policy: no-referrer\r\n"
    "Cross-Origin-Resource-Policy: same-origin\r\n"
    "Cross-Origin-Opener-Policy: same-origin\r\n"
    "Permissions-Policy: camera=(), microphone=(), geolocation=()\r\n";

bool takes_gzip(const HttpRequest& request) { return request.header_has("accept-encoding", "gzip"); }

}  // namespace

Answer text_answer(int status, std::string text) {
  Answer out;
  out.status = status;
  if (!text.ends_with('\n')) text += '\n';
  out.body = chunk_of(std::move(text));
  return out;
}

Answer json_answer(std::string text) {
  Answer out;
  out.content_type = "application/json";
  out.body = chunk_of(std::move(text));
  return out;
}

Answer document_answer(const Document& document) {
  Answer out;
  out.status = document.status;
  out.content_type = document.content_type;
  out.body = {document.bytes, *document.bytes};
  return out;
}

Answer picture_answer(Result<EncodedImage> picture) {
  if (!picture) return text_answer(503, picture.error().text());
  Answer out;
  out.content_type = picture->format == ImageFormat::png ? "image/png" : "image/jpeg";
  const auto kept = std::make_shared<const EncodedImage>(std::move(*picture));
  out.body = {kept, {reinterpret_cast<const char*>(kept->bytes.data()), kept->bytes.size()}};
  return out;
}

Answer geometry_answer(const Result<std::shared_ptr<const SceneGeometry>>& geometry, std::string_view known) {
  if (!geometry) return text_answer(503, geometry.error().text());
  const std::string etag = fmt::format("\"{:016x}\"", (*geometry)->hash);
  Answer out;
  out.content_type = "model/gltf-binary";
  out.headers.emplace_back("ETag", etag);
  out.headers.emplace_back("Cache-Control", "no-cache");
  if (known.find(etag) != std::string_view::npos) {
    out.status = 304;
    return out;
  }
  out.body = {*geometry, (*geometry)->glb};
  return out;
}

Answer file_answer(const PageFile& file, const HttpRequest& request) {
  Answer out;
  out.content_type = file.content_type;
  out.headers.emplace_back("ETag", std::string(file.etag));
  // Revalidated each time, so that the page of a newer gateway is shown at once.
  out.headers.emplace_back("Cache-Control", "no-cache");
  out.headers.emplace_back("Vary", "Accept-Encoding");
  if (request.header_has("if-none-match", file.etag)) {
    out.status = 304;
    return out;
  }
  const bool gzip = !file.gzip.empty() && takes_gzip(request);
  if (gzip) out.headers.emplace_back("Content-Encoding", "gzip");
  out.body = chunk_of_constant(gzip ? file.gzip : file.bytes);
  return out;
}

std::string head_of(const Answer& answer, Timestamp now) {
  std::string out = fmt::format("HTTP/1.1 {} {}\r\nDate: {}\r\n{}Connection: close\r\n", answer.status,
                                reason(answer.status), http_date(now), kSecurityHeaders);
  bool cached = false;
  for (const auto& [name, value] : answer.headers) {
    out += fmt::format("{}: {}\r\n", name, value);
    cached = cached || name == "Cache-Control";
  }
  if (!cached) out += "Cache-Control: no-store\r\n";
  if (answer.status != 304)
    out += fmt::format("Content-Type: {}\r\nContent-Length: {}\r\n", answer.content_type, answer.body.bytes.size());
  return out + "\r\n";
}

}  // namespace cellmirror::web
