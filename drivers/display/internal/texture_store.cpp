#include "drivers/display/internal/texture_store.hpp"

#include <array>
#include <utility>
#include <vector>

namespace cellmirror::display {

namespace {

constexpr GLenum kUnit = GL_TEXTURE2;  // 0 and 1 are the floor's

bool whole(const Image& picture) {
  return picture.width > 0 && picture.height > 0 && picture.width <= kLargestImageEdge &&
         picture.height <= kLargestImageEdge &&
         picture.rgba.size() ==
             std::size_t{4} * static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height);
}

bool opaque(const std::vector<std::uint8_t>& rgba) {
  for (std::size_t i = 3; i < rgba.size(); i += 4) {
    if (rgba[i] != 255) return false;
  }
  return true;
}

// So that the colour of invisible pixels does not bleed into their neighbours in smaller levels.
std::vector<std::uint8_t> premultiplied(std::vector<std::uint8_t> rgba) {
  for (std::size_t i = 0; i < rgba.size(); i += 4) {
    for (std::size_t c = i; c < i + 3; ++c) rgba[c] = static_cast<std::uint8_t>((rgba[c] * rgba[i + 3] + 127) / 255);
  }
  return rgba;
}

}  // namespace

Texture::Texture(const GlApi& gl, std::shared_ptr<const Image> picture) : gl_(gl), picture_(std::move(picture)) {
  static constexpr std::array<std::uint8_t, 4> kWhite{255, 255, 255, 255};
  gl_.GenTextures(1, &name_);
  gl_.ActiveTexture(kUnit);
  gl_.BindTexture(GL_TEXTURE_2D, name_);
  const auto upload = [&](int width, int height, const std::uint8_t* rgba) {
    gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, rgba);
  };
  if (picture_ == nullptr)
    upload(1, 1, kWhite.data());
  else if (opaque(picture_->rgba))
    upload(picture_->width, picture_->height, picture_->rgba.data());
  else
    upload(picture_->width, picture_->height, premultiplied(picture_->rgba).data());
  gl_.GenerateMipmap(GL_TEXTURE_2D);
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  for (const GLenum axis : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T}) gl_.TexParameteri(GL_TEXTURE_2D, axis, GL_REPEAT);
}

std::shared_ptr<const Texture> TextureStore::texture(const std::shared_ptr<const Image>& picture) {
  if (picture == nullptr || !whole(*picture)) {
    if (white_ == nullptr) white_ = std::make_shared<const Texture>(gl_, nullptr);
    return white_;
  }
  std::erase_if(textures_, [](const auto& item) { return item.second.expired(); });
  std::weak_ptr<const Texture>& known = textures_[picture.get()];
  if (auto texture = known.lock()) return texture;
  auto made = std::make_shared<const Texture>(gl_, picture);
  known = made;
  ++uploads_;
  return made;
}

std::size_t TextureStore::size() const {
  std::size_t count = 0;
  for (const auto& [picture, texture] : textures_) count += texture.expired() ? 0 : 1;
  return count;
}

std::size_t TextureStore::bytes() const {
  std::size_t total = 0;
  for (const auto& [picture, texture] : textures_) {
    if (const auto known = texture.lock()) total += known->pixels() * 16 / 3;  // the smaller levels are a third more
  }
  return total;
}

}  // namespace cellmirror::display
