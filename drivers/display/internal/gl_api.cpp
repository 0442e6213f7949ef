#include "drivers/display/internal/gl_api.hpp"

namespace cellmirror::display {

Result<GlApi> load_gl(const GlContext& context) {
  GlApi gl;
  // NOLINTBEGIN: the list of gl_api.hpp
#define CELLMIRROR_GL_LOAD(TYPE, NAME)                                     \
  gl.NAME = reinterpret_cast<PFNGL##TYPE##PROC>(context.find("gl" #NAME)); \
  if (gl.NAME == nullptr)                                                  \
    return fail(std::string(context.backend()) + " has no gl" #NAME, "apt-get install libosmesa6 libgl1-mesa-dri");
  CELLMIRROR_GL_FUNCTIONS(CELLMIRROR_GL_LOAD)
#undef CELLMIRROR_GL_LOAD
  // NOLINTEND
  return gl;
}

}  // namespace cellmirror::display
