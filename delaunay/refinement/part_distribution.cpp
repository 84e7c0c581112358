// Rank 0 numbers the triangles of each part along the curve and sends them; O(n log n) for that,
// and for gathering O(n).
#include "delaunay/refinement/part_distribution.h"

#include <algorithm>
#include <utility>

#include "comm/collectives.h"
#include "delaunay/insertion/insertion_order.h"

namespace delray::delaunay::internal {
namespace {

// The middle of a triangle, or of the edge of the hull.
glm::dvec2 middle_of(const RefinementMesh& mesh, SimplexNumber t) {
  glm::dvec2 sum(0);
  int finite = 0;
  for (unsigned k = 0; k < 3; ++k) {
    const VertexNumber v = mesh.mesh.vertex(t, k);
    if (v == kInfiniteVertex) continue;
    sum += mesh.points[v];
    ++finite;
  }
  return sum / static_cast<double>(finite);
}

double work_of(const RefinementMesh& mesh, const TriangleBounds& bounds, SimplexNumber t) {
  if (!mesh.is_inside(t)) return 1;
  return 1 + bounds.pieces(shape_of_triangle(mesh.points[mesh.mesh.vertex(t, 0)],
                                             mesh.points[mesh.mesh.vertex(t, 1)],
                                             mesh.points[mesh.mesh.vertex(t, 2)]));
}

// The triangles of each rank.
std::vector<std::vector<SimplexNumber>> cut(const RefinementMesh& mesh,
                                            const TriangleBounds& bounds, int ranks) {
  std::vector<SimplexNumber> triangles;
  std::vector<glm::dvec2> middles;
  double all = 0;
  for (SimplexNumber t = 0; t < mesh.triangles; ++t) {
    if (mesh.mesh.is_dead(t)) continue;
    triangles.push_back(t);
    middles.push_back(middle_of(mesh, t));
    all += work_of(mesh, bounds, t);
  }
  std::vector<std::vector<SimplexNumber>> parts(static_cast<std::size_t>(ranks));
  double before = 0;
  for (const std::uint32_t i :
       insertion_order(std::span<const glm::dvec2>(middles), "hilbert", 1)) {
    const double work = work_of(mesh, bounds, triangles[i]);
    const auto rank = static_cast<int>((before + work / 2) / all * ranks);
    parts[static_cast<std::size_t>(std::clamp(rank, 0, ranks - 1))].push_back(triangles[i]);
    before += work;
  }
  return parts;
}

// Those of a part, then others across their pieces.
std::vector<SimplexNumber> with_those_across(const MeshPart& whole,
                                             std::vector<SimplexNumber> part) {
  const RefinementMesh& mesh = whole.mesh;
  const std::size_t own = part.size();
  for (std::size_t i = 0; i < own; ++i) {
    for (unsigned k = 0; k < 3; ++k) {
      const CornerNumber corner = corner_of(part[i], k);
      const SimplexNumber across = simplex_of(mesh.mesh.neighbour(corner));
      if (!mesh.is_segment(corner)) continue;
      if (whole.triangle_id(across).rank != whole.triangle_id(part[i]).rank) {
        part.push_back(across);
      }
    }
  }
  return part;
}

}  // namespace

MeshPart distribute_parts(comm::Communicator& communicator, RefinementMesh& mesh,
                          const TriangleBounds& bounds) {
  std::vector<comm::Parcel> parcels;
  if (communicator.rank() == 0) {
    const std::vector<std::vector<SimplexNumber>> parts = cut(mesh, bounds, communicator.size());
    std::vector<PartId> ids(mesh.triangles);
    for (std::uint32_t rank = 0; rank < parts.size(); ++rank) {
      for (std::uint32_t i = 0; i < parts[rank].size(); ++i) ids[parts[rank][i]] = {rank, i};
    }
    MeshPart whole(std::exchange(mesh, {}), std::move(ids));
    for (std::size_t rank = 0; rank < parts.size(); ++rank) {
      Packer packer;
      packer.value(static_cast<std::uint64_t>(whole.given()));
      packer.value(static_cast<std::uint64_t>(parts[rank].size()));
      packer.value(whole.mesh.tolerance);
      whole.pack(with_those_across(whole, parts[rank]), packer);
      parcels.push_back({static_cast<int>(rank), packer.buffer()});
    }
  }
  const std::vector<comm::Parcel> received = comm::exchange(communicator, std::move(parcels));
  comm::check_message(received.size() == 1);
  Unpacker content(received.front().message);
  const auto given = content.value<std::uint64_t>(), own = content.value<std::uint64_t>();
  MeshPart part(communicator.rank(), static_cast<SimplexNumber>(own),
                static_cast<VertexNumber>(given));
  part.mesh.tolerance = content.value<double>();
  part.unpack(content);
  return part;
}

void gather_parts(comm::Communicator& communicator, MeshPart& part, RefinementMesh& mesh) {
  Packer packer;
  packer.value(static_cast<std::uint64_t>(part.made()));
  std::vector<SimplexNumber> own;
  for (SimplexNumber t = 0; t < part.mesh.triangles; ++t) {
    if (part.is_own(t)) own.push_back(t);
  }
  part.pack(own, packer);
  struct Part {
    std::vector<VertexRecord> vertices;
    std::vector<TriangleRecord> triangles;
    VertexNumber first_vertex;
    std::vector<SimplexNumber> slots;  // by the numbers that triangles had
  };
  std::vector<Part> parts;
  const auto given = static_cast<VertexNumber>(part.given());
  VertexNumber vertices = given;
  SimplexNumber triangles = 0;
  for (const comm::Buffer& message : comm::gather(communicator, 0, packer.buffer())) {
    Unpacker content(message);
    const auto made = content.value<std::uint64_t>();
    Part& each = parts.emplace_back();
    each.vertices = content.list<VertexRecord>();
    content.list<ReachRecord>();
    each.triangles = content.list<TriangleRecord>();
    each.first_vertex = vertices;
    vertices += static_cast<VertexNumber>(made);
    for (const TriangleRecord& record : each.triangles) {
      each.slots.resize(std::max<std::size_t>(each.slots.size(), record.id.number + 1));
      each.slots[record.id.number] = triangles++;
    }
  }
  if (communicator.rank() != 0) return;
  mesh.tolerance = part.mesh.tolerance;
  mesh.reserve(std::max<std::size_t>(vertices, triangles / 2 + 1));
  mesh.vertices = vertices;
  mesh.triangles = triangles;
  for (const Part& each : parts) {
    const auto vertex_of = [&](std::uint32_t place) {
      if (place == kInfiniteVertex) return kInfiniteVertex;
      const PartId id = each.vertices.at(place).id;
      return id.number < given ? id.number : parts.at(id.rank).first_vertex + (id.number - given);
    };
    for (std::uint32_t i = 0; i < each.vertices.size(); ++i) {
      const VertexRecord& record = each.vertices[i];
      const VertexNumber v = vertex_of(i);
      mesh.points[v] = record.position;
      mesh.ends[v] = {vertex_of(record.ends[0]), vertex_of(record.ends[1])};
      mesh.acute[v] = static_cast<std::uint8_t>(record.acute);
    }
    for (const TriangleRecord& record : each.triangles) {
      const SimplexNumber t = each.slots[record.id.number];
      for (unsigned k = 0; k < 3; ++k) {
        const PartId& beyond = record.neighbours[k];
        mesh.mesh.set_vertex(t, k, vertex_of(record.vertices[k]));
        mesh.mesh.set_neighbour(t, k,
                                corner_of(parts.at(beyond.rank).slots.at(simplex_of(beyond.number)),
                                          beyond.number & 3U));
      }
      mesh.set_marks(t, static_cast<std::uint8_t>(record.marks));
    }
  }
}

}  // namespace delray::delaunay::internal
