#include "drivers/display/internal/glb_writer.hpp"

#include <algorithm>
#include <bit>

namespace cellmirror::display {

namespace {

// Numbers of the specification.
constexpr int kFloat = 5126;  // componentType, section 3.6.2.2
constexpr int kUnsignedShort = 5123;
constexpr int kUnsignedInt = 5125;
constexpr int kVertices = 34962;  // target of a buffer view, section 3.6.1
constexpr int kIndices = 34963;
constexpr std::uint32_t kMagic = 0x46546C67;  // "glTF", section 4.4.2
constexpr std::uint32_t kVersion = 2;
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;
constexpr std::uint32_t kBinaryChunk = 0x004E4942;
constexpr std::size_t kHeaderBytes = 12;
constexpr std::size_t kChunkHeaderBytes = 8;

void append(std::string& out, std::uint32_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) out += static_cast<char>(static_cast<std::uint8_t>(value >> (8 * i)));
}

void pad(std::string& out, char with) {
  while (out.size() % 4 != 0) out += with;
}

void write_vector(JsonWriter& out, std::string_view name, const Eigen::Vector3f& vector) {
  out.key(name).begin_array();
  for (int i = 0; i < 3; ++i) out.value(static_cast<double>(vector[i]));
  out.end_array();
}

std::size_t rounded_up(std::size_t bytes) { return (bytes + 3) / 4 * 4; }

}  // namespace

void GlbBuffer::write_float(float value) { append(bytes_, std::bit_cast<std::uint32_t>(value), 4); }

std::size_t GlbBuffer::add_view(std::size_t offset, std::size_t length, int target) {
  views_.begin_object().member("buffer", 0).member("byteOffset", offset).member("byteLength", length);
  views_.member("target", target).end_object();
  return view_count_++;
}

std::optional<GlbBlock> GlbBuffer::add(const Surface& surface) {
  const std::size_t count = surface.vertices.size();
  if (count == 0 || surface.corners.empty()) return std::nullopt;
  const bool wide = count > 0xFFFF;  // 65535 itself restarts primitives in some readers
  const std::size_t index_bytes = surface.corners.size() * (wide ? 4 : 2);
  const std::size_t vector_bytes = 12 * count;
  if (rounded_up(index_bytes) + 2 * vector_bytes > most_bytes_ - std::min(most_bytes_, bytes_.size()))
    return std::nullopt;
  Eigen::Vector3f low = surface.vertices.front().position;
  Eigen::Vector3f high = low;
  for (const Vertex& vertex : surface.vertices) {
    low = low.cwiseMin(vertex.position);
    high = high.cwiseMax(vertex.position);
  }
  const auto add_accessor = [&](std::size_t view, int type, std::size_t elements, const char* kind) {
    accessors_.begin_object().member("bufferView", view).member("componentType", type).member("count", elements);
    accessors_.member("type", kind);
    return accessor_count_++;
  };
  GlbBlock block;
  const std::size_t positions = bytes_.size();
  for (const Vertex& vertex : surface.vertices) {
    for (int i = 0; i < 3; ++i) write_float(vertex.position[i]);
  }
  block.positions = add_accessor(add_view(positions, vector_bytes, kVertices), kFloat, count, "VEC3");
  write_vector(accessors_, "min", low);
  write_vector(accessors_, "max", high);
  accessors_.end_object();
  const std::size_t normals = bytes_.size();
  for (const Vertex& vertex : surface.vertices) {
    for (int i = 0; i < 3; ++i) write_float(vertex.normal[i]);
  }
  block.normals = add_accessor(add_view(normals, vector_bytes, kVertices), kFloat, count, "VEC3");
  accessors_.end_object();
  const std::size_t indices = bytes_.size();
  for (const Corner corner : surface.corners) append(bytes_, corner, wide ? 4 : 2);
  block.indices = add_accessor(add_view(indices, index_bytes, kIndices), wide ? kUnsignedInt : kUnsignedShort,
                               surface.corners.size(), "SCALAR");
  accessors_.end_object();
  pad(bytes_, '\0');
  return block;
}

std::string glb_container(std::string_view document, std::string_view buffer) {
  const std::size_t json_bytes = rounded_up(document.size());
  const std::size_t buffer_bytes = rounded_up(buffer.size());
  const std::size_t total =
      kHeaderBytes + kChunkHeaderBytes + json_bytes + (buffer.empty() ? 0 : kChunkHeaderBytes + buffer_bytes);
  std::string out;
  out.reserve(total);
  append(out, kMagic, 4);
  append(out, kVersion, 4);
  append(out, static_cast<std::uint32_t>(total), 4);
  append(out, static_cast<std::uint32_t>(json_bytes), 4);
  append(out, kJsonChunk, 4);
  out += document;
  pad(out, ' ');
  if (buffer.empty()) return out;
  append(out, static_cast<std::uint32_t>(buffer_bytes), 4);
  append(out, kBinaryChunk, 4);
  out += buffer;
  pad(out, '\0');
  return out;
}

}  // namespace cellmirror::display
