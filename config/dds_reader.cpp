#include "config/dds_reader.hpp"

#include <fmt/format.h>

#include <string>
#include <string_view>

#include "config/dds_network_reader.hpp"
#include "rt_core/base/dds_topic.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror {

namespace {

std::string read_path(TableReader& table, std::string_view key, const FileFinder& files) {
  const auto name = table.text(key);
  if (!name) return {};
  const auto found = files.find(FileUse::security, *name);
  if (found) return found->string();
  table.error(key, found.error().what, found.error().remedy);
  return {};
}

}  // namespace

DdsSecurityConfig read_dds(TableReader& top, const FileFinder& files, RosPresence& ros, DdsNetworkConfig& network) {
  auto dds = top.table("dds");
  if (!dds) return {};
  ros.distribution = dds->choice<RosDistribution>(
      "ros_distribution",
      {{"humble", RosDistribution::humble}, {"jazzy", RosDistribution::jazzy}, {"kilted", RosDistribution::kilted}});
  if (const auto name = dds->text("node_name")) {
    if (!is_ros_topic("rt/" + *name) || name->find('/') != std::string::npos)
      dds->error("node_name", fmt::format("\"{}\" is not the name of a node", printable(*name)),
                 "letters, digits and _, no digit in front");
    ros.node_name = *name;
  }
  network = read_dds_network(*dds);
  auto table = dds->table("security");
  dds->finish();
  if (!table) return {};
  for (const char* key : {"identity_ca", "certificate", "private_key", "governance", "permissions"})
    table->require(key);
  DdsSecurityConfig security;
  security.identity_ca = read_path(*table, "identity_ca", files);
  security.certificate = read_path(*table, "certificate", files);
  security.private_key = read_path(*table, "private_key", files);
  security.governance = read_path(*table, "governance", files);
  security.permissions = read_path(*table, "permissions", files);
  security.permissions_ca =
      table->has("permissions_ca") ? read_path(*table, "permissions_ca", files) : security.identity_ca;
  if (!security.private_key.empty()) {
    if (const auto hidden = files.check_private(security.private_key); !hidden)
      table->error("private_key", hidden.error().what, hidden.error().remedy);
  }
  table->finish();
  return security;
}

}  // namespace cellmirror
