#include "config/web_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "config/stream_reader.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror {

namespace {

constexpr std::size_t kMostOrigins = 16;

bool is_loopback(std::string_view address) { return address.starts_with("127.") || address == "::1"; }

// "http://host[:port]" or "https://host[:port]", nothing behind it; or "file://", which programs on the desktop send
// that show pages of their own.
bool is_origin(std::string_view text) {
  if (text == "file://") return true;
  const std::size_t scheme = text.starts_with("http://") ? 7 : text.starts_with("https://") ? 8 : 0;
  constexpr std::size_t kLongestHost = 255;
  const std::string_view host = text.substr(scheme);
  return scheme > 0 && !host.empty() && host.size() <= kLongestHost && std::ranges::all_of(host, [](char c) {
           constexpr std::string_view kOthers = "-.:[]";
           return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                  kOthers.find(c) != std::string_view::npos;
         });
}

}  // namespace

std::string read_page_address(TableReader& table, const std::string& otherwise) {
  const auto given = read_own_address(table, "address");
  const bool remote = table.boolean("allow_remote").value_or(false);
  const std::string address = given.value_or(otherwise);
  if (is_loopback(address)) {
    if (remote)
      table.diagnostics().warning(
          table.place("allow_remote"), fmt::format("allow_remote has no effect with the address {}", address),
          "remove it; otherwise a later change of the address opens the page to other machines");
  } else if (remote) {
    table.diagnostics().warning(
        table.place("address"),
        fmt::format("the page at {} is reachable from other machines, without encryption", address),
        "use 127.0.0.1 with a reverse proxy, unless the network is trusted");
  } else {
    table.error("address", fmt::format("the page at {} would be reachable from other machines", address),
                "if intended, add allow_remote = true; the connection is not encrypted");
  }
  return address;
}

WebSettings read_web(TableReader& top) {
  WebSettings settings;
  auto table = top.table("web");
  if (!table) return settings;
  settings.enabled = table->boolean("enabled").value_or(true);
  if (const auto port = table->integer("port", 1, 65535)) settings.port = static_cast<int>(*port);
  settings.address = read_page_address(*table, settings.address);
  settings.read_only = table->boolean("read_only").value_or(false);
  settings.origins = table->texts("origins").value_or(settings.origins);
  if (settings.origins.size() > kMostOrigins) {
    table->error("origins", fmt::format("there are {} origins, but at most {} are allowed", settings.origins.size(),
                                        kMostOrigins));
  }
  for (const std::string& origin : settings.origins) {
    if (!is_origin(origin)) {
      table->error("origins", fmt::format("\"{}\" is not an origin", printable(origin)),
                   "e.g. https://monitor.example.org");
    } else {
      table->diagnostics().warning(
          table->place("origins"),
          fmt::format("pages of {} may show this cell, and command it for users who have the token",
                      origin == "file://" ? "any HTML file on a user's machine" : printable(origin)),
          "remove the origin from origins, unless its pages are trusted");
    }
  }
  table->finish();
  return settings;
}

}  // namespace cellmirror
