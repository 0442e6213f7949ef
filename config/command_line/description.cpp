#include "config/command_line/description.hpp"

#include <CLI/CLI.hpp>

#include "rt_core/base/json_writer.hpp"

namespace cellmirror::cli {

namespace {

std::string_view values_of(const CLI::Option& option) {
  if (option.get_items_expected_max() == 0) return "none";
  return option.get_items_expected_max() == 1 ? "one" : "many";
}

void add_names(JsonWriter& out, const CLI::Option& option) {
  out.key("names").begin_array();
  for (const std::string& name : option.get_snames()) out.value("-" + name);
  for (const std::string& name : option.get_lnames()) out.value("--" + name);
  out.end_array();
}

void add_option(JsonWriter& out, const CLI::Option& option) {
  out.begin_object();
  add_names(out, option);
  out.member("positional", option.get_positional() ? option.get_name(true) : std::string());
  out.member("type", values_of(option) == "none" ? std::string() : option.get_type_name());
  out.member("default", option.get_default_str());
  out.member("required", option.get_required());
  out.member("values", values_of(option));
  out.member("help", option.get_description());
  out.end_object();
}

// As deep as the program itself has subcommands of subcommands.
void add_command(JsonWriter& out, const CLI::App& command, std::string_view name) {
  out.begin_object();
  out.member("name", name);
  out.member("description", command.get_description());
  out.member("footer", command.get_footer());
  out.key("options").begin_array();
  for (const CLI::Option* option : command.get_options()) add_option(out, *option);
  out.end_array();
  out.key("subcommands").begin_array();
  for (const CLI::App* sub : command.get_subcommands({})) add_command(out, *sub, sub->get_name());
  out.end_array();
  out.end_object();
}

}  // namespace

std::string description_of(const CLI::App& program, std::string_view name) {
  JsonWriter out;
  add_command(out, program, program.get_name().empty() ? name : std::string_view(program.get_name()));
  return out.take();
}

}  // namespace cellmirror::cli
