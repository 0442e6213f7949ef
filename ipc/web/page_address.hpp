// Where the page of a running gateway is, and the token that lets its owner command: a file in the instance's runtime
// folder that nobody else can read.
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
  // With the token behind '#', where browsers keep it to themselves.
  [[nodiscard]] std::string url_with_token() const;
};

// 128 random bits of the kernel, as 32 hexadecimal digits.
[[nodiscard]] Result<std::string> make_token();

// The token that `file` holds, so that a page that waits for its gateway to come back may still command; where there is
// none, or others may read it, it is made anew. Its folder is there.
[[nodiscard]] Result<std::string> kept_token(const std::filesystem::path& file);

// Mode 0600.
[[nodiscard]] Result<void> write_page_address(const std::filesystem::path& folder, const PageAddress& page);
[[nodiscard]] Result<PageAddress> read_page_address(const std::filesystem::path& folder);

}  // namespace cellmirror::web
