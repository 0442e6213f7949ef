#include "app/owner/tissue/tissue_parts.hpp"

#include <filesystem>
#include <utility>

#include "config/clip_file.hpp"
#include "config/hyper_file.hpp"

namespace cellmirror::app {

TissueParts tissue_parts(const TissueSetup& setup, const KismetHome& home, TissuePort* port) {
  TissueParts parts;
  std::vector<std::string> names;
  for (const tissue::ObjectDescription& object : setup.objects) {
    parts.objects.push_back(TissueObject::of(object));
    names.push_back(object.name);
  }
  parts.hyper_file = std::filesystem::path(setup.hyper_file).filename().string();
  parts.connections = setup.connections.size();
  parts.readers.hyper = [home, names = std::move(names)](std::string_view name) {
    return load_hyper(home, name, names);
  };
  parts.readers.clip = [home](std::string_view name) { return load_clip(home, name); };
  parts.port = port;
  return parts;
}

}  // namespace cellmirror::app
