// Places splats on the screen and meets them with rays through pixel centres.
//
// A ray d from the eye passes a centre c at the distance |c x d| / |d|, nearest at t = c.d / d.d: a
// disc that faces the ray is met there, a sphere by half a chord earlier. Segments with round ends
// are met as their cylinder or one of its ends, from a point of the ray near the segment, so that
// numbers stay small. Every operation is that of IEEE 754, in this order, whoever asks. O(pixels of
// the boxes).
//
// Degenerate: what begins before the near plane shows its inside; a radius of 0 is met by no ray, a
// spot of it still covers its own pixel; a segment whose ends coincide is a sphere.
#include "raster/pipeline/splat.h"

#include <algorithm>
#include <cmath>

namespace delray::raster {
namespace {

using ShapeKind = scenes::Shape::Kind;

bool is_finite_at(const glm::vec3& v) {
  constexpr float kLargest = std::numeric_limits<float>::max();
  return std::abs(v.x) <= kLargest && std::abs(v.y) <= kLargest && std::abs(v.z) <= kLargest;
}

// As transform.cpp has it.
bool project(const Screen& screen, const glm::vec3& v, ScreenVertex& vertex) {
  const scenes::View& view = screen.view;
  constexpr auto kGuard = static_cast<float>(kGuardSubpixels);
  const float w = view.orthographic ? 1.0F : v.z;
  const float right = v.x / w * view.scale * kSubpixels, up = v.y / w * view.scale * kSubpixels;
  const float x = screen.offset_x + right, y = screen.offset_y - up;
  if (!(v.z >= view.near && v.z < std::numeric_limits<float>::max() && std::abs(x) <= kGuard &&
        std::abs(y) <= kGuard))
    return false;
  vertex = {static_cast<std::int32_t>(std::nearbyint(x)),
            static_cast<std::int32_t>(std::nearbyint(y)), depth_at_distance(view, v.z)};
  return true;
}

Splat make_spot(const Screen& screen, const SplatDraw& draw, const scenes::Mesh& mesh,
                std::uint32_t t, std::uint32_t number) {
  Splat splat;
  splat.number = number;
  const glm::vec3 v = draw.to_view(mesh.positions[mesh.triangles[t].x]);
  if (!project(screen, v, splat.centre)) return splat;
  float radius = draw.radius;
  if (!draw.in_samples) radius *= screen.view.scale / (screen.view.orthographic ? 1.0F : v.z);
  splat.subpixels =
      static_cast<std::int32_t>(std::nearbyint(std::min(radius, kLargestSplat) * kSubpixels));
  const auto [x, y, depth] = splat.centre;
  const int r = splat.subpixels, i = x >> kSubpixelBits, j = y >> kSubpixelBits;
  splat.nearest = depth;
  splat.pixels = geometry::intersection({std::min(first_centre(x - r), i) + screen.centre_x,
                                         std::min(first_centre(y - r), j) + screen.centre_y,
                                         std::max(last_centre(x + r), i) + screen.centre_x + 1,
                                         std::max(last_centre(y + r), j) + screen.centre_y + 1},
                                        screen.frame());
  return splat;
}

// The pixels whose centres lie in the projection of a box of view coordinates, and some more.
geometry::Rect pixels_of(const Screen& screen, const glm::vec3& low, const glm::vec3& high) {
  const scenes::View& view = screen.view;
  if (!(high.z >= view.near)) return {};
  if (!(low.z >= view.near)) return screen.frame();
  const float nearest = view.orthographic ? 1 : low.z, farthest = view.orthographic ? 1 : high.z;
  const auto least = [&](float v) { return (v < 0 ? v / nearest : v / farthest) * view.scale; };
  const auto most = [&](float v) { return (v < 0 ? v / farthest : v / nearest) * view.scale; };
  // Rounding: positions are below 2^16, a step of which is 2^-8.
  constexpr float kMargin = 1.0F / 16;
  const auto first = [](float position, int size) {
    return static_cast<int>(
        std::ceil(std::clamp(position - kMargin - 0.5F, -1.0F, static_cast<float>(size))));
  };
  const auto end = [](float position, int size) {
    return static_cast<int>(
               std::floor(std::clamp(position + kMargin - 0.5F, -1.0F, static_cast<float>(size)))) +
           1;
  };
  return geometry::intersection({first(view.half_width + least(low.x), screen.width),
                                 first(view.half_height - most(high.y), screen.height),
                                 end(view.half_width + most(high.x), screen.width),
                                 end(view.half_height - least(low.y), screen.height)},
                                screen.frame());
}

struct PixelRay {
  glm::vec3 origin, direction;
};
PixelRay ray_of(const Screen& screen, int x, int y) {
  const scenes::View& view = screen.view;
  const float right = (static_cast<float>(x) + 0.5F - view.half_width) / view.scale;
  const float up = (view.half_height - (static_cast<float>(y) + 0.5F)) / view.scale;
  if (view.orthographic) return {{right, up, 0}, {0, 0, 1}};
  return {{0, 0, 0}, {right, up, 1}};
}

// The first of two distances along the view axis that is not before the near plane.
bool first_seen(const Screen& screen, float before, float after, float& t) {
  t = before >= screen.view.near ? before : after;
  return t >= screen.view.near && t < std::numeric_limits<float>::max();
}

bool meets_ball(const Screen& screen, const Splat& splat, const PixelRay& ray, SplatHit& hit) {
  const glm::vec3 c = splat.a - ray.origin;
  const glm::vec3 m = glm::cross(c, ray.direction);
  const float squared = glm::dot(ray.direction, ray.direction);
  const float left = splat.radius * splat.radius * squared - glm::dot(m, m);
  if (!(left > 0)) return false;
  const float middle = glm::dot(c, ray.direction) / squared;
  const bool flat = splat.kind == ShapeKind::disc;
  const float half = flat ? 0.0F : std::sqrt(left) / squared;
  float t;
  if (!first_seen(screen, middle - half, middle + half, t)) return false;
  hit.position = ray.origin + ray.direction * t;
  hit.normal = flat ? glm::vec3(0.0F) : hit.position - splat.a;
  return true;
}

bool meets_disc(const Screen& screen, const Splat& splat, const PixelRay& ray, SplatHit& hit) {
  const glm::vec3 c = splat.a - ray.origin;
  const float t = glm::dot(splat.normal, c) / glm::dot(splat.normal, ray.direction);
  const glm::vec3 apart = ray.direction * t - c;
  if (!(glm::dot(apart, apart) < splat.radius * splat.radius && t >= screen.view.near))
    return false;
  hit.position = ray.origin + ray.direction * t;
  hit.normal = splat.normal;
  return true;
}

// After Quilez ("Capsule - intersection"), for directions of any length.
bool meets_segment(const Screen& screen, const Splat& splat, const PixelRay& ray, SplatHit& hit) {
  const glm::vec3& d = ray.direction;
  const float dd = glm::dot(d, d), rr = splat.radius * splat.radius;
  const float begin = glm::dot((splat.a + splat.b) * 0.5F - ray.origin, d) / dd;
  const glm::vec3 start = ray.origin + d * begin;
  const glm::vec3 axis = splat.b - splat.a, from = start - splat.a;
  const float axis_axis = glm::dot(axis, axis), axis_d = glm::dot(axis, d);
  const float axis_from = glm::dot(axis, from), d_from = glm::dot(d, from);
  const float a = axis_axis * dd - axis_d * axis_d;
  const float b = axis_axis * d_from - axis_from * axis_d;
  const float c = axis_axis * glm::dot(from, from) - axis_from * axis_from - rr * axis_axis;
  float nearest = 0, farthest = 0;
  bool any = false;
  const auto take = [&](float t) {
    nearest = any ? std::min(nearest, t) : t;
    farthest = any ? std::max(farthest, t) : t;
    any = true;
  };
  const float h = b * b - a * c;
  if (a > 0 && h > 0) {
    const float root = std::sqrt(h);
    for (const float t : {(-b - root) / a, (-b + root) / a}) {
      const float along = axis_from + t * axis_d;
      if (along > 0 && along < axis_axis) take(t);
    }
  }
  for (const glm::vec3& end : {splat.a, splat.b}) {
    const glm::vec3 o = start - end;
    const float e = glm::dot(d, o), left = e * e - dd * (glm::dot(o, o) - rr);
    if (!(left > 0)) continue;
    const float root = std::sqrt(left);
    take((-e - root) / dd);
    take((-e + root) / dd);
  }
  float t;
  if (!any || !first_seen(screen, begin + nearest, begin + farthest, t)) return false;
  hit.position = ray.origin + d * t;
  const glm::vec3 offset = hit.position - splat.a;
  hit.along = axis_axis > 0 ? std::clamp(glm::dot(axis, offset) / axis_axis, 0.0F, 1.0F) : 0.0F;
  hit.normal = offset - axis * hit.along;
  return true;
}

// A stripe on the screen: what is linear there is one over the distance.
bool meets_stripe(const Screen& screen, const Splat& splat, int x, int y, SplatHit& hit) {
  // From the view's axis, exactly, so that a window of the frame has the frame's bytes.
  const glm::vec2 pixel(static_cast<float>(x) + 0.5F - screen.view.half_width,
                        static_cast<float>(y) + 0.5F - screen.view.half_height);
  const glm::vec2 way = splat.screen_b - splat.screen_a, from = pixel - splat.screen_a;
  const float length = glm::dot(way, way);
  const float share = length > 0 ? std::clamp(glm::dot(from, way) / length, 0.0F, 1.0F) : 0.0F;
  const glm::vec2 apart = from - way * share;
  if (!(glm::dot(apart, apart) < splat.radius * splat.radius)) return false;
  const float of_a = (1 - share) / splat.a.z, of_b = share / splat.b.z;
  const PixelRay ray = ray_of(screen, x, y);
  hit.position = ray.direction * (1 / (of_a + of_b));
  hit.normal = glm::vec3(0.0F);
  hit.along = of_b / (of_a + of_b);
  return true;
}

// The segment in perspective as a stripe, cut at the near plane.
void put_on_screen(const Screen& screen, float radius, Splat& splat) {
  const scenes::View& view = screen.view;
  splat.on_screen = true;
  splat.radius = radius;
  splat.pixels = {};
  glm::vec3 &a = splat.a, &b = splat.b;
  const float near = view.near;
  if (!(a.z >= near || b.z >= near)) return;
  const auto cut = [near](const glm::vec3& in, const glm::vec3& out) {
    glm::vec3 p = in + (out - in) * ((in.z - near) / (in.z - out.z));
    p.z = near;
    return p;
  };
  if (a.z < near) a = cut(b, a);
  if (b.z < near) b = cut(a, b);
  const auto place = [&](const glm::vec3& p) {
    constexpr float kFarthest = 1e6F;  // pixels
    return glm::clamp(glm::vec2(p.x / p.z * view.scale, -p.y / p.z * view.scale), -kFarthest,
                      kFarthest);
  };
  splat.screen_a = place(a);
  splat.screen_b = place(b);
  const glm::vec2 middle(view.half_width, view.half_height);
  const glm::vec2 low = glm::min(splat.screen_a, splat.screen_b) + middle - (radius + 1);
  const glm::vec2 high = glm::max(splat.screen_a, splat.screen_b) + middle + (radius + 1);
  splat.pixels =
      geometry::intersection({static_cast<int>(low.x), static_cast<int>(low.y),
                              static_cast<int>(high.x) + 1, static_cast<int>(high.y) + 1},
                             screen.frame());
  constexpr float kSlack = 1 - 1e-5F;
  splat.nearest =
      std::max(depth_at_distance(view, std::max(std::min(a.z, b.z) * kSlack, near)), -1.0F);
}

// The blocks of a tile that pixels [i0, i1) x [j0, j1) of it touch, a bit each.
std::uint32_t blocks_of(int i0, int j0, int i1, int j1) {
  std::uint32_t blocks = 0;
  for (int y = j0 / VisibilityTile::kBlockHeight; y <= (j1 - 1) / VisibilityTile::kBlockHeight; ++y)
    for (int x = i0 / VisibilityTile::kBlockWidth; x <= (i1 - 1) / VisibilityTile::kBlockWidth; ++x)
      blocks |= 1U << (y * VisibilityTile::kBlocksX + x);
  return blocks;
}

}  // namespace

SplatDraw make_splat_draw(const Screen& screen, const Draw& draw) {
  scenes::Shape shape = draw.mesh->shape;
  shape.radius += draw.widening;
  SplatDraw result;
  result.kind = shape.kind;
  if (!result.any()) return result;
  const scenes::View& view = screen.view;
  const glm::mat4x3& m = *draw.transform;
  result.to_view = to_view(view, m);
  result.in_samples = shape.in_pixels;
  if (shape.in_pixels) {
    result.radius = std::min(shape.radius * screen.samples, kLargestSplat);
  } else {
    const float longest =
        std::max({glm::dot(m[0], m[0]), glm::dot(m[1], m[1]), glm::dot(m[2], m[2])});
    // Squares of it are finite.
    constexpr float kLargestRadius = 1e18F;
    result.radius = std::min(shape.radius * std::sqrt(longest), kLargestRadius);
  }
  if (result.in_samples && view.orthographic && !result.is_spot()) {
    result.in_samples = false;
    result.radius /= view.scale;
  }
  if (draw.mesh->normals.empty()) return result;
  const glm::dmat3 linear{glm::mat3(m)};
  const glm::dmat3 cofactors(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                             glm::cross(linear[0], linear[1]));
  const double side = glm::dot(linear[0], cofactors[0]) < 0 ? -1 : 1;
  const glm::dmat3 axes = glm::transpose(
      glm::dmat3(glm::dvec3(view.right), glm::dvec3(view.up), glm::dvec3(view.forward)));
  result.normal_to_view = glm::mat3(axes * cofactors * side);
  return result;
}

Splat make_splat(const Screen& screen, const SplatDraw& draw, const scenes::Mesh& mesh,
                 std::uint32_t t, std::uint32_t number) {
  if (draw.is_spot()) return make_spot(screen, draw, mesh, t, number);
  const glm::uvec3& corners = mesh.triangles[t];
  Splat splat;
  splat.kind = draw.kind;
  splat.number = number;
  splat.a = draw.to_view(mesh.positions[corners.x]);
  splat.b = draw.to_view(mesh.positions[corners.y]);
  if (!is_finite_at(splat.a) || !is_finite_at(splat.b)) return splat;
  if (draw.kind == ShapeKind::disc && !mesh.normals.empty()) {
    const glm::vec3 normal = draw.normal_to_view * mesh.normals[corners.x];
    const float squared = glm::dot(normal, normal);
    if (squared > 0) splat.normal = normal * (1.0F / std::sqrt(squared));
  }
  if (draw.kind == ShapeKind::line && draw.in_samples) {
    put_on_screen(screen, draw.radius, splat);
    return splat;
  }
  splat.radius = draw.radius;
  if (draw.in_samples) {
    splat.radius *= std::max((splat.a.z + splat.b.z) * 0.5F, screen.view.near) / screen.view.scale;
  }
  const glm::vec3 low = glm::min(splat.a, splat.b) - splat.radius;
  splat.pixels = pixels_of(screen, low, glm::max(splat.a, splat.b) + splat.radius);
  constexpr float kSlack = 1 - 1e-5F;
  if (low.z * kSlack > screen.view.near)
    splat.nearest = depth_at_distance(screen.view, low.z * kSlack);
  return splat;
}

bool meets(const Screen& screen, const Splat& splat, int x, int y, SplatHit& hit) {
  if (splat.on_screen) return meets_stripe(screen, splat, x, y, hit);
  const PixelRay ray = ray_of(screen, x, y);
  if (splat.kind == ShapeKind::line) return meets_segment(screen, splat, ray, hit);
  const bool turned = splat.kind == ShapeKind::disc && splat.normal != glm::vec3(0.0F);
  return turned ? meets_disc(screen, splat, ray, hit) : meets_ball(screen, splat, ray, hit);
}

void rasterize_splats(const Screen& screen, const geometry::Rect& rect,
                      std::span<const Splat> splats, std::span<const std::uint32_t> entries,
                      VisibilityTile& tile) {
  const int tile_x = rect.x0 / kTileSize * kTileSize, tile_y = rect.y0 / kTileSize * kTileSize;
  for (const std::uint32_t entry : entries) {
    const Splat& splat = splats[entry];
    const geometry::Rect pixels = geometry::intersection(splat.pixels, rect);
    if (pixels.empty()) continue;
    const std::uint32_t touched =
        blocks_of(pixels.x0 - tile_x, pixels.y0 - tile_y, pixels.x1 - tile_x, pixels.y1 - tile_y);
    const std::int32_t nearest = code_of_depth(splat.nearest);
    bool hidden = true;
    for (std::uint32_t rest = touched; rest != 0; rest &= rest - 1)
      hidden &= nearest > tile.farthest[std::countr_zero(rest)];
    if (hidden) continue;
    for_each_covered(screen, rect, splat, [&](int i, int j, std::int64_t key) {
      std::int64_t& old = tile.key[j * kTileSize + i];
      old = std::min(old, key);
    });
    tile.came_nearer(touched);
    for (std::uint32_t rest = touched; rest != 0; rest &= rest - 1) {
      const int block = std::countr_zero(rest);
      tile.set_farthest(block, tile.farthest_now(block));
    }
    tile.stale &= ~touched;
  }
}

std::uint64_t draw_and_shade(const Screen& screen, const geometry::Rect& rect,
                             std::span<const Splat> splats, std::span<const std::uint32_t> entries,
                             parallel::FunctionRef<void(std::uint32_t, int, int)> shade,
                             VisibilityTile& tile) {
  const int tile_x = rect.x0 / kTileSize * kTileSize, tile_y = rect.y0 / kTileSize * kTileSize;
  std::uint64_t shaded = 0;
  for (const std::uint32_t entry : entries) {
    for_each_covered(screen, rect, splats[entry], [&](int i, int j, std::int64_t key) {
      std::int64_t& old = tile.key[j * kTileSize + i];
      if (key >= old) return;
      old = key;
      ++shaded;
      shade(splats[entry].number, tile_x + i, tile_y + j);
    });
  }
  return shaded;
}

}  // namespace delray::raster
