// display_gallery FOLDER: pictures of all that can be drawn, to be looked at.
#include <cstdio>
#include <fstream>

#include "drivers/display/image_codec.hpp"
#include "drivers/display/renderer.hpp"
#include "tests/unit/display/test_scenes.hpp"
#include "tests/unit/display/tissue_scenes.hpp"

namespace cellmirror::display {
namespace {

bool save(const Image& picture, const std::string& file) {
  ImageEncoder encoder;
  std::vector<std::uint8_t> bytes;
  if (!encoder.encode(picture, {.format = ImageFormat::png}, bytes)) return false;
  std::ofstream out(file, std::ios::binary);
  out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  return out.good();
}

std::vector<Pane> six_panes() {
  std::vector<Pane> panes;
  for (int i = 0; i < 6; ++i) {
    Pane pane = gallery_pane();
    const double angle = i * 1.05;
    pane = pane_looking_at({5 * std::sin(angle), -5 * std::cos(angle), 2.5}, {0.3, 0.1, 0.6}, 0.5);
    pane.left = (i % 3) / 3.0;
    pane.top = i < 3 ? 0 : 0.5;
    pane.width = 1 / 3.0;
    pane.height = 0.5;
    pane.title = "View " + std::to_string(i);
    panes.push_back(pane);
  }
  return panes;
}

int gallery(const std::string& folder) {
  const auto renderer = Renderer::create();
  if (!renderer) {
    std::fprintf(stderr, "%s\n", renderer.error().text().c_str());
    return 1;
  }
  std::printf("%s\n", std::string((*renderer)->name()).c_str());
  Image picture;
  Scene scene = gallery_scene();
  const std::vector<Pane> one = {gallery_pane()};
  const auto draw = [&](std::span<const Pane> panes, const char* name) {
    const Result<void> drawn = (*renderer)->draw(scene, panes, 1280, 720, picture);
    return drawn && save(picture, folder + "/" + name + ".png");
  };
  bool ok = draw(one, "all");
  ok = draw(six_panes(), "panes") && ok;
  scene.modes.set(static_cast<std::size_t>(DisplayMode::textures));
  ok = draw(one, "textures") && ok;
  scene.modes.reset();
  ok = draw(one, "no_modes") && ok;
  for (SceneBody& body : scene.bodies) body.mode = DrawMode::wireframe;
  ok = draw(one, "wireframe") && ok;
  for (SceneBody& body : scene.bodies) body.mode = DrawMode::flat;
  ok = draw(one, "flat") && ok;
  scene = tissue_gallery_scene();
  std::vector<Pane> tissue(2, tissue_gallery_pane());
  tissue[0].width = tissue[1].width = tissue[1].left = 0.5;
  tissue[1].camera = 1;
  tissue[1].title = "Camera";
  ok = draw(std::vector<Pane>{tissue_gallery_pane()}, "tissue") && ok;
  ok = draw(tissue, "tissue_camera") && ok;
  scene.tissue_modes = {DrawMode::flat};
  ok = draw(std::vector<Pane>{tissue_gallery_pane()}, "tissue_flat") && ok;
  scene.tissue_modes = {DrawMode::wireframe};
  ok = draw(std::vector<Pane>{tissue_gallery_pane()}, "tissue_wireframe") && ok;
  scene.tissue_modes = {DrawMode::transparent};
  ok = draw(std::vector<Pane>{tissue_gallery_pane()}, "tissue_transparent") && ok;
  scene.tissue_modes.clear();
  TissueView view = *scene.tissue;
  view.network = organ_network(0.05, 0.01);
  scene.tissue = std::make_shared<const TissueView>(std::move(view));
  ok = draw(std::vector<Pane>{tissue_gallery_pane()}, "tissue_network") && ok;
  return ok ? 0 : 1;
}

}  // namespace
}  // namespace cellmirror::display

int main(int argc, char** argv) {
  if (argc == 2) return cellmirror::display::gallery(argv[1]);
  std::fprintf(stderr, "usage: display_gallery FOLDER\n");
  return 2;
}
