// What a server shows: the files of its page, documents, and a live document. The general part of the server: the
// gateway's (web_backend.hpp) can do more, other sites only show. Called by the threads of the server, several at once.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "ipc/web/page_files.hpp"
#include "rt_core/base/time.hpp"

namespace cellmirror::web {

struct Health {
  bool ok = false;
  std::string text;  // one line: "ok", or what is wrong
};

struct Document {
  int status = 200;  // RFC 9110, section 15
  std::string content_type = "application/json";
  std::shared_ptr<const std::string> bytes;  // not null
};
// Run by another thread than the server's own.
using MakeDocument = std::function<Document()>;

class Backend;

class Site {
 public:
  virtual ~Site() = default;
  // The time source of the server; outlives it.
  [[nodiscard]] virtual const Clock& clock() const = 0;
  // Of the page; they outlive the server.
  [[nodiscard]] virtual std::span<const PageFile> files() const = 0;
  // A JSON object that is sent to all open pages, and how often. Small. Not called while no page is open.
  [[nodiscard]] virtual std::string live_json() = 0;
  [[nodiscard]] virtual Nanoseconds live_period() const { return Nanoseconds(100'000'000); }
  // The document at a path; null: there is none. Server's thread, which must not wait: what takes time is done by what
  // it gives back, which may be called until the server has ended. `query`: as received.
  [[nodiscard]] virtual MakeDocument document(std::string_view path, std::string_view query) = 0;
  [[nodiscard]] virtual Health health() = 0;
  // The same object, where it can also draw, pick and take commands; null: it only shows.
  [[nodiscard]] virtual Backend* gateway() { return nullptr; }
};

}  // namespace cellmirror::web
