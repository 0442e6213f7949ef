#include "config/command_line/command_line.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <string_view>
#include <utility>

#include "config/command_line/description.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror::cli {

namespace {

// The command that the words named last: what is left over was meant for it.
const CLI::App& named_last(const CLI::App& program) {
  const CLI::App* at = &program;
  for (auto below = at->get_subcommands(); !below.empty(); below = at->get_subcommands()) at = below.back();
  return *at;
}

// "cellmirror volume"
std::string whole_name(const CLI::App& command) {
  const CLI::App* parent = command.get_parent();
  return parent == nullptr ? command.get_name() : whole_name(*parent) + ' ' + command.get_name();
}

// What a word that no command takes may have been: a subcommand or an option with a slip of the pen. Empty where the
// words say nothing about it.
std::string about_unknown_word(const CLI::App& program) {
  const CLI::App& command = named_last(program);
  const std::vector<std::string> left_over = command.remaining();
  if (left_over.empty()) return {};
  const std::string& word = left_over.front();
  const bool option = word.starts_with('-');
  std::vector<std::string> known;
  if (option) {
    for (const CLI::Option* each : command.get_options()) {
      for (const std::string& name : each->get_lnames()) known.push_back("--" + name);
    }
  } else {
    if (command.get_require_subcommand_min() == 0) return {};
    for (const CLI::App* each : command.get_subcommands({})) known.push_back(each->get_name());
  }
  const std::string wrong = option ? word.substr(0, word.find('=')) : word;
  std::string remedy = did_you_mean(wrong, known);
  if (remedy.empty() && option) return {};
  if (remedy.empty()) {
    std::ranges::sort(known);
    for (const std::string& name : known) remedy += (remedy.empty() ? "there are " : ", ") + name;
  }
  return whole_name(command) + " has no " + (option ? "option " : "subcommand ") + printable(wrong) + "; " + remedy;
}

}  // namespace

Option& Option::required() {
  option_->required();
  return *this;
}

Option& Option::show_default() {
  option_->capture_default_str();
  return *this;
}

Option& Option::between(double least, double most) {
  option_->check(CLI::Range(least, most));
  return *this;
}

Option& Option::between(int least, int most) {
  option_->check(CLI::Range(least, most));
  return *this;
}

Option& Option::positive() {
  option_->check(CLI::PositiveNumber);
  return *this;
}

Option& Option::one_of(std::vector<std::string> words) {
  option_->check(CLI::IsMember(std::move(words)));
  return *this;
}

Option& Option::check(std::function<std::string(const std::string&)> wrong, std::string shown) {
  option_->check(CLI::Validator(std::move(wrong), std::move(shown)));
  return *this;
}

Option& Option::excludes(Option other) {
  option_->excludes(other.option_);
  return *this;
}

Option& Option::needs(Option other) {
  option_->needs(other.option_);
  return *this;
}

Option& Option::values(int count) {
  option_->expected(count);
  return *this;
}

Option& Option::list_divided_by(char delimiter) {
  option_->delimiter(delimiter);
  return *this;
}

Option& Option::one_value_each() {
  option_->allow_extra_args(false);
  return *this;
}

Option Command::option(const std::string& names, std::string& value, const std::string& help) {
  return Option(app_->add_option(names, value, help));
}
Option Command::option(const std::string& names, int& value, const std::string& help) {
  return Option(app_->add_option(names, value, help));
}
Option Command::option(const std::string& names, unsigned& value, const std::string& help) {
  return Option(app_->add_option(names, value, help));
}
Option Command::option(const std::string& names, std::uint64_t& value, const std::string& help) {
  return Option(app_->add_option(names, value, help));
}
Option Command::option(const std::string& names, double& value, const std::string& help) {
  return Option(app_->add_option(names, value, help));
}
Option Command::option(const std::string& names, std::optional<std::string>& value, const std::string& help) {
  return Option(app_->add_option(names, value, help));
}
Option Command::option(const std::string& names, std::optional<int>& value, const std::string& help) {
  return Option(app_->add_option(names, value, help));
}
Option Command::option(const std::string& names, std::optional<std::uint64_t>& value, const std::string& help) {
  return Option(app_->add_option(names, value, help));
}
Option Command::option(const std::string& names, std::optional<double>& value, const std::string& help) {
  return Option(app_->add_option(names, value, help));
}
Option Command::option(const std::string& names, std::vector<std::string>& value, const std::string& help) {
  return Option(app_->add_option(names, value, help));
}
Option Command::option(const std::string& names, std::vector<double>& value, const std::string& help) {
  return Option(app_->add_option(names, value, help));
}
Option Command::flag(const std::string& names, bool& value, const std::string& help) {
  return Option(app_->add_flag(names, value, help));
}

Command Command::subcommand(const std::string& name, const std::string& description) {
  return Command(app_->add_subcommand(name, description));
}

void Command::require_subcommand() { app_->require_subcommand(1); }

void Command::footer(const std::string& text) { app_->footer(text); }

void Command::when_named(std::function<void()> action, std::function<std::string()> wrong) {
  app_->callback([name = app_->get_name(), action = std::move(action), wrong = std::move(wrong)] {
    if (const std::string sentence = wrong ? wrong() : std::string{}; !sentence.empty())
      throw CLI::ValidationError(name, sentence);
    action();
  });
}

bool Command::named() const { return app_->parsed(); }

CommandLine::CommandLine(std::unique_ptr<CLI::App> app) : Command(app.get()), root_(std::move(app)) {}

CommandLine::CommandLine(const std::string& description, const std::string& name)
    : CommandLine(std::make_unique<CLI::App>(description, name)) {}

CommandLine::~CommandLine() = default;

void CommandLine::version(const std::string& text) { root_->set_version_flag("--version", text); }

std::optional<int> CommandLine::parse(int argc, const char* const* argv) {
  if (argc == 2 && std::string_view(argv[1]) == kDescribe) {
    std::printf("%s\n", description_of(*root_, std::filesystem::path(argv[0]).filename().string()).c_str());
    return 0;
  }
  try {
    root_->parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const std::string unknown = error.get_exit_code() == 0 ? std::string() : about_unknown_word(*root_);
    if (!unknown.empty()) {
      std::fprintf(stderr, "%s\nRun with --help for more information.\n", unknown.c_str());
      return kExitWrongUsage;
    }
    return root_->exit(error) == 0 ? 0 : kExitWrongUsage;
  }
  return std::nullopt;
}

}  // namespace cellmirror::cli
