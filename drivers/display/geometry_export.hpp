// The bodies of a scene as a glTF 2.0 binary file (Khronos glTF 2.0 specification, sections 3 and 4.4), with the
// triangles and normals that the renderer draws. No OpenGL.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>

#include "rt_core/ports/scene.hpp"

namespace cellmirror::display {

struct Surface;

// What a body belongs to.
struct BodyName {
  std::string path;   // dotted
  std::string robot;  // may be empty
};

// One thread. Not for the tick: megabytes are copied.
class GeometryExport {
 public:
  static constexpr std::size_t kMaxBytes = std::size_t{256} << 20U;  // of a file; bodies beyond it have no mesh

  // Node 0 turns the cell (z up) as glTF wants it (y up); its children are the bodies, in their order: body i is node
  // i + 1, with `extras` {index, object, path, robot}. Colours are linear there. Equal geometry is written once. A body
  // that cannot be drawn is a node without a mesh; `asset.extras.left_out` counts those that did not fit. `name_of`
  // gets SceneBody::object.
  [[nodiscard]] std::string make(std::span<const SceneBody> bodies,
                                 const std::function<BodyName(std::uint32_t object)>& name_of);

 private:
  // Kept while the mesh is used, since its normals take longest.
  std::map<std::shared_ptr<const geometry::TriangleMesh>, std::shared_ptr<const Surface>> surfaces_;
};

}  // namespace cellmirror::display
