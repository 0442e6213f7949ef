#include "config/mesh_message/mesh_message.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <type_traits>

#include "rt_core/base/text.hpp"
#include "rt_core/geometry/mesh_repair/mesh_repair.hpp"

namespace cellmirror {

namespace {

constexpr std::size_t kLongestName = 4096;   // four times what assimp's strings hold
constexpr std::size_t kLongestError = 2000;  // characters; printed are kPrinted of them
constexpr std::size_t kPrinted = 300;
constexpr std::size_t kUnbounded = std::numeric_limits<std::size_t>::max();

enum class Kind : std::size_t { polygons = 1, error = 2 };

template <class T>
void put_list(MeshMessage& to, const std::vector<T>& list) {
  to.number(list.size());
  to.text({reinterpret_cast<const char*>(list.data()), list.size() * sizeof(T)});
}

// Reads from the front. After the first thing that is not there, nothing is.
class Reader {
 public:
  explicit Reader(std::string_view bytes) : left_(bytes) {}

  template <class T>
  T value() {
    static_assert(std::is_trivially_copyable_v<T>);
    T out{};
    const std::string_view from = take(sizeof(T));
    if (!from.empty()) std::memcpy(&out, from.data(), sizeof(T));
    return out;
  }
  std::size_t number() { return value<std::size_t>(); }
  std::string_view text(std::size_t longest) {
    const std::size_t size = number();
    if (size > longest) good_ = false;
    return take(size);
  }
  template <class T>
  void list(std::vector<T>& to, std::size_t most) {
    const std::size_t count = number();
    if (count > most) good_ = false;
    const std::string_view from = text(kUnbounded);
    if (!good_ || from.size() != count * sizeof(T)) good_ = false;
    if (!good_ || count == 0) return;
    to.resize(count);
    std::memcpy(static_cast<void*>(to.data()), from.data(), from.size());
  }
  [[nodiscard]] bool good() const { return good_; }
  [[nodiscard]] bool done() const { return good_ && left_.empty(); }

 private:
  std::string_view take(std::size_t size) {
    if (size > left_.size()) good_ = false;
    if (!good_) return {};
    const std::string_view out = left_.substr(0, size);
    left_.remove_prefix(size);
    return out;
  }

  std::string_view left_;
  bool good_ = true;
};

bool is_place(const Eigen::Vector2f& place) {
  return std::abs(place.x()) <= kFarthestPlace && std::abs(place.y()) <= kFarthestPlace;
}

bool is_share(float value) { return value >= 0.0F && value <= 1.0F; }

SceneMaterial material_from(Reader& from) {
  SceneMaterial out;
  out.name = from.text(kLongestName);
  out.picture = from.text(kLongestName);
  // 0: none.
  if (const std::size_t embedded = from.number(); embedded > 0) out.embedded = embedded - 1;
  out.rgb = from.value<std::array<float, 3>>();
  out.is_factor = from.number() != 0;
  return out;
}

bool is_fit(const ScenePolygons& polygons, bool with_looks) {
  const std::size_t vertices = polygons.vertices.size();
  for (const auto& triangle : polygons.triangles) {
    if (std::ranges::any_of(triangle, [&](std::uint32_t corner) { return corner >= vertices; })) return false;
  }
  if (!with_looks) {
    return polygons.places.empty() && polygons.colours.empty() && polygons.materials.empty() &&
           polygons.palette.empty() && polygons.embedded.empty();
  }
  if (!polygons.places.empty() && polygons.places.size() != vertices) return false;
  if (!polygons.colours.empty() && polygons.colours.size() != vertices) return false;
  if (polygons.materials.size() != polygons.triangles.size()) return false;
  return std::ranges::all_of(polygons.places, is_place) &&
         std::ranges::all_of(polygons.materials,
                             [&](std::uint16_t material) { return material < polygons.palette.size(); }) &&
         std::ranges::all_of(polygons.palette, [&](const SceneMaterial& material) {
           return std::ranges::all_of(material.rgb, is_share) &&
                  (!material.embedded || *material.embedded < polygons.embedded.size());
         });
}

std::optional<Result<ScenePolygons>> polygons_from(Reader& from, bool with_looks) {
  constexpr std::size_t kMostVertices = 3 * geometry::kMostTriangles;
  ScenePolygons out;
  from.list(out.vertices, kMostVertices);
  from.list(out.triangles, geometry::kMostTriangles);
  from.list(out.places, kMostVertices);
  from.list(out.colours, kMostVertices);
  from.list(out.materials, geometry::kMostTriangles);
  const std::size_t materials = from.number();
  if (materials > kMostMaterials) return std::nullopt;
  for (std::size_t i = 0; i < materials && from.good(); ++i) out.palette.push_back(material_from(from));
  const std::size_t embedded = from.number();
  for (std::size_t i = 0; i < embedded && from.good(); ++i) out.embedded.emplace_back(from.text(kUnbounded));
  if (!from.done() || !is_fit(out, with_looks)) return std::nullopt;
  return out;
}

}  // namespace

void MeshMessage::copy(const void* from, std::size_t size) {
  if (parts_.empty() || parts_.back().foreign != nullptr) parts_.push_back({nullptr, own_.size(), 0});
  own_.append(static_cast<const char*>(from), size);
  parts_.back().size += size;
}

void MeshMessage::text(std::string_view text) {
  constexpr std::size_t kCopied = 4096;
  number(text.size());
  if (text.size() <= kCopied) {
    copy(text.data(), text.size());
  } else {
    parts_.push_back({text.data(), 0, text.size()});
  }
}

std::vector<std::string_view> MeshMessage::parts() const {
  std::vector<std::string_view> out;
  out.reserve(parts_.size());
  for (const Part& part : parts_)
    out.emplace_back(part.foreign != nullptr ? part.foreign : own_.data() + part.at, part.size);
  return out;
}

std::string MeshMessage::joined() const {
  std::string out;
  for (const std::string_view part : parts()) out += part;
  return out;
}

MeshMessage encode_mesh_request(const MeshRequest& request) {
  MeshMessage out;
  out.text(request.extension);
  out.number(request.with_looks ? 1 : 0);
  out.copy(request.scale.data(), 3 * sizeof(double));
  out.text(request.bytes);
  out.number(request.buffers.size());
  for (const auto& [name, bytes] : request.buffers) {
    out.text(name);
    out.text(bytes);
  }
  return out;
}

std::optional<MeshRequest> decode_mesh_request(std::string_view bytes) {
  Reader from(bytes);
  MeshRequest out;
  out.extension = from.text(kLongestName);
  out.with_looks = from.number() != 0;
  const auto scale = from.value<std::array<double, 3>>();
  out.scale = Eigen::Vector3d(scale[0], scale[1], scale[2]);
  out.bytes = from.text(kUnbounded);
  const std::size_t buffers = from.number();
  for (std::size_t i = 0; i < buffers && from.good(); ++i) {
    const std::string_view name = from.text(kUnbounded);
    out.buffers.emplace_back(name, from.text(kUnbounded));
  }
  if (!from.done()) return std::nullopt;
  return out;
}

MeshMessage encode_mesh_answer(const Result<ScenePolygons>& answer) {
  MeshMessage out;
  if (!answer) {
    out.number(static_cast<std::size_t>(Kind::error));
    out.text(std::string_view(answer.error().what).substr(0, kLongestError));
    out.text(std::string_view(answer.error().remedy).substr(0, kLongestError));
    return out;
  }
  out.number(static_cast<std::size_t>(Kind::polygons));
  put_list(out, answer->vertices);
  put_list(out, answer->triangles);
  put_list(out, answer->places);
  put_list(out, answer->colours);
  put_list(out, answer->materials);
  out.number(answer->palette.size());
  for (const SceneMaterial& material : answer->palette) {
    out.text(material.name);
    out.text(material.picture);
    out.number(material.embedded ? *material.embedded + 1 : 0);
    out.copy(material.rgb.data(), sizeof(material.rgb));
    out.number(material.is_factor ? 1 : 0);
  }
  out.number(answer->embedded.size());
  for (const std::string& picture : answer->embedded) out.text(picture);
  return out;
}

std::optional<Result<ScenePolygons>> decode_mesh_answer(std::string_view bytes, bool with_looks) {
  Reader from(bytes);
  switch (static_cast<Kind>(from.number())) {
    case Kind::polygons:
      return polygons_from(from, with_looks);
    case Kind::error: {
      const std::string what = printable(from.text(kLongestError), kPrinted);
      const std::string remedy = printable(from.text(kLongestError), kPrinted);
      if (!from.done() || what.empty()) return std::nullopt;
      return fail(what, remedy);
    }
  }
  return std::nullopt;
}

}  // namespace cellmirror
