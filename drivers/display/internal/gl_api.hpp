// The functions of OpenGL 3.3 core that we use, of one context: OSMesa and EGL each bring their own, so that nothing is
// linked by name. Private to this folder.
#pragma once

#include <GL/glcorearb.h>

#include "drivers/display/internal/gl_context.hpp"

namespace cellmirror::display {

// clang-format off: a list that is read twice
// NOLINTBEGIN
#define CELLMIRROR_GL_FUNCTIONS(X) \
  X(ACTIVETEXTURE, ActiveTexture) X(ATTACHSHADER, AttachShader) X(BINDBUFFER, BindBuffer) \
  X(BINDFRAMEBUFFER, BindFramebuffer) X(BINDRENDERBUFFER, BindRenderbuffer) X(BINDTEXTURE, BindTexture) \
  X(BINDVERTEXARRAY, BindVertexArray) X(BLENDEQUATION, BlendEquation) X(BLENDFUNC, BlendFunc) \
  X(BLENDFUNCSEPARATE, BlendFuncSeparate) X(BLITFRAMEBUFFER, BlitFramebuffer) X(BUFFERDATA, BufferData) \
  X(CHECKFRAMEBUFFERSTATUS, CheckFramebufferStatus) X(CLEAR, Clear) X(CLEARBUFFERUIV, ClearBufferuiv) \
  X(CLEARCOLOR, ClearColor) X(COLORMASK, ColorMask) X(COMPILESHADER, CompileShader) \
  X(CREATEPROGRAM, CreateProgram) X(CREATESHADER, CreateShader) X(CULLFACE, CullFace) \
  X(DELETEBUFFERS, DeleteBuffers) X(DELETEFRAMEBUFFERS, DeleteFramebuffers) X(DELETEPROGRAM, DeleteProgram) \
  X(DELETERENDERBUFFERS, DeleteRenderbuffers) X(DELETESHADER, DeleteShader) X(DELETETEXTURES, DeleteTextures) \
  X(DELETEVERTEXARRAYS, DeleteVertexArrays) X(DEPTHFUNC, DepthFunc) X(DEPTHMASK, DepthMask) X(DISABLE, Disable) \
  X(DRAWARRAYS, DrawArrays) X(DRAWBUFFERS, DrawBuffers) X(DRAWELEMENTS, DrawElements) X(ENABLE, Enable) \
  X(ENABLEVERTEXATTRIBARRAY, EnableVertexAttribArray) X(FRAMEBUFFERRENDERBUFFER, FramebufferRenderbuffer) \
  X(FRONTFACE, FrontFace) X(GENBUFFERS, GenBuffers) X(GENFRAMEBUFFERS, GenFramebuffers) \
  X(GENRENDERBUFFERS, GenRenderbuffers) X(GENTEXTURES, GenTextures) X(GENVERTEXARRAYS, GenVertexArrays) \
  X(GENERATEMIPMAP, GenerateMipmap) X(GETERROR, GetError) X(GETINTEGERV, GetIntegerv) \
  X(GETPROGRAMINFOLOG, GetProgramInfoLog) X(GETPROGRAMIV, GetProgramiv) X(GETSHADERINFOLOG, GetShaderInfoLog) \
  X(GETSHADERIV, GetShaderiv) X(GETSTRING, GetString) X(GETUNIFORMLOCATION, GetUniformLocation) \
  X(LINKPROGRAM, LinkProgram) X(PIXELSTOREI, PixelStorei) X(POLYGONOFFSET, PolygonOffset) \
  X(READBUFFER, ReadBuffer) X(READPIXELS, ReadPixels) X(RENDERBUFFERSTORAGE, RenderbufferStorage) \
  X(RENDERBUFFERSTORAGEMULTISAMPLE, RenderbufferStorageMultisample) X(SCISSOR, Scissor) \
  X(SHADERSOURCE, ShaderSource) X(TEXIMAGE2D, TexImage2D) X(TEXPARAMETERI, TexParameteri) \
  X(UNIFORM1F, Uniform1f) X(UNIFORM1I, Uniform1i) X(UNIFORM1UI, Uniform1ui) X(UNIFORM3FV, Uniform3fv) \
  X(UNIFORM4FV, Uniform4fv) X(UNIFORMMATRIX3FV, UniformMatrix3fv) X(UNIFORMMATRIX4FV, UniformMatrix4fv) \
  X(USEPROGRAM, UseProgram) X(VERTEXATTRIBPOINTER, VertexAttribPointer) X(VIEWPORT, Viewport)
// clang-format on

struct GlApi {
#define CELLMIRROR_GL_MEMBER(TYPE, NAME) PFNGL##TYPE##PROC NAME = nullptr;
  CELLMIRROR_GL_FUNCTIONS(CELLMIRROR_GL_MEMBER)
#undef CELLMIRROR_GL_MEMBER
};
// NOLINTEND

// Fails where a function is missing; names it.
[[nodiscard]] Result<GlApi> load_gl(const GlContext& context);

}  // namespace cellmirror::display
