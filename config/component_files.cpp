#include "config/component_files.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "config/first_error.hpp"
#include "config/parse.hpp"
#include "rt_core/base/capacity.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kDeepest = 32;

bool is_urdf(const fs::path& path) { return equal_ignoring_case(path.extension().string(), ".urdf"); }
bool is_component(const fs::path& path) { return equal_ignoring_case(path.extension().string(), ".mpc"); }

}  // namespace

std::shared_ptr<const Component> read_component_file(const fs::path& path, const FileFinder& files,
                                                     Diagnostics& diagnostics) {
  const std::string file = path.string();
  if (!is_urdf(path) && !is_component(path)) {
    diagnostics.error({file, 0, 0}, "the file is not a component", "component files are .mpc or .urdf");
    return nullptr;
  }
  const auto text = read_text_file(path, kLargestText);
  if (!text) {
    diagnostics.error({file, 0, 0}, text.error().what, text.error().remedy);
    return nullptr;
  }
  auto component = is_urdf(path) ? parse_urdf(*text, file, path, files, diagnostics)
                                 : parse_component(*text, file, files, diagnostics);
  return component ? std::make_shared<const Component>(std::move(*component)) : nullptr;
}

std::shared_ptr<const Component> ComponentFiles::read(const fs::path& path, std::optional<CollideAs> collide_as,
                                                      Diagnostics& diagnostics) const {
  files_.meshes().about_to_read(path);
  if (!collide_as) return read_component_file(path, files_, diagnostics);
  return read_component_file(path, FilesWithMeshesAs(files_, *collide_as), diagnostics);
}

Result<std::shared_ptr<const Component>> ComponentFiles::component(std::string_view file) {
  AbstractReference reference;
  reference.file = file;
  return component_for(reference);
}

Result<std::shared_ptr<const Component>> ComponentFiles::component_for(const AbstractReference& reference) {
  const std::string& file = reference.file;
  const auto path = files_.find(FileUse::component, file);
  if (!path) return std::unexpected(path.error());
  Entry& entry = entries_[{path->string(), reference.collide_as}];
  if (entry.held) return entry.held;
  if (auto used = entry.used.lock()) return used;
  Diagnostics diagnostics;
  auto component = read(*path, reference.collide_as, diagnostics);
  if (!diagnostics.ok() || !component) {
    return std::unexpected(first_error(diagnostics, *path));
  }
  entry.used = component;
  return component;
}

void ComponentFiles::load(const Component& root, Diagnostics& diagnostics) {
  visits_ = 0;
  visit(root, true, 0, diagnostics);
}

void ComponentFiles::visit(const Component& component, bool loaded, std::size_t depth, Diagnostics& diagnostics) {
  // Cell::build() reports the limits on depth and nodes; here they only bound the work.
  if (depth > kDeepest || ++visits_ > kMaxNodes) return;
  for (const ComponentNode& node : component.nodes) {
    if (node.abstract) visit_node(component, node, loaded && node.abstract->loaded, depth, diagnostics);
  }
}

void ComponentFiles::visit_node(const Component& component, const ComponentNode& node, bool loaded, std::size_t depth,
                                Diagnostics& diagnostics) {
  const auto path = files_.find(FileUse::component, node.abstract->file);
  if (!path) {
    // Reported once for each place in a file, however often that file is used.
    const Place whole_node = component.place(node);
    const Place named{whole_node.file, node.abstract->line, node.abstract->column};
    if (faulty_references_.emplace(fmt::format("{}:{}:{}", named.file, named.line, named.column), true).second)
      diagnostics.error(named.line > 0 ? named : whole_node, path.error().what, path.error().remedy);
    return;
  }
  auto [at, is_new] = entries_.try_emplace(Key(path->string(), node.abstract->collide_as));
  if (is_new) {
    at->second.held = read(*path, node.abstract->collide_as, diagnostics);
    at->second.used = at->second.held;
  }
  if (!at->second.held) return;
  if (loaded) note_robot(*at->second.held, *node.abstract);
  // A file that is not loaded is scanned once; its robots do not exist yet.
  if (is_new || loaded) visit(*at->second.held, loaded, depth + 1, diagnostics);
}

void ComponentFiles::note_robot(const Component& component, const AbstractReference& reference) {
  if (!component.robot) return;
  RobotFacts facts;
  for (const int joint : component.robot->joints) {
    const ComponentNode& node = component.nodes[static_cast<std::size_t>(joint)];
    facts.joint_names.push_back(node.name);
    facts.joint_kinds.push_back(node.joint->kind);
    facts.joint_starts.push_back(node.joint->start_position);
  }
  facts.joint_limits = component.robot->limits;
  robots_.emplace(reference.robot_id.empty() ? component.robot->id : reference.robot_id, std::move(facts));
}

void ComponentFiles::release() {
  for (auto& [key, entry] : entries_) entry.held.reset();
}

std::vector<fs::path> ComponentFiles::files() const {
  std::vector<fs::path> all;
  for (const auto& [key, entry] : entries_) {
    if (all.empty() || all.back() != key.first) all.emplace_back(key.first);
  }
  return all;
}

}  // namespace cellmirror
