#include "drivers/display/internal/render_target.hpp"

namespace cellmirror::display {

namespace {

GLenum format_of(Pixels pixels) {
  if (pixels == Pixels::objects) return GL_R32UI;
  return pixels == Pixels::coverage ? GL_RG8 : GL_RGBA8;
}

}  // namespace

GLuint RenderTarget::renderbuffer(GLenum format, int samples) {
  GLuint buffer = 0;
  gl_.GenRenderbuffers(1, &buffer);
  gl_.BindRenderbuffer(GL_RENDERBUFFER, buffer);
  if (samples > 0)
    gl_.RenderbufferStorageMultisample(GL_RENDERBUFFER, samples, format, width_, height_);
  else
    gl_.RenderbufferStorage(GL_RENDERBUFFER, format, width_, height_);
  renderbuffers_.push_back(buffer);
  return buffer;
}

bool RenderTarget::make() {
  const int samples = pixels_ == Pixels::smooth_colours ? kSamples : 0;
  gl_.GenFramebuffers(1, &frame_);
  gl_.BindFramebuffer(GL_FRAMEBUFFER, frame_);
  gl_.FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER,
                              renderbuffer(format_of(pixels_), samples));
  if (pixels_ != Pixels::coverage) {
    gl_.FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER,
                                renderbuffer(GL_DEPTH_COMPONENT24, samples));
  }
  bool complete = gl_.CheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
  if (complete && samples > 0) {
    gl_.GenFramebuffers(1, &resolved_);
    gl_.BindFramebuffer(GL_FRAMEBUFFER, resolved_);
    gl_.FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, renderbuffer(GL_RGBA8, 0));
    complete = gl_.CheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
  }
  return complete && gl_.GetError() == GL_NO_ERROR;
}

Result<void> RenderTarget::begin(Pixels pixels, int width, int height) {
  if (!fits(pixels, width, height)) {
    free();
    pixels_ = pixels;
    width_ = width;
    height_ = height;
    if (!make()) {
      free();
      return fail("no memory for a picture of " + std::to_string(width) + "x" + std::to_string(height) + " pixels",
                  "request a smaller one");
    }
  }
  gl_.BindFramebuffer(GL_FRAMEBUFFER, frame_);
  gl_.Enable(GL_SCISSOR_TEST);
  gl_.Viewport(0, 0, width, height);
  gl_.Scissor(0, 0, width, height);
  return {};
}

void RenderTarget::read_colours(std::uint8_t* rgba) {
  GLuint from = frame_;
  gl_.Disable(GL_SCISSOR_TEST);  // it holds for blits, too
  if (resolved_ != 0) {
    gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, frame_);
    gl_.BindFramebuffer(GL_DRAW_FRAMEBUFFER, resolved_);
    gl_.BlitFramebuffer(0, 0, width_, height_, 0, 0, width_, height_, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    from = resolved_;
  }
  gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, from);
  gl_.ReadPixels(0, 0, width_, height_, GL_RGBA, GL_UNSIGNED_BYTE, rgba);
}

void RenderTarget::read_objects(std::uint32_t* objects) {
  gl_.ReadPixels(0, 0, width_, height_, GL_RED_INTEGER, GL_UNSIGNED_INT, objects);
}

void RenderTarget::read_coverage(std::uint8_t* two_a_pixel) {
  gl_.ReadPixels(0, 0, width_, height_, GL_RG, GL_UNSIGNED_BYTE, two_a_pixel);
}

Result<void> RenderTarget::read_depth(int x, int y, int width, int height, float* depth) {
  gl_.Disable(GL_SCISSOR_TEST);
  if (pixels_ == Pixels::smooth_colours) {
    if (resolved_depth_ == 0) {
      gl_.GenFramebuffers(1, &resolved_depth_);
      gl_.BindFramebuffer(GL_FRAMEBUFFER, resolved_depth_);
      gl_.FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER,
                                  renderbuffer(GL_DEPTH_COMPONENT24, 0));
      const GLenum none = GL_NONE;
      gl_.DrawBuffers(1, &none);
      gl_.ReadBuffer(GL_NONE);
    }
    gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, frame_);
    gl_.BindFramebuffer(GL_DRAW_FRAMEBUFFER, resolved_depth_);
    gl_.BlitFramebuffer(x, y, x + width, y + height, x, y, x + width, y + height, GL_DEPTH_BUFFER_BIT, GL_NEAREST);
    gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, resolved_depth_);
  }
  gl_.ReadPixels(x, y, width, height, GL_DEPTH_COMPONENT, GL_FLOAT, depth);
  gl_.BindFramebuffer(GL_FRAMEBUFFER, frame_);
  gl_.Enable(GL_SCISSOR_TEST);
  if (gl_.GetError() == GL_NO_ERROR) return {};
  return fail("the graphics system has no depth of a picture", "request a smaller one");
}

void RenderTarget::free() {
  if (frame_ != 0) gl_.DeleteFramebuffers(1, &frame_);
  if (resolved_ != 0) gl_.DeleteFramebuffers(1, &resolved_);
  if (resolved_depth_ != 0) gl_.DeleteFramebuffers(1, &resolved_depth_);
  for (const GLuint buffer : renderbuffers_) gl_.DeleteRenderbuffers(1, &buffer);
  renderbuffers_.clear();
  frame_ = 0;
  resolved_ = 0;
  resolved_depth_ = 0;
}

}  // namespace cellmirror::display
