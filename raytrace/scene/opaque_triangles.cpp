// Finds triangles without a hole by the least alpha in tiles of the texture, over the box of their
// coordinates and a margin for filtering. O(texels) for a texture; a bounded number of tiles for a
// triangle.
//
// Degenerate: boxes that span too many texels take the least of the whole texture; coordinates far
// from 0 or not finite count as too many.
#include "raytrace/scene/opaque_triangles.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "parallel/parallel_for.h"

namespace delray::raytrace {
namespace {

using Alpha = scenes::Material::Alpha;
using Wrap = scenes::Texture::Wrap;

constexpr int kTileSide = 8;

// Texels that a triangle may span in each direction: some hundred tiles to look at.
constexpr int kMostTexels = 128;

// Coordinates beyond this are rounded to parts of a texel that count.
constexpr float kMostTurns = 64.0F;

using Tiles = std::array<int, kMostTexels + 1>;

int folded(int i, int size, Wrap wrap) {
  switch (wrap) {
    case Wrap::repeat:
      return (i % size + size) % size;
    case Wrap::mirror: {
      const int j = (i % (2 * size) + 2 * size) % (2 * size);
      return j < size ? j : 2 * size - 1 - j;
    }
    case Wrap::clamp:
      break;
  }
  return std::clamp(i, 0, size - 1);
}

// The rows or columns of tiles in a range of coordinates; none if it is too wide.
std::span<const int> find_tiles(float low, float high, int size, Wrap wrap, Tiles& tiles) {
  if (!(std::abs(low) <= kMostTurns && std::abs(high) <= kMostTurns)) return {};
  const auto texels = static_cast<float>(size);
  // A texel more on either side than filtering touches.
  const int first = static_cast<int>(std::floor(low * texels)) - 2;
  const int last = static_cast<int>(std::floor(high * texels)) + 2;
  if (last - first > kMostTexels) return {};
  std::size_t count = 0;
  for (int i = first; i <= last; ++i) {
    const int tile = folded(i, size, wrap) / kTileSide;
    if (count == 0 || tiles[count - 1] != tile) tiles[count++] = tile;
  }
  return {tiles.data(), count};
}

bool is_opaque(const scenes::Material& material, int least) {
  const float alpha = material.base_colour.w * (static_cast<float>(least) / 255.0F);
  // Interpolation rounds off less.
  constexpr float kMargin = 1.0F - 1e-5F;
  return material.alpha == Alpha::mask ? alpha * kMargin >= material.alpha_cutoff : alpha >= 1.0F;
}

}  // namespace

LeastAlpha::LeastAlpha(const shading::Texture& texture)
    : columns_((texture.levels[0].width + kTileSide - 1) / kTileSide),
      width_(texture.levels[0].width),
      height_(texture.levels[0].height),
      set_(texture.set),
      wrap_u_(texture.wrap_u),
      wrap_v_(texture.wrap_v) {
  const int rows = (height_ + kTileSide - 1) / kTileSide;
  least_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows), 255);
  const image::Rgba8* texel = texture.texels.data() + texture.levels[0].first;
  for (int y = 0; y < height_; ++y) {
    std::uint8_t* row = least_.data() + static_cast<std::size_t>(y / kTileSide) *
                                            static_cast<std::size_t>(columns_);
    for (int x = 0; x < width_; ++x, ++texel) {
      row[x / kTileSide] = std::min(row[x / kTileSide], texel->a);
    }
  }
  everywhere_ = *std::min_element(least_.begin(), least_.end());
}

int LeastAlpha::over(const glm::vec2& low, const glm::vec2& high) const {
  if (least_.empty()) return 0;
  Tiles rows, columns;
  const std::span<const int> at_x = find_tiles(low.x, high.x, width_, wrap_u_, columns);
  const std::span<const int> at_y = find_tiles(low.y, high.y, height_, wrap_v_, rows);
  if (at_x.empty() || at_y.empty()) return everywhere_;
  std::uint8_t least = 255;
  for (const int y : at_y) {
    for (const int x : at_x) {
      least = std::min(least, least_[static_cast<std::size_t>(y) * columns_ + x]);
    }
  }
  return least;
}

std::vector<LeastAlpha> least_alphas(const shading::Shader& shader) {
  std::vector<LeastAlpha> result(shader.textures.size());
  std::vector<char> used(result.size(), 0);
  for (const scenes::Material& material : shader.materials) {
    if (material.alpha == Alpha::opaque || material.base_colour_texture == scenes::kNone) continue;
    used[material.base_colour_texture] = 1;
  }
  parallel::parallel_for(0, result.size(), 1, [&](std::size_t i) {
    if (used[i] != 0) result[i] = LeastAlpha(shader.textures[i]);
  });
  return result;
}

std::vector<std::uint64_t> opaque_triangles(const scenes::Mesh& mesh,
                                            const scenes::Material& material,
                                            std::span<const LeastAlpha> alphas) {
  const std::uint32_t texture = material.base_colour_texture;
  if (material.alpha == Alpha::opaque || material.transmission > 0.0F || !mesh.colours.empty() ||
      !is_opaque(material, 255)) {
    return {};
  }
  const std::vector<glm::vec2>& uvs =
      mesh.uvs_of(texture == scenes::kNone ? 0 : alphas[texture].set());
  if (texture != scenes::kNone && uvs.empty()) return {};
  std::vector<std::uint64_t> opaque((mesh.triangles.size() + 63) / 64, 0);
  std::uint64_t any = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    int least = 255;
    if (texture != scenes::kNone) {
      const glm::uvec3& t = mesh.triangles[i];
      const glm::vec2 &a = uvs[t.x], &b = uvs[t.y], &c = uvs[t.z];
      least = alphas[texture].over(glm::min(glm::min(a, b), c), glm::max(glm::max(a, b), c));
    }
    const std::uint64_t bit = is_opaque(material, least) ? 1 : 0;
    opaque[i / 64] |= bit << (i % 64);
    any |= bit;
  }
  if (any == 0) opaque.clear();
  return opaque;
}

}  // namespace delray::raytrace
