// Requests to the reader of meshes and its answers, as bytes: numbers of 8 bytes, texts and lists with their length
// before them, in the order of this machine. Takes memory; any thread.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "config/mesh_message/scene_polygons.hpp"
#include "rt_core/base/result.hpp"

namespace cellmirror {

// What is to be read. Holds no bytes itself.
struct MeshRequest {
  std::string_view extension;  // with its dot, in lower case
  std::string_view bytes;      // of the file
  // The buffers beside a glTF, by their names in it.
  std::vector<std::pair<std::string_view, std::string_view>> buffers;
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();
  bool with_looks = false;  // else shapes alone
};

// Bytes that are sent one part after the other; large parts stay where they are until then.
class MeshMessage {
 public:
  void number(std::size_t value) { copy(&value, sizeof(value)); }
  // Copies `size` bytes.
  void copy(const void* from, std::size_t size);
  // Its length and its bytes, which have to live until they are sent.
  void text(std::string_view text);
  // Valid until the message is changed.
  [[nodiscard]] std::vector<std::string_view> parts() const;
  [[nodiscard]] std::string joined() const;

 private:
  struct Part {
    const char* foreign;  // null: in `own_`
    std::size_t at;       // there
    std::size_t size;
  };
  std::string own_;
  std::vector<Part> parts_;
};

[[nodiscard]] MeshMessage encode_mesh_request(const MeshRequest& request);
// The request points into `bytes`. None where these are no request.
[[nodiscard]] std::optional<MeshRequest> decode_mesh_request(std::string_view bytes);

// `answer` has to live until the message is sent.
[[nodiscard]] MeshMessage encode_mesh_answer(const Result<ScenePolygons>& answer);

// Maximum size of an answer: the vertices, triangles and appearance of the largest mesh, and textures of 128 MiB.
inline constexpr std::size_t kLargestMeshAnswer = std::size_t{512} << 20U;

// The reader's result, or why it failed (printable, at most some hundred characters). None if the bytes are not an
// answer to a request `with_looks` or without. The input is untrusted: afterwards every index is in its range, texture
// coordinates are finite, and all lists have the right length. geometry::make_mesh() checks coordinates and names the
// vertex. Takes memory in proportion to bytes.size().
[[nodiscard]] std::optional<Result<ScenePolygons>> decode_mesh_answer(std::string_view bytes, bool with_looks);

}  // namespace cellmirror
