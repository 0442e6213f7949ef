#include "config/msh/tetra_check.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "config/msh/msh_file.hpp"

namespace cellmirror::msh {

namespace {

constexpr auto kUnused = std::numeric_limits<std::uint32_t>::max();
// Errors of one kind that are reported with their places; the others are counted.
constexpr std::size_t kMostReported = 10;

// Reports the first few errors of a kind and counts the rest.
class Errors {
 public:
  Errors(Input& input, const char* what_more) : input_(input), what_more_(what_more) {}
  void add(std::size_t at, std::string what, std::string remedy) {
    if (++count_ <= kMostReported) input_.error(at, std::move(what), std::move(remedy));
  }
  // True where there was none.
  bool finish(std::size_t at) {
    if (count_ > kMostReported) input_.error(at, fmt::format("{} more {}", count_ - kMostReported, what_more_));
    return count_ == 0;
  }

 private:
  Input& input_;
  const char* what_more_;
  std::size_t count_ = 0;
};

// Ids in ascending order with their index in the file.
using Index = std::vector<std::pair<std::int64_t, std::uint32_t>>;

bool check_nodes(Input& input, const RawMesh& raw, double scale) {
  Errors errors(input, "nodes are like that");
  for (const RawNode& node : raw.nodes) {
    const Eigen::Vector3d p = node.p * scale;
    if (!p.allFinite()) {
      errors.add(node.at, fmt::format("a coordinate of node {} is not a finite number", node.id), "export it again");
    } else if (p.cwiseAbs().maxCoeff() > kLargestCoordinate) {
      errors.add(node.at, fmt::format("node {} is {:g} m away from the origin", node.id, p.cwiseAbs().maxCoeff()),
                 "check the unit and the scale");
    }
  }
  return errors.finish(raw.nodes.empty() ? 0 : raw.nodes.back().at);
}

std::optional<Index> index_nodes(Input& input, const RawMesh& raw) {
  Index index;
  index.reserve(raw.nodes.size());
  for (std::uint32_t i = 0; i < raw.nodes.size(); ++i) index.emplace_back(raw.nodes[i].id, i);
  std::ranges::sort(index);
  Errors errors(input, "ids of nodes appear twice");
  for (std::size_t i = 1; i < index.size(); ++i) {
    if (index[i].first != index[i - 1].first) continue;
    errors.add(raw.nodes[index[i].second].at, fmt::format("the id {} belongs to two nodes", index[i].first),
               "export the mesh again");
  }
  return errors.finish(0) ? std::optional(std::move(index)) : std::nullopt;
}

bool check_element_ids(Input& input, const RawMesh& raw) {
  std::vector<std::pair<std::int64_t, std::size_t>> ids;
  ids.reserve(raw.tetrahedra.size() + raw.other_ids.size());
  for (const RawTetra& tetra : raw.tetrahedra) ids.emplace_back(tetra.id, tetra.at);
  for (const std::int64_t id : raw.other_ids) ids.emplace_back(id, 0);
  std::ranges::sort(ids);
  Errors errors(input, "ids of elements appear twice");
  for (std::size_t i = 1; i < ids.size(); ++i) {
    if (ids[i].first != ids[i - 1].first) continue;
    errors.add(ids[i].second, fmt::format("the id {} belongs to two elements", ids[i].first), "export the mesh again");
  }
  return errors.finish(0);
}

// The same four nodes make two tetrahedra.
bool check_duplicates(Input& input, const RawMesh& raw, const tissue::TetraMesh& mesh) {
  std::vector<std::pair<std::array<std::uint32_t, 4>, std::uint32_t>> corners;
  corners.reserve(mesh.tetrahedra.size());
  for (std::uint32_t i = 0; i < mesh.tetrahedra.size(); ++i) {
    auto sorted = mesh.tetrahedra[i];
    std::ranges::sort(sorted);
    corners.emplace_back(sorted, i);
  }
  std::ranges::sort(corners);
  Errors errors(input, "tetrahedra appear twice");
  for (std::size_t i = 1; i < corners.size(); ++i) {
    if (corners[i].first != corners[i - 1].first) continue;
    const RawTetra& tetra = raw.tetrahedra[corners[i].second];
    errors.add(tetra.at, fmt::format("tetrahedron {} has the same nodes as another one", tetra.id),
               "remove duplicate elements and export the mesh again");
  }
  return errors.finish(0);
}

class Builder {
 public:
  Builder(Input& input, const RawMesh& raw, double scale, Index index)
      : raw_(raw),
        scale_(scale),
        index_(std::move(index)),
        used_(raw.nodes.size(), kUnused),
        unknown_(input, "tetrahedra have unknown nodes"),
        flat_(input, "tetrahedra have no volume") {}

  bool run() {
    mesh.tetrahedra.reserve(raw_.tetrahedra.size());
    for (const RawTetra& tetra : raw_.tetrahedra) add(tetra);
    const bool known = unknown_.finish(0);
    return flat_.finish(0) && known;
  }

  tissue::TetraMesh mesh;
  std::size_t turned = 0;

 private:
  std::uint32_t node(std::int64_t id) {
    const auto at = std::ranges::lower_bound(index_, id, {}, &Index::value_type::first);
    if (at == index_.end() || at->first != id) return kUnused;
    std::uint32_t& to = used_[at->second];
    if (to == kUnused) {
      to = static_cast<std::uint32_t>(mesh.nodes.size());
      mesh.nodes.emplace_back(raw_.nodes[at->second].p * scale_);
    }
    return to;
  }

  void add(const RawTetra& tetra) {
    std::array<std::uint32_t, 4> corners{};
    for (std::size_t k = 0; k < 4; ++k) {
      corners[k] = node(tetra.nodes[k]);
      if (corners[k] != kUnused) continue;
      unknown_.add(tetra.at,
                   fmt::format("tetrahedron {} names node {}, which does not exist", tetra.id, tetra.nodes[k]),
                   "export the mesh again");
      return;
    }
    const Eigen::Vector3d& o = mesh.nodes[corners[0]];
    const Eigen::Vector3d a = mesh.nodes[corners[1]] - o;
    const Eigen::Vector3d b = mesh.nodes[corners[2]] - o;
    const Eigen::Vector3d c = mesh.nodes[corners[3]] - o;
    const double longest = std::max({a.norm(), b.norm(), c.norm(), (a - b).norm(), (b - c).norm(), (c - a).norm()});
    const double six_volumes = a.dot(b.cross(c));
    // Also where the numbers are so small that their product is 0.
    if (!(std::abs(six_volumes) > 6.0 * kLeastShape * longest * longest * longest)) {
      flat_.add(tetra.at, fmt::format("tetrahedron {} has no volume", tetra.id),
                "improve the mesh: gmsh -optimize_netgen");
      return;
    }
    if (six_volumes < 0) {
      std::swap(corners[2], corners[3]);
      ++turned;
    }
    mesh.tetrahedra.push_back(corners);
  }

  const RawMesh& raw_;
  double scale_;
  Index index_;
  std::vector<std::uint32_t> used_;  // by node of the file: its number in `mesh`
  Errors unknown_;
  Errors flat_;
};

}  // namespace

std::optional<tissue::TetraMesh> check_tetrahedra(Input& input, const RawMesh& raw, double scale, std::size_t& turned) {
  const bool finite = check_nodes(input, raw, scale);
  const bool unique = check_element_ids(input, raw);
  auto index = index_nodes(input, raw);
  if (!index || !finite) return std::nullopt;
  Builder builder(input, raw, scale, std::move(*index));
  if (!builder.run() || !unique) return std::nullopt;
  if (!check_duplicates(input, raw, builder.mesh)) return std::nullopt;
  turned = builder.turned;
  return std::move(builder.mesh);
}

}  // namespace cellmirror::msh
