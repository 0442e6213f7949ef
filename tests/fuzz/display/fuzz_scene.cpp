// Scenes of any numbers: nothing that a cell, a script or a sensor puts into one may harm the renderer. The input is a
// string of small records: a kind and the numbers that it needs, taken as they stand (NaN and infinity among them).
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <span>

#include "drivers/display/renderer.hpp"
#include "rt_core/geometry/shape.hpp"
#include "rt_core/geometry/triangle_mesh.hpp"

namespace {

using namespace cellmirror;

class Input {
 public:
  explicit Input(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
  [[nodiscard]] bool empty() const { return bytes_.empty(); }

  std::uint8_t byte() {
    if (bytes_.empty()) return 0;
    const std::uint8_t value = bytes_.front();
    bytes_ = bytes_.subspan(1);
    return value;
  }
  // Mostly sensible: a byte stands for a number from -3.2 to 3.175 m; 128 for the bits that follow.
  double number() {
    constexpr std::uint8_t kBits = 128;
    const std::uint8_t small = byte();
    if (small != kBits) return static_cast<double>(static_cast<std::int8_t>(small)) / 40;
    double value = 0;
    if (bytes_.size() < sizeof value) return 0;
    std::memcpy(&value, bytes_.data(), sizeof value);
    bytes_ = bytes_.subspan(sizeof value);
    return value;
  }
  Eigen::Vector3d vector() {
    const double x = number();
    const double y = number();
    return {x, y, number()};
  }
  Pose pose() {
    Pose X = Pose::Identity();
    X.translation() = vector();
    if ((byte() & 1U) != 0) X.linear().row(0) = vector();
    return X;
  }
  Colour colour() {
    return {static_cast<float>(number()), static_cast<float>(number()), static_cast<float>(number()),
            static_cast<float>(number())};
  }
  std::string text() {
    std::string words;
    for (std::uint8_t count = byte() % 24; count > 0; --count) words += static_cast<char>(byte());
    return words;
  }

 private:
  std::span<const std::uint8_t> bytes_;
};

void add_body(Input& input, Scene& scene) {
  SceneBody& body = scene.bodies.emplace_back();
  body.object = input.byte();
  body.shape = static_cast<Shape>(input.byte() % 5);
  body.size = input.vector();
  body.X_WG = input.pose();
  constexpr std::array<DrawMode, 4> kModes = {DrawMode::wireframe, DrawMode::flat, DrawMode::gouraud,
                                              DrawMode::transparent};
  const std::uint8_t look = input.byte();
  body.mode = kModes[look % 4];
  body.mark = static_cast<Mark>((look >> 2U) % 4);
  body.rgba = input.colour();
  if (body.shape != Shape::mesh) return;
  auto mesh = std::make_shared<geometry::TriangleMesh>();
  for (std::uint8_t i = input.byte() % 8; i > 0; --i) mesh->vertices.push_back(input.vector());
  for (std::uint8_t i = input.byte() % 8; i > 0; --i) {
    const std::uint32_t a = input.byte() % 9U;
    const std::uint32_t b = input.byte() % 9U;
    mesh->triangles.push_back({a, b, input.byte() % 9U});
  }
  body.mesh = std::move(mesh);
}

void add_mark(Input& input, std::uint8_t kind, Scene& scene) {
  switch (kind) {
    case 0:
      scene.axes.push_back({input.pose(), input.number(), (input.byte() & 1U) != 0, input.text()});
      break;
    case 1: {
      const Eigen::Vector3d from = input.vector();
      const Eigen::Vector3d to = input.vector();
      scene.lines.push_back({from, to, input.colour(), static_cast<float>(input.number()), (input.byte() & 1U) != 0,
                             (input.byte() & 1U) != 0});
      break;
    }
    case 2: {
      SceneTrace& trace = scene.traces.emplace_back();
      trace.rgba = input.colour();
      for (std::uint8_t i = input.byte() % 8; i > 0; --i) trace.points.push_back(input.vector().cast<float>());
      break;
    }
    case 3: {
      const Pose X_WS = input.pose();
      const double half_angle = input.number();
      scene.cones.push_back({X_WS, half_angle, input.number(), input.colour()});
      break;
    }
    case 4: {
      const Eigen::Vector3d from = input.vector();
      scene.arrows.push_back({from, input.vector(), input.colour(), (input.byte() & 1U) != 0});
      break;
    }
    case 5:
      scene.sparks.push_back({input.vector(), input.byte()});
      break;
    case 6: {
      const Eigen::Vector3d at = input.vector();
      scene.labels.push_back({at, input.text(), static_cast<Mark>(input.byte() % 4)});
      break;
    }
    default: {
      const double z = input.number();
      const Eigen::Vector2d low = input.vector().head<2>();
      scene.shadow_catchers.push_back({z, low, input.vector().head<2>()});
    }
  }
}

Pane pane_of(Input& input) {
  Pane pane;
  pane.eye.X_WE = input.pose();
  pane.eye.opening_angle = input.number();
  pane.eye.height_m = input.number();
  pane.eye.near_distance = input.number();
  pane.eye.far_distance = input.number();
  pane.left = input.number();
  pane.top = input.number();
  pane.width = input.number();
  pane.height = input.number();
  pane.title = input.text();
  return pane;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const auto kRenderer = display::Renderer::create();
  if (!kRenderer) return 0;
  Input input({data, size});
  Scene scene;
  const std::uint16_t modes = static_cast<std::uint16_t>(input.byte() | (input.byte() << 8U));
  scene.modes = DisplayModes(modes & 0x3FFFU);
  std::vector<Pane> panes = {pane_of(input)};
  constexpr int kMostThings = 40;
  for (int i = 0; i < kMostThings && !input.empty(); ++i) {
    const std::uint8_t kind = input.byte() % 12;
    if (kind < 8) {
      add_mark(input, kind, scene);
    } else if (kind == 8) {
      panes.push_back(pane_of(input));
    } else if (kind == 9) {
      scene.floor_z_m = input.number();
      scene.floor_low = input.vector().head<2>();
      scene.floor_high = input.vector().head<2>();
      scene.legend.push_back({input.colour(), input.text()});
      scene.messages.push_back(input.text());
    } else {
      add_body(input, scene);
    }
  }
  constexpr int kEdge = 48;
  Image picture;
  std::vector<std::uint32_t> objects;
  if (!(*kRenderer)->draw(scene, panes, kEdge, kEdge, picture)) std::abort();
  if (picture.rgba.size() != std::size_t{4} * kEdge * kEdge) std::abort();
  if (!(*kRenderer)->objects(scene, panes, kEdge, kEdge, objects)) std::abort();
  return 0;
}
