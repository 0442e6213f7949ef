// The address of a running gateway's page and the token for commands: a file in the runtime folder of the instance that
// only its owner can read.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "rt_core/base/result.hpp"

namespace cellmirror::web {

inline constexpr std::string_view kPageAddressFile = "page.json";

struct PageAddress {
  std::string address;  // numeric
  int port = 0;
  std::string token;
  bool read_only = false;

  // "http://127.0.0.1:8420/"
  [[nodiscard]] std::string url() const;
  // With the token in the fragment, which browsers do not send.
  [[nodiscard]] std::string url_with_token() const;
};

// 128 random bits of the kernel, as 32 hexadecimal digits.
[[nodiscard]] Result<std::string> make_token();

// The token in `file`, so that a page keeps its rights over a restart of the gateway. A new one is made where there is
// none or others can read it. The folder exists.
[[nodiscard]] Result<std::string> kept_token(const std::filesystem::path& file);

// Mode 0600.
[[nodiscard]] Result<void> write_page_address(const std::filesystem::path& folder, const PageAddress& page);
[[nodiscard]] Result<PageAddress> read_page_address(const std::filesystem::path& folder);

}  // namespace cellmirror::web
