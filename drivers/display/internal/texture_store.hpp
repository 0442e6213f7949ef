// Textures in the memory of the graphics system: each is uploaded once, when it is first visible, and kept while an
// uploaded mesh uses it. Private to this folder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>

#include "drivers/display/internal/gl_api.hpp"
#include "rt_core/ports/image.hpp"

namespace cellmirror::display {

class Texture {
 public:
  // With all mip levels, repeated beyond its edges; its colours are multiplied by its alpha.
  Texture(const GlApi& gl, std::shared_ptr<const Image> picture);
  ~Texture() { gl_.DeleteTextures(1, &name_); }
  Texture(const Texture&) = delete;
  Texture& operator=(const Texture&) = delete;
  [[nodiscard]] GLuint name() const { return name_; }
  [[nodiscard]] std::size_t pixels() const { return picture_ == nullptr ? 1 : picture_->rgba.size() / 4; }

 private:
  const GlApi& gl_;
  std::shared_ptr<const Image> picture_;  // kept, so that no other one gets its address
  GLuint name_ = 0;
};

class TextureStore {
 public:
  explicit TextureStore(const GlApi& gl) : gl_(gl) {}

  // Null, or one that is not whole: a single white pixel.
  [[nodiscard]] std::shared_ptr<const Texture> texture(const std::shared_ptr<const Image>& picture);
  [[nodiscard]] std::size_t size() const;
  [[nodiscard]] std::size_t bytes() const;
  [[nodiscard]] std::uint64_t uploads() const { return uploads_; }

 private:
  const GlApi& gl_;
  std::shared_ptr<const Texture> white_;
  std::map<const Image*, std::weak_ptr<const Texture>> textures_;
  std::uint64_t uploads_ = 0;
};

}  // namespace cellmirror::display
