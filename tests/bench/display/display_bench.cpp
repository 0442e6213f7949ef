// display_bench [ROUNDS]: the renderer against a bare OSMesa program that draws the same buffers in the same run, by
// turns, with and without anti-aliasing: 100,000 triangles, Gouraud, 1280x720. Tells medians and the ratio of rates.
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>

#include "drivers/display/image_codec.hpp"
#include "drivers/display/internal/surface.hpp"
#include "drivers/display/internal/view_transform.hpp"
#include "drivers/display/renderer.hpp"
#include "rt_core/ports/mesh_appearance.hpp"
#include "tests/bench/display/bare_program.hpp"
#include "tests/unit/display/test_scenes.hpp"
#include "tests/unit/display/tissue_scenes.hpp"

namespace cellmirror::display {
namespace {

constexpr int kWidth = 1280;
constexpr int kHeight = 720;

double milliseconds(const std::function<void()>& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

bench::BareMesh same_buffers(const geometry::TriangleMesh& mesh) {
  const Surface surface = smooth_surface(mesh);
  bench::BareMesh bare;
  for (const Vertex& vertex : surface.vertices) {
    for (const Eigen::Vector3f& part : {vertex.position, vertex.normal})
      bare.vertices.insert(bare.vertices.end(), part.data(), part.data() + 3);
  }
  bare.corners = surface.corners;
  return bare;
}

bool compare(Renderer& renderer, int rounds, bool smooth) {
  const auto mesh = torus(1, 0.42, 500, 100);  // 100,000 triangles
  Scene scene;
  add_mesh(scene, mesh, Pose::Identity());
  if (smooth) scene.modes.set(static_cast<std::size_t>(DisplayMode::antialiasing));
  const std::vector<Pane> panes = {pane_looking_at({0.6, -2.6, 2.1}, {0, 0, 0}, 0.8)};
  const auto bare = bench::BareProgram::make(same_buffers(*mesh), kWidth, kHeight, smooth ? 4 : 0);
  const auto view = ViewTransform::of(panes[0], kWidth, kHeight);
  if (bare == nullptr || !view) return false;
  const Eigen::Matrix4f matrix = view->clip_from_world().cast<float>();
  Image picture;
  std::vector<std::uint8_t> pixels;
  std::vector<double> ours;
  std::vector<double> theirs;
  for (int i = 0; i < rounds + 3; ++i) {
    const double a = milliseconds([&] { static_cast<void>(renderer.draw(scene, panes, kWidth, kHeight, picture)); });
    const double b = milliseconds([&] { bare->draw(matrix.data(), pixels); });
    if (i < 3) continue;  // shaders are compiled
    ours.push_back(a);
    theirs.push_back(b);
  }
  std::printf("%-22s %8.2f ms %8.2f ms   rate %.2f of the bare program's\n",
              smooth ? "4x anti-aliasing" : "no anti-aliasing", median(ours), median(theirs),
              median(theirs) / median(ours));
  return true;
}

void time_gallery(Renderer& renderer, int rounds, int width, int height) {
  const Scene scene = gallery_scene();
  const std::vector<Pane> panes = {gallery_pane()};
  ImageEncoder encoder;
  Image picture;
  std::vector<std::uint8_t> bytes;
  std::vector<double> drawing;
  std::vector<double> picking;
  std::vector<double> jpeg;
  std::vector<std::uint32_t> numbers;
  for (int i = 0; i < rounds; ++i) {
    drawing.push_back(milliseconds([&] { static_cast<void>(renderer.draw(scene, panes, width, height, picture)); }));
    picking.push_back(milliseconds([&] { static_cast<void>(renderer.objects(scene, panes, width, height, numbers)); }));
    jpeg.push_back(milliseconds([&] { static_cast<void>(encoder.encode(picture, {}, bytes)); }));
  }
  std::printf("gallery %4dx%-4d       %8.2f ms, objects %.2f ms, JPEG %.2f ms (%zu bytes)\n", width, height,
              median(drawing), median(picking), median(jpeg), bytes.size());
}

// Of the processors, by all threads of this program.
double cpu_milliseconds(const std::function<void()>& work) {
  const std::clock_t begin = std::clock();
  work();
  return 1e3 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

// What a picture on a mesh costs.
void time_textured(Renderer& renderer, int rounds) {
  constexpr int kEdge = 512;
  auto image = std::make_shared<Image>();
  image->width = image->height = kEdge;
  for (int i = 0; i < kEdge * kEdge; ++i) {
    const auto value = static_cast<std::uint8_t>((i / 32 + i / (32 * kEdge)) % 2 == 0 ? 210 : 60);
    image->rgba.insert(image->rgba.end(), {value, value, value, 255});
  }
  const auto mesh = torus(1, 0.42, 500, 100);
  auto look = std::make_shared<MeshAppearance>();
  look->materials.assign(mesh->triangles.size(), 0);
  look->palette = {{std::move(image), {1, 1, 1}}};
  for (const geometry::TriangleIndices& triangle : mesh->triangles) {
    for (const std::uint32_t vertex : triangle) {
      const Eigen::Vector3d& p = mesh->vertices[vertex];
      look->places.emplace_back(static_cast<float>(2 * p.x()), static_cast<float>(2 * p.y()));
    }
  }
  Scene scene;
  add_mesh(scene, mesh, Pose::Identity()).look = std::move(look);
  const std::vector<Pane> panes = {pane_looking_at({0.6, -2.6, 2.1}, {0, 0, 0}, 0.8)};
  Image picture;
  std::array<std::vector<double>, 2> times;
  for (int i = 0; i < 2 * (rounds + 3); ++i) {
    const auto on = static_cast<std::size_t>(i % 2);
    scene.modes.set(static_cast<std::size_t>(DisplayMode::textures), on != 0);
    const double a =
        cpu_milliseconds([&] { static_cast<void>(renderer.draw(scene, panes, kWidth, kHeight, picture)); });
    if (i >= 6) times[on].push_back(a);
  }
  std::printf("%-22s %8.2f ms of processor, TEXTURES off %.2f ms\n", "picture on a mesh", median(times[1]),
              median(times[0]));
}

// What a deforming surface of 10,000 triangles costs beside the gallery's cell, each picture another shape of it; and
// with all that may belong to it: a pool, particles, a clip.
void time_tissue(Renderer& renderer, int rounds, int width, int height) {
  constexpr unsigned kAround = 100;
  constexpr unsigned kAcross = 50;
  constexpr int kShapes = 20;
  Scene scene = gallery_scene();
  const auto topology = organ_topology(kAround, kAcross);
  const std::shared_ptr<const TissueView> parts = tissue_gallery_scene().tissue;
  std::array<std::vector<std::shared_ptr<const TissueView>>, 3> views;
  for (int i = 0; i < kShapes; ++i) {
    TissueView view;
    view.step = static_cast<std::uint64_t>(i);
    view.surfaces.push_back(organ(topology, kAround, kAcross, 0.3, 0.3 * i));
    for (Eigen::Vector3f& p : view.surfaces[0].vertices) p += Eigen::Vector3f(0.5F, -0.2F, 0.9F);
    views[0].push_back(nullptr);
    views[1].push_back(std::make_shared<const TissueView>(view));
    view.pool = parts->pool;
    view.pool.size_m = {0.8F, 0.5F};
    view.pool.X_WP.translation() << 0.55, -0.1, 0.68;
    view.particles = parts->particles;
    for (TissueParticle& particle : view.particles) {
      particle.at = 6 * particle.at + Eigen::Vector3f(0.5F, -0.2F, 0.9F);
      particle.radius_m *= 6;
    }
    view.clips = parts->clips;
    views[2].push_back(std::make_shared<const TissueView>(view));
  }
  const std::vector<Pane> panes = {gallery_pane()};
  Image picture;
  std::array<std::vector<double>, 3> wall;
  std::array<std::vector<double>, 3> cpu;
  for (int i = 0; i < 3 * (rounds + 3); ++i) {
    const auto which = static_cast<std::size_t>(i % 3);
    scene.tissue = views[which][static_cast<std::size_t>(i / 3 % kShapes)];
    double spent = 0;
    const double taken = milliseconds([&] {
      spent = cpu_milliseconds([&] { static_cast<void>(renderer.draw(scene, panes, width, height, picture)); });
    });
    if (i < 9) continue;
    wall[which].push_back(taken);
    cpu[which].push_back(spent);
  }
  std::printf(
      "tissue %4dx%-4d        %8.2f ms (%.2f of processor), with all its parts %.2f (%.2f), without %.2f (%.2f)\n",
      width, height, median(wall[1]), median(cpu[1]), median(wall[2]), median(cpu[2]), median(wall[0]), median(cpu[0]));
}

int run(int rounds) {
  const auto renderer = Renderer::create({.backend = Backend::osmesa});
  if (!renderer) {
    std::fprintf(stderr, "%s\n", renderer.error().text().c_str());
    return 1;
  }
  std::printf("%s\n%-22s %11s %11s\n", std::string((*renderer)->name()).c_str(), "", "renderer", "bare OSMesa");
  const bool done = compare(**renderer, rounds, false) && compare(**renderer, rounds, true);
  time_textured(**renderer, rounds);
  time_gallery(**renderer, rounds, 640, 480);
  time_gallery(**renderer, rounds, kWidth, kHeight);
  time_tissue(**renderer, rounds, 640, 480);
  time_tissue(**renderer, rounds, kWidth, kHeight);
  return done ? 0 : 1;
}

}  // namespace
}  // namespace cellmirror::display

int main(int argc, char** argv) { return cellmirror::display::run(argc > 1 ? std::max(1, std::atoi(argv[1])) : 60); }
