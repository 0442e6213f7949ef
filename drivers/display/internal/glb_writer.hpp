// The parts of a glTF 2.0 binary file: blocks of triangles in one buffer, and the container around it. Private to this
// folder; no OpenGL.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "drivers/display/internal/surface.hpp"
#include "rt_core/base/json_writer.hpp"

namespace cellmirror::display {

// Accessors of one block of triangles.
struct GlbBlock {
  std::size_t positions = 0;
  std::size_t normals = 0;
  std::size_t indices = 0;
};

// Collects blocks; `accessors` and `buffer views` are the values of these members of the document.
class GlbBuffer {
 public:
  explicit GlbBuffer(std::size_t most_bytes) : most_bytes_(most_bytes) {}

  // None where it has no triangle, or where the buffer would exceed its bound.
  [[nodiscard]] std::optional<GlbBlock> add(const Surface& surface);
  [[nodiscard]] std::size_t size() const { return bytes_.size(); }
  // The document needs them once each; both may be empty arrays.
  [[nodiscard]] std::string take_accessors() { return accessors_.end_array().take(); }
  [[nodiscard]] std::string take_views() { return views_.end_array().take(); }
  [[nodiscard]] std::string take_bytes() { return std::move(bytes_); }

 private:
  std::size_t add_view(std::size_t offset, std::size_t length, int target);
  void write_float(float value);

  std::size_t most_bytes_;
  std::string bytes_;
  std::size_t view_count_ = 0;
  std::size_t accessor_count_ = 0;
  JsonWriter accessors_ = begun();
  JsonWriter views_ = begun();

  static JsonWriter begun() {
    JsonWriter array(JsonWriter::kExact);
    array.begin_array();
    return array;
  }
};

// Section 4.4: a header, the chunk of the document, that of the buffer (if it is not empty), each padded to four bytes.
[[nodiscard]] std::string glb_container(std::string_view document, std::string_view buffer);

}  // namespace cellmirror::display
