// cellmirror send 'COMMAND'...: SCRIPT commands by message, one after the other, each with its acknowledgement.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iostream>
#include <memory>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "app/subcommands/command_texts.hpp"
#include "app/subcommands/subcommand.hpp"
#include "config/command_line/command_line.hpp"
#include "ipc/control/control_client.hpp"
#include "ipc/control/instance.hpp"
#include "ipc/control/queue_answer.hpp"
#include "ipc/sysv/script_client.hpp"
#include "rt_core/base/json_writer.hpp"
#include "rt_core/base/text.hpp"
#include "rt_core/base/time.hpp"

namespace cellmirror::app {

namespace {

struct SendOptions {
  std::vector<std::string> commands;
  std::string file;         // "-": standard input
  double timeout_s = 30.0;  // a robot may take so long to arrive
  bool keep_going = false;
  bool json = false;
  std::string instance{kDefaultInstance};
};

constexpr const char* kStandardInput = "-";
constexpr Nanoseconds kQueuesTimeout{5'000'000'000};
constexpr std::chrono::milliseconds kBetweenAttempts{20};
constexpr const char* kStillMoving =
    "; POS_ROB is answered when the robot has arrived, and it may still be on its way: cellmirror status shows it, "
    "--timeout waits longer, STOP_ROB stops it";

bool moves_a_robot(std::string_view command) {
  constexpr std::string_view kWord = "POS_ROB";
  while (!command.empty() && std::isspace(static_cast<unsigned char>(command.front())) != 0) command.remove_prefix(1);
  return command.size() > kWord.size() && equal_ignoring_case(command.substr(0, kWord.size()), kWord);
}

class Sender {
 public:
  enum class Outcome : std::uint8_t { done, refused, not_answered };

  Sender(const SendOptions& options, const InstanceInfo& instance) : options_(options), instance_(instance) {}

  // `place`: in front of what is wrong; empty where there is one command only.
  Outcome send(const std::string& command, const std::string& place) {
    const auto reply = exchange(command);
    const bool done = reply && reply->done;
    const std::string text = reply ? reply->text : reply.error().text() + (moves_a_robot(command) ? kStillMoving : "");
    if (options_.json) {
      print_json(command, done, reply.has_value(), text);
    } else if (done) {
      std::printf("done%s%s\n", text.empty() ? "" : " ", text.c_str());
    }
    std::fflush(stdout);  // in order with standard error, and at once where a program reads it
    if (done) return Outcome::done;
    refuse(fmt::format("{}{}{}", place, reply ? "refused: " : "", text));
    return reply ? Outcome::refused : Outcome::not_answered;
  }

 private:
  [[nodiscard]] Nanoseconds timeout() const { return Nanoseconds(static_cast<std::int64_t>(options_.timeout_s * 1e9)); }

  // A queue may be removed and made again by the gateway at any time, or by another program, which must get nothing.
  Result<void> find_queues() {
    if (known_.script_queue >= 0 && queue_number(instance_.queues.script_key) == known_.script_queue &&
        queue_number(instance_.queues.reply_key) == known_.reply_queue) {
      return {};
    }
    const auto text = ask_for_queues();
    if (!text) return std::unexpected(text.error());
    const auto answer = parse_queue_answer(*text);
    if (!answer) return std::unexpected(answer.error());
    for (const std::string& problem : {answer->script_problem, answer->reply_problem}) {
      if (!problem.empty()) return fail("the command was not sent: " + problem);
    }
    known_ = *answer;
    return {};
  }

  // A gateway that has just been started opens its socket after its queues.
  [[nodiscard]] Result<std::string> ask_for_queues() const {
    const SystemClock clock;
    const Timestamp end = clock.now() + std::min(timeout(), kQueuesTimeout);
    for (;;) {
      const Nanoseconds left = std::max(end - clock.now(), Nanoseconds(kBetweenAttempts));
      auto text = control_request(instance_.name, R"({"request":"queues"})", left);
      if (text || clock.now() > end || !find_instance(instance_.name)) return text;
      std::this_thread::sleep_for(kBetweenAttempts);
    }
  }

  Result<ScriptReply> exchange(const std::string& command) {
    if (const auto found = find_queues(); !found) return std::unexpected(found.error());
    return send_command(instance_.queues, command, timeout(), known_.script_queue);
  }

  static void print_json(const std::string& command, bool done, bool answered, const std::string& text) {
    JsonWriter document;
    document.begin_object().member("command", command).member("done", done).member("answered", answered);
    document.member("text", text).end_object();
    std::printf("%s\n", document.take().c_str());
  }

  const SendOptions& options_;
  const InstanceInfo& instance_;
  QueueAnswer known_;
};

// What is sent decides: it ends at the first refusal unless it is to keep going, and in any case where nobody answers.
class Tally {
 public:
  explicit Tally(bool keep_going) : keep_going_(keep_going) {}
  // True: go on.
  bool note(Sender::Outcome outcome) {
    if (outcome == Sender::Outcome::done) return true;
    exit_ = kExitRefused;
    return keep_going_ && outcome == Sender::Outcome::refused;
  }
  [[nodiscard]] int exit() const { return exit_; }

 private:
  bool keep_going_;
  int exit_ = kExitDone;
};

int send_all(Sender& sender, const SendOptions& options) {
  Tally tally(options.keep_going);
  const bool several = options.commands.size() > 1;
  for (std::size_t i = 0; i < options.commands.size(); ++i) {
    const std::string& command = options.commands[i];
    if (!tally.note(sender.send(command, several ? fmt::format("command {} ({}): ", i + 1, command) : ""))) break;
  }
  return tally.exit();
}

int send_text(Sender& sender, const SendOptions& options, std::istream& in, const std::string& name) {
  Tally tally(options.keep_going);
  for (CommandTexts texts(in);;) {
    const auto command = texts.next();
    if (!command) return refuse(fmt::format("{}: {}", name, command.error().text()));
    if (command->empty()) return tally.exit();
    if (!tally.note(sender.send(*command, fmt::format("{}:{}: ", name, texts.line())))) return tally.exit();
  }
}

int send(const SendOptions& options) {
  const auto instance = find_instance(options.instance);
  if (!instance) return refuse(instance.error().text());
  Sender sender(options, *instance);
  if (options.file.empty()) return send_all(sender, options);
  if (options.file == kStandardInput) return send_text(sender, options, std::cin, "standard input");
  std::ifstream in(options.file, std::ios::binary);
  if (!in || in.peek() == std::ifstream::traits_type::eof()) {
    if (!in.eof()) return refuse(fmt::format("{} cannot be read: {}", options.file, std::strerror(errno)));
    return kExitDone;  // an empty one
  }
  return send_text(sender, options, in, options.file);
}

// "-" in place of a command is a file as well.
std::string check(SendOptions& options) {
  const bool piped = options.commands.size() == 1 && options.commands.front() == kStandardInput;
  if (piped && options.file.empty()) {
    options.file = kStandardInput;
    options.commands.clear();
  }
  if (options.commands.empty() == options.file.empty())
    return "name commands, or a file of them: cellmirror send 'COMMAND'..., --file F, or - for standard input";
  return {};
}

}  // namespace

void add_send(cli::Command program, Action& action) {
  auto options = std::make_shared<SendOptions>();
  cli::Command sub = program.subcommand(
      "send", "Send SCRIPT commands to the running gateway, one after the other, and print their acknowledgements");
  sub.option("commands", options->commands, "the commands, each in quotes; - reads them from standard input");
  sub.option("--file", options->file, "send the commands of this file, - for standard input; each ends with ';'");
  sub.flag("--keep-going", options->keep_going, "continue after a refused command");
  sub.flag("--json", options->json, "one JSON object a command (docs/messages.md)");
  sub.option("--timeout", options->timeout_s, "seconds to wait for each acknowledgement").positive().show_default();
  sub.option("--instance", options->instance, "name of the gateway").show_default();
  sub.footer(
      "Ends at the first command that is refused, with status 1.\n"
      "Examples:\n"
      "  cellmirror send 'ROBOT PUMA_762 online'\n"
      "  cellmirror send 'TF_LOAD hs1 ZELLENKRAN' 'TF_RUN hs1 ZELLENKRAN' 'TF_WAIT ZELLENKRAN'\n"
      "  cellmirror send --file setup.spt --keep-going\n"
      "  echo 'ROBACT PUMA_762; DRAW_SCENE' | cellmirror send - --json\n"
      "List of commands: cellmirror commands");
  sub.when_named([options, &action] { action = [options] { return send(*options); }; },
                 [options] { return check(*options); });
}

}  // namespace cellmirror::app
