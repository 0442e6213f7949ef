#include "drivers/display/renderer.hpp"

#include "drivers/display/internal/background.hpp"
#include "drivers/display/internal/body_pass.hpp"
#include "drivers/display/internal/floor_pass.hpp"
#include "drivers/display/internal/gl_api.hpp"
#include "drivers/display/internal/gl_context.hpp"
#include "drivers/display/internal/marks.hpp"
#include "drivers/display/internal/mesh_store.hpp"
#include "drivers/display/internal/reach.hpp"
#include "drivers/display/internal/render_target.hpp"
#include "drivers/display/internal/ribbon_pass.hpp"
#include "drivers/display/internal/tissue/tissue_layer.hpp"
#include "drivers/display/internal/volume/volume_layer.hpp"
#include "drivers/display/internal/words.hpp"

namespace cellmirror::display {

namespace {

constexpr int kSmallestEdge = 16;
constexpr std::size_t kMostPanes = 16;

Result<void> check_size(int width, int height) {
  if (width >= kSmallestEdge && width <= kLargestImageEdge && height >= kSmallestEdge && height <= kLargestImageEdge)
    return {};
  return fail(
      "a picture of " + std::to_string(width) + "x" + std::to_string(height) + " pixels cannot be drawn",
      "ask for " + std::to_string(kSmallestEdge) + " to " + std::to_string(kLargestImageEdge) + " pixels each way");
}

bool is_on(const Scene& scene, DisplayMode mode) { return scene.modes.test(static_cast<std::size_t>(mode)); }

// Those that are drawn, with the clipping planes that suit the scene.
std::vector<Pane> bounded_panes(std::span<const Pane> panes, const Box& reach) {
  const std::span<const Pane> drawn = panes.first(std::min(panes.size(), kMostPanes));
  std::vector<Pane> bounded(drawn.begin(), drawn.end());
  for (Pane& pane : bounded) pane.eye = bounded_by(reach, pane.eye);
  return bounded;
}

std::string text_of(const GlApi& gl, GLenum what) {
  const GLubyte* const text = gl.GetString(what);
  return text == nullptr ? "unknown" : reinterpret_cast<const char*>(text);
}

}  // namespace

struct Renderer::Impl {
  Impl(std::unique_ptr<GlContext> made, const GlApi& loaded, int threads)
      : context(std::move(made)),
        gl(loaded),
        meshes(gl),
        target(gl),
        object_target(gl),
        bodies(gl, meshes.textures()),
        background(gl),
        floor(gl),
        ribbons(gl),
        tissue(gl, meshes.textures()),
        volumes(gl, threads) {}
  ~Impl() { static_cast<void>(context->make_current()); }  // what is destroyed next frees its things in it

  Result<void> prepare();
  Result<void> begin(int width, int height);
  Result<void> end(int width, int height);
  Result<void> draw_pane(const Frame& frame, std::size_t pane, std::vector<DrawnBody>& drawn);
  void draw_words(const Scene& scene, std::span<const Pane> panes, Image& picture);
  Result<void> pick_volumes(const Scene& scene, std::span<const Pane> panes, const Box& reach, int width, int height,
                            std::vector<std::uint32_t>& objects);
  void clip_to(const PixelRect& pixels) const {
    gl.Viewport(pixels.x, pixels.y, pixels.width, pixels.height);
    gl.Scissor(pixels.x, pixels.y, pixels.width, pixels.height);
  }

  std::unique_ptr<GlContext> context;
  GlApi gl;
  std::string name;
  MeshStore meshes;
  RenderTarget target;
  RenderTarget object_target;
  BodyPass bodies;
  Background background;
  FloorPass floor;
  RibbonPass ribbons;
  TissueLayer tissue;
  VolumeLayer volumes;
  Marks marks;
  Words words;
  RendererCounters counters;
};

Result<void> Renderer::Impl::prepare() {
  name = std::string(context->backend()) + ": " + text_of(gl, GL_RENDERER) + ", OpenGL " + text_of(gl, GL_VERSION);
  Result<void> built = bodies.build();
  if (built) built = background.build();
  if (built) built = floor.build();
  if (built) built = ribbons.build();
  if (built) built = tissue.build();
  return built;
}

Result<void> Renderer::Impl::begin(int width, int height) {
  if (Result<void> size = check_size(width, height); !size) return size;
  if (!context->make_current()) return fail("the graphics context is lost", "start again");
  while (gl.GetError() != GL_NO_ERROR) {
  }
  gl.FrontFace(GL_CW);  // pictures are drawn upside down: see RenderTarget
  gl.PixelStorei(GL_PACK_ALIGNMENT, 1);
  gl.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
  gl.BlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
  gl.DepthFunc(GL_LESS);
  gl.DepthMask(GL_TRUE);
  gl.Disable(GL_BLEND);
  gl.Enable(GL_SCISSOR_TEST);
  gl.Enable(GL_DEPTH_TEST);
  meshes.begin_frame();
  counters.bodies_drawn = 0;
  counters.bodies_left_out = 0;
  return {};
}

Result<void> Renderer::Impl::end(int width, int height) {
  meshes.end_frame();
  counters.meshes = meshes.size();
  counters.uploads = meshes.uploads();
  counters.tissue_uploads = tissue.topology_uploads();
  counters.textures = meshes.textures().size();
  counters.texture_uploads = meshes.textures().uploads();
  counters.texture_bytes = meshes.textures().bytes();
  const VolumeCounts& cast = volumes.counts();
  counters.volumes = cast.volumes;
  counters.volume_bricks = cast.bricks;
  counters.volume_bricks_drawn = cast.bricks_drawn;
  counters.volume_reduction = cast.reduction;
  counters.volume_in_haste = cast.hasty;
  counters.volume_ns = static_cast<std::uint64_t>(cast.took.count());
  ++counters.frames;
  if (gl.GetError() == GL_NO_ERROR) return {};
  return fail("the graphics system ran out of memory with a picture of " + std::to_string(width) + "x" +
                  std::to_string(height) + " pixels",
              "request a smaller one");
}

Result<void> Renderer::Impl::draw_pane(const Frame& frame, std::size_t pane, std::vector<DrawnBody>& drawn) {
  const BodyCounts counts = BodyPass::examine(frame, drawn);
  counters.bodies_drawn += counts.drawn;
  counters.bodies_left_out += counts.left_out;
  marks.gather(frame, meshes);
  bodies.draw_opaque(frame, drawn);
  bodies.draw_extra(frame, marks.solids);
  tissue.draw_opaque(frame);
  background.draw();
  if (is_on(frame.scene, DisplayMode::floor)) floor.draw(frame, ribbons);
  if (Result<void> done = volumes.draw(frame, pane, target); !done) return done;
  bodies.draw_see_through(frame, drawn);
  tissue.draw_see_through(frame);
  gl.Enable(GL_BLEND);
  gl.DepthMask(GL_FALSE);
  bodies.draw_extra(frame, marks.see_through);
  gl.DepthMask(GL_TRUE);
  gl.Disable(GL_BLEND);
  tissue.draw_veil(frame);
  ribbons.draw(marks.hidden_by_bodies, false);
  ribbons.draw(marks.on_top, true);
  return {};
}

void Renderer::Impl::draw_words(const Scene& scene, std::span<const Pane> panes, Image& picture) {
  for (const Pane& pane : panes) {
    if (const auto view = ViewTransform::of(pane, picture.width, picture.height))
      words.draw_pane({scene, *view, pane.camera}, picture);
    words.draw_title(pane, picture.width, picture.height, picture);
  }
  draw_borders(panes, picture);
  words.draw_legend(scene, picture);
  words.draw_messages(scene, picture);
}

Result<void> Renderer::Impl::pick_volumes(const Scene& scene, std::span<const Pane> panes, const Box& reach, int width,
                                          int height, std::vector<std::uint32_t>& objects) {
  if (scene.volumes.empty()) return {};
  std::vector<float> depth(objects.size());
  if (Result<void> read = object_target.read_depth(0, 0, width, height, depth.data()); !read) return read;
  volumes.begin(scene, Nanoseconds{0});
  for (const Pane& pane : bounded_panes(panes, reach)) {
    if (const auto view = ViewTransform::of(pane, width, height))
      volumes.pick({scene, *view, pane.camera}, depth, width, objects);
  }
  return {};
}

Renderer::Renderer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Renderer::~Renderer() = default;

Result<std::unique_ptr<Renderer>> Renderer::create(const RendererOptions& options) {
  auto context = make_context(options);
  if (!context) return std::unexpected(context.error());
  const auto gl = load_gl(**context);
  if (!gl) return std::unexpected(gl.error());
  auto impl = std::make_unique<Impl>(std::move(*context), *gl, options.threads);
  if (const Result<void> prepared = impl->prepare(); !prepared) return std::unexpected(prepared.error());
  return std::unique_ptr<Renderer>(new Renderer(std::move(impl)));
}

std::string_view Renderer::name() const { return impl_->name; }
RendererCounters Renderer::counters() const { return impl_->counters; }

Result<void> Renderer::draw(const Scene& scene, std::span<const Pane> panes, int width, int height, Image& picture,
                            bool smooth, Nanoseconds volume_time) {
  Impl& impl = *impl_;
  if (Result<void> begun = impl.begin(width, height); !begun) return begun;
  std::vector<DrawnBody> drawn = drawn_bodies(scene, impl.meshes);
  impl.tissue.prepare(scene, impl.meshes, drawn);
  Box reach = reach_of(scene, drawn);
  reach.extend(impl.tissue.bounds());
  if (is_on(scene, DisplayMode::floor)) {
    if (Result<void> prepared = impl.floor.prepare(scene, drawn, impl.tissue.casting()); !prepared) return prepared;
    reach.extend(impl.floor.reach(scene));
  }
  const std::vector<Pane> drawn_panes = bounded_panes(panes, reach);
  const Pixels pixels = smooth && is_on(scene, DisplayMode::antialiasing) ? Pixels::smooth_colours : Pixels::colours;
  if (Result<void> begun = impl.target.begin(pixels, width, height); !begun) return begun;
  impl.gl.ClearColor(0.80F, 0.82F, 0.85F, 1);
  impl.gl.Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  impl.volumes.begin(scene, volume_time);
  for (std::size_t i = 0; i < drawn_panes.size(); ++i) {
    const Pane& pane = drawn_panes[i];
    const std::optional<PixelRect> rect = pixels_of(pane, width, height);
    if (!rect) continue;
    impl.clip_to(*rect);
    const auto view = ViewTransform::of(pane, width, height);
    if (!view) {
      impl.background.draw();
    } else if (Result<void> done = impl.draw_pane({scene, *view, pane.camera}, i, drawn); !done) {
      return done;
    }
  }
  picture.width = width;
  picture.height = height;
  picture.rgba.resize(std::size_t{4} * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  impl.target.read_colours(picture.rgba.data());
  impl.draw_words(scene, drawn_panes, picture);
  return impl.end(width, height);
}

Result<void> Renderer::objects(const Scene& scene, std::span<const Pane> panes, int width, int height,
                               std::vector<std::uint32_t>& objects) {
  Impl& impl = *impl_;
  if (Result<void> begun = impl.begin(width, height); !begun) return begun;
  if (Result<void> begun = impl.object_target.begin(Pixels::objects, width, height); !begun) return begun;
  constexpr std::array<GLuint, 4> kNone{};
  impl.gl.ClearBufferuiv(GL_COLOR, 0, kNone.data());
  impl.gl.Clear(GL_DEPTH_BUFFER_BIT);
  std::vector<DrawnBody> drawn = drawn_bodies(scene, impl.meshes);
  const Box reach = reach_of(scene, drawn);
  for (const Pane& pane : bounded_panes(panes, reach)) {
    const auto view = ViewTransform::of(pane, width, height);
    if (!view) continue;
    impl.clip_to(view->pixels());
    const Frame frame{scene, *view};
    BodyPass::examine(frame, drawn);
    impl.bodies.draw_objects(frame, drawn);
  }
  objects.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  impl.object_target.read_objects(objects.data());
  if (Result<void> picked = impl.pick_volumes(scene, panes, reach, width, height, objects); !picked) return picked;
  return impl.end(width, height);
}

}  // namespace cellmirror::display
