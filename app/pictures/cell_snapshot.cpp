#include "app/pictures/cell_snapshot.hpp"

#include "app/owner/display/display_service.hpp"
#include "app/owner/volume/volume_service.hpp"
#include "app/pictures/tissue_at_rest.hpp"
#include "app/render/picture_request.hpp"
#include "app/render/renderer_options.hpp"
#include "app/render/scene_source.hpp"
#include "config/volume_user_tables.hpp"
#include "drivers/display/image_codec.hpp"
#include "drivers/display/renderer.hpp"
#include "rt_core/cell/view.hpp"
#include "rt_core/scene/scene_builder.hpp"

namespace cellmirror::app {

Result<CellPicture> cell_snapshot(const LoadedCell& loaded, const SnapshotRequest& wanted) {
  const PictureRequest request = picture_request_of(wanted, loaded.pictures.width, loaded.pictures.height);
  const auto cell = loaded.cell.compile();
  if (const auto checked = check_request(request); !checked) return std::unexpected(checked.error());
  if (const auto checked = check_camera(request, *cell); !checked) return std::unexpected(checked.error());
  const auto positions = loaded.cell.start_positions();
  CellPoses poses;
  compute_poses(*cell, positions, poses);
  const DisplayState display = initial_display(*cell, extent_of(*cell, positions), loaded.views, loaded.layout);
  const Timestamp now = SystemClock().now();
  Scene scene;
  scene::SceneBuilder builder;
  scene::SceneInput input;
  input.cell = cell.get();
  input.poses = &poses;
  input.display = &display;
  input.posture_time = input.now = now;
  const auto tissue = tissue_at_rest(loaded.tissue);
  if (!tissue) return std::unexpected(tissue.error());
  input.tissue = *tissue;
  VolumeService volumes(loaded.cell, [&] { return load_volume_tables(loaded.home); });
  input.volumes = volumes.states().get();
  builder.build(input, scene);
  const auto panes = panes_of({*cell, poses, display, now, 0}, request);
  if (!panes) return std::unexpected(panes.error());
  const auto renderer = display::Renderer::create(renderer_options(loaded.pictures));
  if (!renderer) return std::unexpected(renderer.error());
  Image drawing;
  if (const auto drawn = (*renderer)->draw(scene, *panes, request.width, request.height, drawing); !drawn)
    return std::unexpected(drawn.error());
  CellPicture picture;
  picture.renderer = (*renderer)->name();
  picture.image.format = wanted.format;
  picture.image.width = request.width;
  picture.image.height = request.height;
  picture.image.posture_time = now;
  picture.image.sequence = 1;
  display::ImageEncoder encoder;
  const auto encoded = encoder.encode(
      drawing, {.format = wanted.format, .jpeg_quality = request.quality, .png_level = 6}, picture.image.bytes);
  if (!encoded) return std::unexpected(encoded.error());
  return picture;
}

}  // namespace cellmirror::app
