#include "config/hyper_file.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "config/file_finder.hpp"
#include "config/first_error.hpp"
#include "config/tables_file.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror {

namespace {

constexpr Range kConnectionPlace{-100.0, 100.0};
constexpr Range kConnectionRadius{0.0, 1.0};
constexpr Range kConnectionStiffness{0.0, 1e6, true};
constexpr Range kConnectionForce{0.0, 1e6};

// Empty: the world.
std::string read_object_name(TableReader& reader, const char* key, const std::vector<std::string>* objects) {
  const auto name = reader.text(key);
  if (!name) return {};
  const bool known = objects == nullptr || std::ranges::find(*objects, *name) != objects->end();
  if (!name->empty() && known) return *name;
  std::string remedy = objects == nullptr ? std::string() : did_you_mean(*name, *objects);
  if (remedy.empty() && objects != nullptr && !objects->empty())
    remedy = fmt::format("the objects are {}", fmt::join(*objects, ", "));
  if (remedy.empty()) remedy = "objects are named by their files, e.g. liver.mpo";
  reader.error(key,
               name->empty() ? fmt::format("{} is empty", key) : fmt::format("there is no object {}", printable(*name)),
               std::move(remedy));
  return {};
}

tissue::Connection read_connection(TableReader& reader, const std::vector<std::string>* objects) {
  tissue::Connection connection;
  reader.require("object_a");
  if (const auto name = reader.name("name")) {
    connection.name = *name;
    reader.set_where("connection " + printable(*name));
  }
  connection.object_a = read_object_name(reader, "object_a", objects);
  connection.object_b = read_object_name(reader, "object_b", objects);
  if (!connection.object_a.empty() && connection.object_a == connection.object_b)
    reader.error("object_b", "an object is connected with itself", "leave object_b out to connect it with the world");
  for (const char* key : {"point_a_m", "point_b_m"}) reader.require(key);
  connection.point_a = reader.vector3("point_a_m", kConnectionPlace).value_or(connection.point_a);
  connection.point_b = reader.vector3("point_b_m", kConnectionPlace).value_or(connection.point_b);
  connection.radius_m = reader.number("radius_m", kConnectionRadius).value_or(connection.radius_m);
  connection.stiffness_n_m = reader.number("stiffness_n_m", kConnectionStiffness).value_or(connection.stiffness_n_m);
  connection.tear_force_n = reader.number("tear_force_n", kConnectionForce).value_or(connection.tear_force_n);
  reader.finish();
  return connection;
}

}  // namespace

std::optional<tissue::HyperDescription> parse_hyper(std::string_view text, const std::string& file,
                                                    const std::vector<std::string>* objects, Diagnostics& diagnostics) {
  return parse_tables<tissue::HyperDescription>(
      text, file, diagnostics, [&](TableReader& top, tissue::HyperDescription& hyper) {
        hyper.file = file;
        static_cast<void>(top.text("description"));
        std::vector<std::string> names;
        for (TableReader& reader : top.tables("connection", kMostConnections)) {
          hyper.connections.push_back(read_connection(reader, objects));
          const std::string& name = hyper.connections.back().name;
          if (!name.empty() && std::ranges::find(names, name) != names.end())
            reader.error("name", fmt::format("there is another connection {}", name));
          names.push_back(name);
        }
      });
}

std::optional<tissue::HyperDescription> read_hyper(const std::filesystem::path& path,
                                                   const std::vector<std::string>* objects, Diagnostics& diagnostics) {
  const auto text = text_of_file(path, kLargestObjectFile, path.string(), diagnostics);
  return text ? parse_hyper(*text, path.string(), objects, diagnostics) : std::nullopt;
}

Result<tissue::HyperDescription> load_hyper(const KismetHome& home, std::string_view name,
                                            const std::vector<std::string>& objects) {
  const auto path = HomeFiles(home).find(FileUse::hyper, name);
  if (!path) return std::unexpected(path.error());
  Diagnostics diagnostics;
  auto hyper = read_hyper(*path, &objects, diagnostics);
  if (!hyper) return std::unexpected(first_error(diagnostics, *path));
  return std::move(*hyper);
}

}  // namespace cellmirror
