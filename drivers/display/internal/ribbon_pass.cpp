#include "drivers/display/internal/ribbon_pass.hpp"

#include <cstddef>

#include "drivers/display/internal/shaders.hpp"

namespace cellmirror::display {

RibbonPass::~RibbonPass() {
  if (array_ == 0) return;
  gl_.DeleteVertexArrays(1, &array_);
  gl_.DeleteBuffers(1, &vertices_);
  gl_.DeleteBuffers(1, &indices_);
}

Result<void> RibbonPass::build() {
  if (Result<void> built = program_.build(shaders::kRibbonVertex, shaders::kRibbonFragment); !built) return built;
  gl_.GenVertexArrays(1, &array_);
  gl_.BindVertexArray(array_);
  gl_.GenBuffers(1, &vertices_);
  gl_.GenBuffers(1, &indices_);
  gl_.BindBuffer(GL_ARRAY_BUFFER, vertices_);
  gl_.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_);
  const auto offset = [](std::size_t bytes) { return reinterpret_cast<const void*>(bytes); };
  for (const GLuint attribute : {0U, 1U, 2U}) gl_.EnableVertexAttribArray(attribute);
  gl_.VertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(RibbonVertex), offset(0));
  gl_.VertexAttribPointer(1, 4, GL_UNSIGNED_BYTE, GL_TRUE, sizeof(RibbonVertex), offset(offsetof(RibbonVertex, rgba)));
  gl_.VertexAttribPointer(2, 4, GL_FLOAT, GL_FALSE, sizeof(RibbonVertex), offset(offsetof(RibbonVertex, shape)));
  return {};
}

void RibbonPass::draw(const Ribbons& ribbons, bool on_top) {
  if (ribbons.empty()) return;
  program_.use();
  gl_.BindVertexArray(array_);
  gl_.BindBuffer(GL_ARRAY_BUFFER, vertices_);
  gl_.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(ribbons.vertices().size() * sizeof(RibbonVertex)),
                 ribbons.vertices().data(), GL_STREAM_DRAW);
  gl_.BufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(ribbons.indices().size() * sizeof(std::uint32_t)),
                 ribbons.indices().data(), GL_STREAM_DRAW);
  gl_.Enable(GL_BLEND);
  gl_.DepthMask(GL_FALSE);
  if (on_top) gl_.Disable(GL_DEPTH_TEST);
  gl_.Enable(GL_POLYGON_OFFSET_FILL);  // lines on a face are before it
  gl_.PolygonOffset(-1, -1);
  gl_.DrawElements(GL_TRIANGLES, static_cast<GLsizei>(ribbons.indices().size()), GL_UNSIGNED_INT, nullptr);
  gl_.Disable(GL_POLYGON_OFFSET_FILL);
  gl_.Enable(GL_DEPTH_TEST);
  gl_.DepthMask(GL_TRUE);
  gl_.Disable(GL_BLEND);
}

}  // namespace cellmirror::display
