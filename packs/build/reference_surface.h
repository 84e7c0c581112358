// The part of a finer level that a group of pages stands for, as one mesh.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "packs/build/references.h"
#include "packs/build/surface_error.h"
#include "packs/page.h"

namespace delray::packs::internal {

struct ReferenceSurface {
  scenes::Mesh mesh;
  std::vector<Reference> triangles;    // of the mesh: which they are
  std::vector<std::uint8_t> measured;  // by vertex, as FineSurface has it; empty: all
};

// Of whole pages, which `pages` has the numbers of: `mesh` has their triangles one after the other.
ReferenceSurface whole_pages(std::span<const std::uint32_t> pages, std::span<const Page> content,
                             scenes::Mesh&& mesh);

// Of these triangles, in any order, of which some may be there several times, with different
// corners.
ReferenceSurface surface_of(std::vector<Reference>&& triangles,
                            const std::function<Page(std::uint32_t page)>& read);

// The references that each of several consecutive runs of a simplified mesh's triangles stands for,
// of which `ends` has the ends: those with a corner that is nearest to one of the run, those that
// are nearest to a middle of it, and, without corners, those that share a corner with them, as what
// is beneath a narrow triangle at the border of a run may be nearest to others.
std::vector<std::vector<Reference>> share_out(const ReferenceSurface& surface,
                                              const SurfaceErrors& errors,
                                              std::span<const std::uint32_t> ends);

}  // namespace delray::packs::internal
