#include "app/subcommands/status_table_io.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "app/subcommands/status_words.hpp"

namespace cellmirror::app {

namespace {

using nlohmann::json;

std::string io_node_lines(const json& node) {
  std::string out =
      fmt::format("I/O node {} on {}: {}", count(node.at("id")), text(node.at("endpoint")), text(node.at("condition")));
  for (const auto& [key, value] : node.at("details").items()) out += fmt::format(", {} {}", key, text(value));
  out += "\n";
  for (const char* key : {"trouble", "last_refusal"}) {
    if (const std::string what = text(node.at(key)); !what.empty()) out += fmt::format("  {}\n", what);
  }
  return out;
}

}  // namespace

std::string io_nodes_table(const json& status) {
  if (!status.contains("io_nodes")) return {};
  std::string out;
  for (const json& node : status.at("io_nodes")) out += io_node_lines(node);
  return out;
}

}  // namespace cellmirror::app
