// Rasterizes the squares of a picture, each when its rays are due, from triangles that were sorted
// beforehand; decides whether that pays.
//
// Times. Tracing is timed with some packets of the frame itself, and drawing is counted: triangles,
// set-ups and blocks, each for the nanoseconds that it takes next to a packet (kDraw...). Where
// there are many triangles a part of them is looked at first, so that a scene that does not pay
// costs next to nothing.
#include "raytrace/first_hits/first_hits.h"

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <cmath>
#include <limits>
#include <numeric>

#include "parallel/arena.h"
#include "parallel/parallel_for.h"
#include "raytrace/first_hits/draw_triangles.h"
#include "raytrace/scene/flush_to_zero.h"
#include "scenes/camera.h"

namespace delray::raytrace {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::uint32_t kTrianglesPerPart = 256;

// Seconds of a core: to look at a triangle, to sort it into a square, to set it up there, to test a
// block. Measured on a core with vectors of sixteen floats.
constexpr double kLookSeconds = 12e-9, kSortSeconds = 16e-9;
constexpr double kSetUpSeconds = 15e-9, kTestSeconds = 10e-9;
// And for each packet, whatever is drawn.
constexpr double kPacketSeconds = 20e-9;
// A square is traced if drawing it would take so many times as long as tracing the packets of an
// average one: where there is much to draw tracing takes longer, too.
constexpr double kDense = 3.0;
// What rasterizing some of the triangles may be expected to take, of tracing: packets that are
// traced all the same come on top.
constexpr double kGain = 0.85;

// Triangles first .. last - 1 of an instance.
struct MeshPart {
  std::uint32_t instance, first, last;
};

std::vector<MeshPart> mesh_parts(std::span<const GeometryInstance> instances) {
  std::vector<MeshPart> parts;
  for (std::uint32_t i = 0; i < instances.size(); ++i) {
    if (instances[i].mesh == nullptr) continue;
    const auto triangles = static_cast<std::uint32_t>(instances[i].mesh->triangles.size());
    for (std::uint32_t first = 0; first < triangles; first += kTrianglesPerPart)
      parts.push_back({i, first, std::min(triangles, first + kTrianglesPerPart)});
  }
  return parts;
}

// A packet of rays to triangles all over the scene, every second one to the middle of an edge,
// where rounding decides what passes.
RayGroup rays_to_triangles(std::span<const GeometryInstance> instances,
                           std::span<const MeshPart> parts, const scenes::View& view,
                           std::uint32_t number) {
  RayGroup group;
  RayPacket& packet = group.packet;
  for (int i = 0; i < kPacketRays; ++i) {
    // Steps by the golden ratio reach all parts, and within them all triangles, evenly.
    const std::uint32_t k = number * kPacketRays + static_cast<std::uint32_t>(i);
    const auto share = [&](double times, std::uint32_t of) {
      const double x = (k + 0.5) * times;
      return std::min(of - 1, static_cast<std::uint32_t>((x - std::floor(x)) * of));
    };
    const MeshPart& part =
        parts[share(0.61803398874989485, static_cast<std::uint32_t>(parts.size()))];
    const GeometryInstance& instance = instances[part.instance];
    const glm::uvec3 corners =
        instance.mesh->triangles[part.first + share(0.75487766624669276, part.last - part.first)];
    const glm::vec3 weights = i % 2 == 0 ? glm::vec3(1.0F / 3) : glm::vec3(0.5F, 0.5F, 0.0F);
    glm::vec3 to(0.0F);
    for (int c = 0; c < 3; ++c) to += instance.positions[corners[c]] * weights[c];
    if (instance.instanced) to = instance.to_world * glm::vec4(to, 1.0F);
    const glm::vec3 direction = to - view.eye;
    group.active.ray[i] = -1;
    packet.origin_x[i] = view.eye.x, packet.origin_y[i] = view.eye.y;
    packet.origin_z[i] = view.eye.z;
    packet.direction_x[i] = direction.x, packet.direction_y[i] = direction.y;
    packet.direction_z[i] = direction.z;
    packet.near[i] = packet.time[i] = 0.0F;
    packet.far[i] = std::numeric_limits<float>::infinity();
    packet.mask[i] = 0xFFFFFFFFU;
    packet.id[i] = packet.flags[i] = 0;
    packet.triangle[i] = packet.geometry[i] = packet.instance[i] = kMiss;
  }
  return group;
}

// Whether what is drawn here is what Embree finds: its version, its instruction set and its
// matrices of instances. Expressions that differ in a rounding give other bits for a large part of
// all rays. None where too few rays hit anything to tell.
std::optional<bool> finds_same_hits(const Tracer& tracer, const RaySpaces& spaces,
                                    std::span<const MeshPart> parts, const scenes::View& view) {
  constexpr std::uint32_t kMostPackets = 32;
  constexpr int kLeastHits = 16, kEnoughHits = 128;
  int hits = 0;
  DrawnSquare square;
  for (std::uint32_t n = 0; n < kMostPackets && hits < kEnoughHits; ++n) {
    const RayGroup asked = rays_to_triangles(tracer.instances, parts, view, n);
    RayGroup traced = asked;
    tracer.embree.intersect(traced.active, traced.packet, n % 2 == 0);
    for (int i = 0; i < kPacketRays; ++i) {
      if (traced.packet.triangle[i] == kMiss) continue;
      const Hit found = hit_of(traced.packet, i);
      RayGroup drawn = asked;
      square.clear();
      square.add(0, drawn);
      const BinnedTriangle triangle{found.instance, found.triangle, 0.0F, 1};
      draw_triangles(spaces, {&triangle, 1}, square);
      if ((square.blocks[0].unsure >> i & 1) != 0) continue;  // nothing would be concluded from it
      if (drawn.packet.triangle[i] == kMiss) return false;
      const Hit hit = hit_of(drawn.packet, i);
      if (hit.distance != found.distance || hit.u != found.u || hit.v != found.v ||
          hit.instance != found.instance)
        return false;
      ++hits;
    }
  }
  return hits >= kLeastHits ? std::optional(true) : std::nullopt;
}

// Packets of the window that may hit anything.
double traced_packets(const Tracer& tracer, const SeenWindow& window) {
  const geometry::Rect filled =
      geometry::intersection(window.pixels, scenes::pixels_of(window.view, tracer.embree.bounds()));
  return static_cast<double>(filled.area()) / kPacketRays;
}

// What it takes to trace a packet of the window after its neighbour, which has brought to the
// caches what they have in common: the shorter time of two, as this thread may have to wait for
// others.
double traced_seconds(const Tracer& tracer, const SeenWindow& window) {
  constexpr int kColumns = 6, kRows = 4;
  const geometry::Rect at =
      geometry::intersection(window.pixels, scenes::pixels_of(window.view, tracer.embree.bounds()));
  if (at.empty()) return 0.0;
  constexpr int kPackets = kColumns * kRows;
  std::array<double, kPackets> seconds;
  seconds.fill(std::numeric_limits<double>::infinity());
  for (int k = 0; k < kPackets; ++k) {
    for (int turn = 0; turn < 3; ++turn) {
      const int left =
          at.x0 + (2 * (k % kColumns) + 1) * at.width() / (2 * kColumns) + turn * kBlockSide;
      const int top = at.y0 + (2 * (k / kColumns) + 1) * at.height() / (2 * kRows);
      RayGroup group;
      RayPacket& packet = group.packet;
      for (int i = 0; i < kPacketRays; ++i) {
        const glm::vec3 direction =
            window.view.ray(static_cast<float>(left + i % kBlockSide) + 0.5F,
                            static_cast<float>(top + i / kBlockSide) + 0.5F);
        group.active.ray[i] = -1;
        packet.origin_x[i] = window.view.eye.x, packet.origin_y[i] = window.view.eye.y;
        packet.origin_z[i] = window.view.eye.z;
        packet.direction_x[i] = direction.x, packet.direction_y[i] = direction.y;
        packet.direction_z[i] = direction.z;
        packet.near[i] = window.view.near;
        packet.time[i] = 0.0F;
        packet.far[i] = std::numeric_limits<float>::infinity();
        packet.mask[i] = 0xFFFFFFFFU;
        packet.id[i] = packet.flags[i] = 0;
        packet.triangle[i] = packet.geometry[i] = packet.instance[i] = kMiss;
      }
      const Clock::time_point start = Clock::now();
      tracer.embree.intersect(group.active, packet, true);
      const std::chrono::duration<double> taken = Clock::now() - start;
      if (turn == 0) continue;
      seconds[static_cast<std::size_t>(k)] =
          std::min(seconds[static_cast<std::size_t>(k)], taken.count());
    }
  }
  return std::reduce(seconds.begin(), seconds.end()) / kPackets;
}

// Seconds of a core that it takes to look at parts and to draw what is seen of them, as far as some
// of the triangles tell: neighbours are alike.
double drawn_seconds(std::span<const SeenTriangles> seen, std::span<const MeshPart> parts,
                     double passes) {
  double looked = 0, squares = 0, blocks = 0;
  for (const MeshPart& part : parts) looked += part.last - part.first;
  constexpr std::size_t kStep = 8;
  const auto along = [](int first, int last) {
    return 1 + (last - 1) / kBinBlocks - first / kBinBlocks;
  };
  for (const SeenTriangles& some : seen) {
    squares += static_cast<double>(some.in_squares.size());
    const std::size_t size = some.in_squares.size(), looked_at = (size + kStep - 1) / kStep;
    double sum = 0;
    for (std::size_t i = 0; i < size; i += kStep) sum += count(some.in_squares[i].blocks);
    if (size > 0) blocks += sum * static_cast<double>(size) / static_cast<double>(looked_at);
    for (const WideTriangle& t : some.wide) {
      squares += along(t.x0, t.x1) * along(t.y0, t.y1);
      blocks += (t.x1 - t.x0) * (t.y1 - t.y0);
    }
  }
  return kLookSeconds * looked + kSortSeconds * squares +
         passes * (kSetUpSeconds * squares + kTestSeconds * blocks);
}

std::vector<SeenTriangles> find_all(const Tracer& tracer, const SeenWindow& window,
                                    const RaySpaces& spaces, std::span<const MeshPart> parts) {
  std::vector<SeenTriangles> seen(parts.size());
  parallel::parallel_for(0, parts.size(), 1, [&](std::size_t i) {
    const MeshPart& part = parts[i];
    seen[i] = find_seen(tracer.instances[part.instance], part.instance, spaces.of(part.instance),
                        window, part.first, part.last);
  });
  return seen;
}

std::string why_unknown(const Tracer& tracer, const SeenWindow& window) {
  const scenes::View& view = window.view;
  constexpr int kMostBlocks = 65534;  // WideTriangle
  if (std::max(window.pixels.width(), window.pixels.height()) > kBlockSide * kMostBlocks)
    return "the picture is too large";
  if (view.orthographic) return "rays are parallel";
  if (view.lens_radius > 0.0F) return "rays start on a lens";
  if (tracer.embree.has_splats()) return "there are points or segments";
  if (!tracer.embree.is_robust()) return "intersections are not robust";
  return "";
}

}  // namespace

FirstHits::Made FirstHits::make(const Tracer& tracer, const SeenWindow& window, double passes,
                                bool always, Trials& trials) {
  constexpr const char* kAsFast = "tracing is expected to be as fast";
  const FlushToZero flush;
  if (!always && trials.rest > 0) {
    --trials.rest;
    return {nullptr, kAsFast};
  }
  if (std::string why = why_unknown(tracer, window); !why.empty()) return {nullptr, why};
  const std::vector<MeshPart> parts = mesh_parts(tracer.instances);
  if (parts.empty() || window.pixels.empty()) return {nullptr, "there is nothing to draw"};
  std::unique_ptr<FirstHits> made(new FirstHits());
  const double packets = traced_packets(tracer, window) * passes;
  made->packet_seconds_ =
      always ? std::numeric_limits<double>::infinity() : traced_seconds(tracer, window);
  const double traced = packets * made->packet_seconds_;
  constexpr int kFramesToRest = 15;
  const auto rest = [&]() -> Made {
    trials.rest = kFramesToRest;
    return {nullptr, kAsFast};
  };
  const auto pays = [&](double seconds) {
    return always || seconds + kPacketSeconds * packets < kGain * traced;
  };
  if (!pays(drawn_seconds({}, parts, passes))) return rest();  // to look at them takes too long

  made->window_ = window.pixels;
  made->spaces_ = ray_spaces(tracer.embree, tracer.instances, window.view, window.longest);
  for (const RaySpace& space : made->spaces_.spaces) {
    if (!(space.forward_length > 0.0F)) return {nullptr, "an instance has no inverse transform"};
  }
  if (!trials.same) {
    trials.same = finds_same_hits(tracer, made->spaces_, parts, window.view);
  }
  if (!trials.same) return {nullptr, "too few rays hit anything to try Embree's arithmetic"};
  if (!*trials.same) return {nullptr, "Embree's arithmetic is not the one that is known"};

  const auto find = [&](std::span<const MeshPart> some) {
    return find_all(tracer, window, made->spaces_, some);
  };
  // Some parts first, about as many of a small scene as of a large one.
  constexpr std::size_t kSome = 8, kLeastStep = 4, kMostStep = 64;
  const std::size_t step = std::clamp(parts.size() / kSome, kLeastStep, kMostStep);
  if (parts.size() > kSome && !always) {
    std::vector<MeshPart> some;
    for (std::size_t i = step / 2; i < parts.size(); i += step) some.push_back(parts[i]);
    const double of_all = static_cast<double>(parts.size()) / static_cast<double>(some.size());
    if (!pays(of_all * drawn_seconds(find(some), some, passes))) return rest();
  }
  const std::vector<SeenTriangles> seen = find(parts);
  if (!pays(drawn_seconds(seen, parts, passes))) return rest();
  made->bins_ = bin_triangles(seen, window.pixels);
  return {std::move(made), ""};
}

std::uint64_t FirstHits::find(const geometry::Rect& pixels, Groups<RayGroup>& groups,
                              Memory& memory) const {
  const int left = (pixels.x0 - window_.x0) / kBlockSide;
  const int top = (pixels.y0 - window_.y0) / kBlockSide;
  const int columns = (pixels.width() + kBlockSide - 1) / kBlockSide;
  const int right = left + columns;
  const int bottom = top + (pixels.height() + kBlockSide - 1) / kBlockSide;
  memory.left.resize(groups.size());
  for (std::size_t g = 0; g < groups.size(); ++g) memory.left[g] = groups[g].active;
  const auto for_each_bin = [&](auto&& f) {
    for (int y = top / kBinBlocks; y * kBinBlocks < bottom; ++y) {
      for (int x = left / kBinBlocks; x * kBinBlocks < right; ++x) f(x, y);
    }
  };
  double seconds = kPacketSeconds * static_cast<double>(groups.size());
  for_each_bin([&](int x, int y) {
    const std::size_t square = bins_.square(x, y);
    seconds += kSetUpSeconds * static_cast<double>(bins_.of(square).size()) +
               kTestSeconds * bins_.blocks[square];
  });
  if (seconds > kDense * packet_seconds_ * static_cast<double>(groups.size())) return 0;

  std::uint64_t certain = 0;
  DrawnSquare& square = memory.square;
  for_each_bin([&](int x, int y) {
    square.clear();
    std::size_t group_of[kSquareBlocks];
    for (int b = 0; b < kSquareBlocks; ++b) {
      const int at_x = x * kBinBlocks + b % kBinBlocks, at_y = y * kBinBlocks + b / kBinBlocks;
      if (at_x < left || at_x >= right || at_y < top || at_y >= bottom) continue;
      const auto g = static_cast<std::size_t>((at_y - top) * columns + at_x - left);
      group_of[b] = g;
      if (!groups[g].misses) square.add(b, groups[g]);
    }
    draw_triangles(spaces_, bins_.of(bins_.square(x, y)), square);
    for (shading::LaneMask rest = square.drawn; rest != 0; rest &= rest - 1) {
      const int b = std::countr_zero(rest);
      ActiveRays& its = memory.left[group_of[b]];
      const int kept = keep_certain_hits(square.blocks[b]);
      if (kept == 0) continue;
      certain += static_cast<std::uint64_t>(kept);
      its = {};
    }
  });
  return certain;
}

}  // namespace delray::raytrace
