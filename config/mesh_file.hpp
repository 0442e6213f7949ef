// Reads the triangles of a mesh file: STL, OBJ, DAE, PLY, glTF 2.0 (.gltf, .glb). All meshes of the file become one,
// placed by the nodes of the file. Uses files and memory; any thread; the file is untrusted.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "rt_core/base/result.hpp"
#include "rt_core/geometry/mesh_repair/mesh_repair.hpp"

namespace cellmirror {

struct AppearanceRequest;

// Gives the content of another file that the mesh file names, by its name there.
using Neighbours = std::function<Result<std::string>(const std::string& name)>;

// The mesh in frame G. Coordinates as in the file, times its unit if it has one (DAE), times `scale` (any but 0;
// negative factors mirror); no change of axes. `extension` with its dot, in lower case. Lines and points are left out.
// Only the buffers of glTF are requested from `neighbours`. `looks`, if given, receives the mesh's appearance; missing
// parts of it are not failures.
[[nodiscard]] Result<geometry::TriangleMesh> parse_mesh(std::string_view bytes, std::string_view extension,
                                                        std::string name, const Eigen::Vector3d& scale,
                                                        const Neighbours& neighbours, geometry::MeshFindings& findings,
                                                        AppearanceRequest* looks = nullptr);

// The same from a file; neighbours must be in its folder or below.
[[nodiscard]] Result<geometry::TriangleMesh> read_mesh_file(const std::filesystem::path& file,
                                                            const Eigen::Vector3d& scale,
                                                            geometry::MeshFindings& findings,
                                                            AppearanceRequest* looks = nullptr);

}  // namespace cellmirror
