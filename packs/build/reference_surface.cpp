// Pages are read one after the other, and of each the vertices that its triangles have are taken
// once.
#include "packs/build/reference_surface.h"

#include <algorithm>

#include "packs/build/vertices.h"

namespace delray::packs::internal {
namespace {

constexpr std::uint8_t kAllCorners = 7;

// Brings triangles in order, and makes one of those that are there several times.
void join(std::vector<Reference>& triangles) {
  std::ranges::sort(triangles, [](const Reference& a, const Reference& b) {
    return a.page != b.page ? a.page < b.page : a.triangle < b.triangle;
  });
  std::size_t count = 0;
  for (const Reference& reference : triangles) {
    if (count > 0 && triangles[count - 1].page == reference.page &&
        triangles[count - 1].triangle == reference.triangle) {
      triangles[count - 1].corners |= reference.corners;
    } else {
      triangles[count++] = reference;
    }
  }
  triangles.resize(count);
}

// Triangles of one page, ascending and each once.
void append_triangles(const Page& page, std::span<const Reference> triangles,
                      ReferenceSurface& to) {
  to.mesh.shape = page.mesh.shape;
  to.mesh.material = page.mesh.material;
  std::vector<std::uint32_t> number(page.mesh.positions.size(), scenes::kNone);
  for (const Reference& reference : triangles) {
    const glm::uvec3& corners = page.mesh.triangles[reference.triangle];
    glm::uvec3 made;
    for (int k = 0; k < 3; ++k) {
      std::uint32_t& vertex = number[corners[k]];
      if (vertex == scenes::kNone) {
        vertex = static_cast<std::uint32_t>(to.mesh.positions.size());
        copy_vertex(page.mesh, corners[k], to.mesh);
        to.measured.push_back(0);
      }
      to.measured[vertex] |= reference.corners >> k & 1;
      made[k] = vertex;
    }
    to.mesh.triangles.push_back(made);
    to.triangles.push_back(reference);
  }
}

// By vertex: runs that a triangle with it was given to.
using VertexRuns = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

// Of these only vertices of several runs, in order.
void leave_borders(VertexRuns& runs) {
  std::ranges::sort(runs);
  runs.erase(std::unique(runs.begin(), runs.end()), runs.end());
  VertexRuns left;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const bool as_before = i > 0 && runs[i - 1].first == runs[i].first;
    const bool as_next = i + 1 < runs.size() && runs[i + 1].first == runs[i].first;
    if (as_before || as_next) left.push_back(runs[i]);
  }
  runs = std::move(left);
}

}  // namespace

ReferenceSurface whole_pages(std::span<const std::uint32_t> pages, std::span<const Page> content,
                             scenes::Mesh&& mesh) {
  ReferenceSurface surface{std::move(mesh), {}, {}};
  for (std::size_t i = 0; i < pages.size(); ++i) {
    const auto triangles = static_cast<std::uint16_t>(content[i].mesh.triangles.size());
    for (std::uint16_t t = 0; t < triangles; ++t)
      surface.triangles.push_back({pages[i], t, kAllCorners});
  }
  return surface;
}

ReferenceSurface surface_of(std::vector<Reference>&& triangles,
                            const std::function<Page(std::uint32_t page)>& read) {
  join(triangles);
  const std::size_t count = triangles.size();
  ReferenceSurface surface;
  for (std::size_t i = 0; i < count;) {
    std::size_t end = i;
    while (end < count && triangles[end].page == triangles[i].page) ++end;
    append_triangles(read(triangles[i].page), std::span(triangles).subspan(i, end - i), surface);
    i = end;
  }
  return surface;
}

std::vector<std::vector<Reference>> share_out(const ReferenceSurface& surface,
                                              const SurfaceErrors& errors,
                                              std::span<const std::uint32_t> ends) {
  std::vector<std::vector<Reference>> shares(ends.size());
  const auto run_of = [&](std::uint32_t simplified) {
    return static_cast<std::uint32_t>(std::ranges::upper_bound(ends, simplified) - ends.begin());
  };
  if (!surface.mesh.has_triangles()) {  // one vertex each, which others do not have: in order
    for (std::uint32_t t = 0; t < surface.triangles.size(); ++t) {
      const std::uint32_t nearest = errors.nearest[surface.mesh.triangles[t].x];
      const Reference& whole = surface.triangles[t];
      shares[run_of(nearest)].push_back({whole.page, whole.triangle, kAllCorners});
    }
    return shares;
  }
  VertexRuns runs_of_vertex;
  const auto give = [&](std::uint32_t run, std::uint32_t triangle, unsigned corners) {
    const Reference& whole = surface.triangles[triangle];
    shares[run].push_back({whole.page, whole.triangle, static_cast<std::uint8_t>(corners)});
  };
  const auto give_to_whose = [&](std::uint32_t simplified, std::uint32_t triangle,
                                 unsigned corners) {
    const std::uint32_t run = run_of(simplified);
    give(run, triangle, corners);
    for (int k = 0; k < 3; ++k)
      runs_of_vertex.emplace_back(surface.mesh.triangles[triangle][k], run);
  };
  for (std::uint32_t t = 0; t < surface.triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t nearest = errors.nearest[surface.mesh.triangles[t][k]];
      if (nearest != scenes::kNone) give_to_whose(nearest, t, 1U << k);
    }
  }
  for (const auto& [simplified, triangle] : errors.beneath) give_to_whose(simplified, triangle, 0);
  leave_borders(runs_of_vertex);
  for (std::uint32_t t = 0; t < surface.triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t vertex = surface.mesh.triangles[t][k];
      auto at = std::ranges::lower_bound(runs_of_vertex, std::pair{vertex, 0U});
      for (; at != runs_of_vertex.end() && at->first == vertex; ++at) give(at->second, t, 0);
    }
  }
  for (std::vector<Reference>& share : shares) join(share);
  return shares;
}

}  // namespace delray::packs::internal
