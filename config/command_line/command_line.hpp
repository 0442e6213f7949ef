// Command lines: options, flags, positionals and subcommands of a program, its help and its messages about wrong usage.
// Based on CLI11, which only command_line.cpp includes, since it adds seconds of compile time. Main thread, before
// anything else is started.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace cellmirror::cli {

inline constexpr int kExitWrongUsage = 2;
// Alone on the command line of any of our programs: prints all of its options and subcommands as JSON, from which
// cmake/command_pages.py makes manual pages and completion. Not in the help: it is no option for people.
inline constexpr std::string_view kDescribe = "--describe-command-line";

// One option of a command: a handle, valid as long as the CommandLine. Each call gives the option back.
class Option {
 public:
  Option& required();
  // The value that the variable has now is shown in the help.
  Option& show_default();
  // Bounds that belong to the range; the kind of number is shown in the help. Takes nan where the option does.
  Option& between(double least, double most);
  Option& between(int least, int most);
  Option& positive();
  Option& one_of(std::vector<std::string> words);
  // `wrong` returns the error of the text, or nothing; `shown` follows the kind of value in the help.
  Option& check(std::function<std::string(const std::string&)> wrong, std::string shown);
  Option& excludes(Option other);
  Option& needs(Option other);
  // Exactly so many values follow it.
  Option& values(int count);
  // "1,2,3" is a list of three.
  Option& list_divided_by(char delimiter);
  // An option that may be repeated takes one value each time, so that a positional may follow.
  Option& one_value_each();

 private:
  friend class Command;
  explicit Option(CLI::Option* option) : option_(option) {}

  CLI::Option* option_;
};

// A program or one of its subcommands: a handle, valid as long as the CommandLine. The variables outlive the parsing.
class Command {
 public:
  // `names`: "--rate", "-q,--quiet", or "file" for a positional.
  Option option(const std::string& names, std::string& value, const std::string& help);
  Option option(const std::string& names, bool& value, const std::string& help) = delete;  // a flag
  Option option(const std::string& names, int& value, const std::string& help);
  Option option(const std::string& names, unsigned& value, const std::string& help);
  Option option(const std::string& names, std::uint64_t& value, const std::string& help);
  Option option(const std::string& names, double& value, const std::string& help);
  Option option(const std::string& names, std::optional<std::string>& value, const std::string& help);
  Option option(const std::string& names, std::optional<int>& value, const std::string& help);
  Option option(const std::string& names, std::optional<std::uint64_t>& value, const std::string& help);
  Option option(const std::string& names, std::optional<double>& value, const std::string& help);
  Option option(const std::string& names, std::vector<std::string>& value, const std::string& help);
  Option option(const std::string& names, std::vector<double>& value, const std::string& help);
  // "--sync,!--no-sync" has a way to say no.
  Option flag(const std::string& names, bool& value, const std::string& help);

  Command subcommand(const std::string& name, const std::string& description);
  // One of the subcommands has to be named.
  void require_subcommand();
  void footer(const std::string& text);
  // Called after everything was read, where this command was named. Before it `wrong`, where given: a sentence that it
  // gives back is wrong usage, and nothing is wrong where it is empty.
  void when_named(std::function<void()> action, std::function<std::string()> wrong = {});
  [[nodiscard]] bool named() const;

 protected:
  explicit Command(CLI::App* app) : app_(app) {}

 private:
  CLI::App* app_;
};

class CommandLine : public Command {
 public:
  // `name` of the program, empty: as it was started; `description` begins the help.
  explicit CommandLine(const std::string& description, const std::string& name = {});
  ~CommandLine();
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;

  // --version.
  void version(const std::string& text);
  // Nothing if the program is to continue; else its exit status: 0 after help or version were printed, kExitWrongUsage
  // after a message. What an action of when_named() throws is passed on.
  [[nodiscard]] std::optional<int> parse(int argc, const char* const* argv);

 private:
  explicit CommandLine(std::unique_ptr<CLI::App> app);

  std::unique_ptr<CLI::App> root_;
};

}  // namespace cellmirror::cli
