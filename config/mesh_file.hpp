// Reads the triangles of a mesh file: STL, OBJ, DAE, PLY, glTF 2.0 (.gltf, .glb). All meshes of the file become one,
// each where the nodes of the file put it. Takes files and memory; any thread; nothing of the file is believed.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "rt_core/base/result.hpp"
#include "rt_core/geometry/mesh_repair.hpp"

namespace cellmirror {

struct LookRequest;

// Gives the content of another file that the mesh file names, by its name there.
using Neighbours = std::function<Result<std::string>(const std::string& name)>;

// The mesh in frame G. Coordinates as they stand in the file, times its own unit where it has one (DAE), times `scale`
// (any but 0; negative factors mirror); no change of axes. `extension` with its dot, in lower case. Lines and points
// are no surface and are left out. Only the buffers of glTF are asked of `neighbours`.
// `looks`, where given, gets the mesh's look as well; what of it cannot be had is no failure.
[[nodiscard]] Result<geometry::TriangleMesh> parse_mesh(std::string_view bytes, std::string_view extension,
                                                        std::string name, const Eigen::Vector3d& scale,
                                                        const Neighbours& neighbours, geometry::MeshFindings& findings,
                                                        LookRequest* looks = nullptr);

// The same from a file; neighbours must lie in its folder or below.
[[nodiscard]] Result<geometry::TriangleMesh> read_mesh_file(const std::filesystem::path& file,
                                                            const Eigen::Vector3d& scale,
                                                            geometry::MeshFindings& findings,
                                                            LookRequest* looks = nullptr);

}  // namespace cellmirror
