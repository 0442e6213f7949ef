// A SCRIPT command from outside, on its way to its execution: what, from where, and who gets the result.
#pragma once

#include <concepts>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

#include "rt_core/base/result.hpp"

namespace cellmirror::script {

// For errors, the log and the counters.
struct CommandSource {
  // message: the SCRIPT queue; page: the monitor page; mqtt: a broker; file: a SCRIPT file; program: a comment of a
  // robot program.
  enum class Kind : std::uint8_t { message, page, mqtt, file, program };

  Kind kind = Kind::message;
  std::int32_t process = 0;  // of a message; 0: unknown
  std::string place = {};    // of a file or a program: "scripts/a.spt", "K1/BOX.src:12"
  // For the log of commands.
  std::optional<std::uint32_t> user = {};  // of the process of a message
  std::uint64_t session = 0;               // of the page
  std::string peer = {};  // of the page: who is at the other end of the connection; of MQTT: the broker

  [[nodiscard]] static CommandSource message(std::int32_t process, std::optional<std::uint32_t> user = {}) {
    return {.kind = Kind::message, .process = process, .place = {}, .user = user};
  }
  [[nodiscard]] static CommandSource page(std::uint64_t session = 0, std::string peer = {}) {
    return {.kind = Kind::page, .process = 0, .place = {}, .user = {}, .session = session, .peer = std::move(peer)};
  }

  // The broker does not say who has published a command.
  [[nodiscard]] static CommandSource mqtt(std::string broker) {
    return {.kind = Kind::mqtt, .process = 0, .place = {}, .user = {}, .session = 0, .peer = std::move(broker)};
  }

  // "message from process 12", "monitor page", "MQTT", the place
  [[nodiscard]] std::string text() const;
};

// Answers a command exactly once: when it is called or, if it never is, with a refusal when it is destroyed. Moved, not
// copied. One thread at a time.
class CommandReply {
 public:
  using Result = cellmirror::Result<std::string>;  // a text for the acknowledgement, or why it was refused

  // No answer is wanted.
  CommandReply() = default;
  template <class Function>
    requires(!std::is_same_v<std::remove_cvref_t<Function>, CommandReply> && std::invocable<Function&, const Result&>)
  CommandReply(Function&& function) : answer_(std::forward<Function>(function)) {}  // NOLINT: a lambda is a reply
  CommandReply(CommandReply&& other) noexcept : answer_(std::exchange(other.answer_, nullptr)) {}
  CommandReply& operator=(CommandReply&& other) noexcept {
    if (this != &other) {
      end();
      answer_ = std::exchange(other.answer_, nullptr);
    }
    return *this;
  }
  ~CommandReply() { end(); }

  // Whether an answer is still to be given.
  [[nodiscard]] bool wanted() const { return static_cast<bool>(answer_); }
  void operator()(const Result& result) {
    if (auto answer = std::exchange(answer_, nullptr)) answer(result);
  }

 private:
  void end();

  std::move_only_function<void(const Result&)> answer_;
};

struct ScriptCommand {
  std::string text;  // one command; valid UTF-8, not empty
  CommandSource source;
  CommandReply reply;
};

}  // namespace cellmirror::script
