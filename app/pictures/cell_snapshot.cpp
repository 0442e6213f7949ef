#include "app/pictures/cell_snapshot.hpp"

#include "app/gateway/display_desk.hpp"
#include "app/gateway/picture_wish.hpp"
#include "app/gateway/scene_source.hpp"
#include "app/pictures/renderer_options.hpp"
#include "drivers/display/image_codec.hpp"
#include "drivers/display/renderer.hpp"
#include "rt_core/cell/view.hpp"
#include "rt_core/scene/scene_builder.hpp"

namespace cellmirror::app {

Result<CellPicture> cell_snapshot(const LoadedCell& loaded, const SnapshotRequest& wanted) {
  const PictureRequest wish = wish_of(wanted, loaded.pictures.width, loaded.pictures.height);
  const auto cell = loaded.cell.compile();
  if (const auto checked = check_wish(wish); !checked) return std::unexpected(checked.error());
  if (const auto checked = check_camera(wish, *cell); !checked) return std::unexpected(checked.error());
  const auto positions = loaded.cell.start_positions();
  CellPoses poses;
  compute_poses(*cell, positions, poses);
  const DisplayState display = first_display(*cell, extent_of(*cell, positions), loaded.views, loaded.layout);
  const Timestamp now = SystemClock().now();
  Scene scene;
  scene::SceneBuilder builder;
  scene::SceneInput input;
  input.cell = cell.get();
  input.poses = &poses;
  input.display = &display;
  input.posture_time = input.now = now;
  builder.build(input, scene);
  const auto panes = panes_of({*cell, poses, display, now, 0}, wish);
  if (!panes) return std::unexpected(panes.error());
  const auto renderer = display::Renderer::create(renderer_options(loaded.pictures));
  if (!renderer) return std::unexpected(renderer.error());
  Image drawing;
  if (const auto drawn = (*renderer)->draw(scene, *panes, wish.width, wish.height, drawing); !drawn)
    return std::unexpected(drawn.error());
  CellPicture picture;
  picture.renderer = (*renderer)->name();
  picture.image.format = wanted.format;
  picture.image.width = wish.width;
  picture.image.height = wish.height;
  picture.image.posture_time = now;
  picture.image.sequence = 1;
  display::ImageEncoder encoder;
  const auto encoded = encoder.encode(drawing, {.format = wanted.format, .jpeg_quality = wish.quality, .png_level = 6},
                                      picture.image.bytes);
  if (!encoded) return std::unexpected(encoded.error());
  return picture;
}

}  // namespace cellmirror::app
