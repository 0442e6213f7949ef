// A node of a wide tree (wide_tree.hpp). Plain numbers: sources for several instruction sets include it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace cellmirror::geometry {

struct alignas(32) WideNode {
  static constexpr std::size_t kWidth = 8;
  using Lanes = std::array<float, kWidth>;

  std::array<Lanes, 3> centre{};               // m, from WideTree::origin()
  std::array<Lanes, 3> half{};                 // m, along the axes
  std::array<std::array<Lanes, 3>, 3> axes{};  // of the box; unit vectors at right angles
  std::array<std::uint32_t, kWidth> child{};
};

}  // namespace cellmirror::geometry
