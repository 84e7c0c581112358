// Triangles go with the positions of their vertices, the ends of the segments that these lie on and
// the reaches of small corners, so that a rank can cut what it has been sent as if the mesh were
// its own.
#include "delaunay/refinement/mesh_part.h"

#include <algorithm>
#include <utility>

#include "delaunay/refinement/small_corners.h"

namespace delray::delaunay::internal {
namespace {

constexpr std::uint32_t kNoRank = 0xffffffffU;

std::uint64_t key_of(const PartId& id) { return std::uint64_t{id.rank} << 32 | id.number; }

// The vertices of a message, each once.
class VertexList {
 public:
  // `places` has one for each vertex, all kInfiniteVertex, before and after.
  VertexList(const MeshPart& part, std::vector<std::uint32_t>& places)
      : part_(part), places_(places) {}
  ~VertexList() {
    for (const VertexNumber v : vertices_) places_[v] = kInfiniteVertex;
  }
  VertexList(const VertexList&) = delete;
  VertexList& operator=(const VertexList&) = delete;

  std::uint32_t place_of(VertexNumber v) {
    if (v == kInfiniteVertex || places_[v] != kInfiniteVertex) {
      return v == kInfiniteVertex ? v : places_[v];
    }
    const RefinementMesh& mesh = part_.mesh;
    SegmentEnds ends = mesh.ends[v];
    for (VertexNumber& end : ends) end = place_of(end);
    places_[v] = static_cast<std::uint32_t>(records_.size());
    vertices_.push_back(v);
    records_.push_back({part_.vertex_id(v), mesh.points[v], ends, mesh.acute[v]});
    return places_[v];
  }
  const std::vector<VertexRecord>& records() const { return records_; }

 private:
  const MeshPart& part_;
  std::vector<std::uint32_t>& places_;
  std::vector<VertexNumber> vertices_;
  std::vector<VertexRecord> records_;
};

}  // namespace

MeshPart::MeshPart(int rank, SimplexNumber own, VertexNumber given)
    : rank_(static_cast<std::uint32_t>(rank)), given_(given) {
  mesh.reserve(own / 2 + 1);
  triangles_.reserve(own);
  for (SimplexNumber t = 0; t < own; ++t) add_slot({rank_, t});
}

MeshPart::MeshPart(RefinementMesh&& whole, std::vector<PartId> triangles)
    : mesh(std::move(whole)),
      rank_(kNoRank),
      given_(mesh.vertices),
      triangles_(std::move(triangles)),
      vertices_(mesh.vertices) {
  for (VertexNumber v = 0; v < mesh.vertices; ++v) vertices_[v] = {0, v};
}

SimplexNumber MeshPart::add_slot(const PartId& id) {
  mesh.reserve(1);
  const SimplexNumber t = mesh.triangles++;
  triangles_.push_back(id);
  is_here_.push_back(id.rank == rank_);
  mesh.mesh.set_vertex(t, 0, kDeadVertex);
  mesh.set_marks(t, 0);
  return t;
}

SimplexNumber MeshPart::slot_of(const PartId& id) {
  if (id.rank == rank_) {
    comm::check_message(id.number < triangles_.size() && is_own(id.number));
    return id.number;
  }
  const auto [at, is_new] = slots_.try_emplace(key_of(id), 0);
  if (is_new) at->second = add_slot(id);
  return at->second;
}

std::optional<VertexNumber> MeshPart::find_vertex(const PartId& id) const {
  if (id.rank == rank_ && id.number >= given_) {
    comm::check_message(id.number - given_ < made_.size());
    return made_[id.number - given_];
  }
  const auto at = known_.find(key_of(id));
  return at == known_.end() ? std::nullopt : std::optional(at->second);
}

VertexNumber MeshPart::add_vertex(const PartId& id) {
  mesh.reserve(1);
  vertices_.push_back(id);
  return mesh.vertices++;
}

VertexNumber MeshPart::make_vertex() {
  made_.push_back(add_vertex({rank_, given_ + static_cast<VertexNumber>(made())}));
  return made_.back();
}

SimplexNumber MeshPart::make_triangle() { return add_slot({rank_, mesh.triangles}); }

void MeshPart::pack(std::span<const SimplexNumber> triangles, Packer& to) {
  places_.resize(mesh.vertices, kInfiniteVertex);
  VertexList vertices(*this, places_);
  std::vector<TriangleRecord> records;
  records.reserve(triangles.size());
  std::map<SegmentEnds, ReachRecord> reaches;
  const SegmentCuts cuts(mesh);
  for (const SimplexNumber t : triangles) {
    TriangleRecord record{triangles_[t], {}, {}, mesh.marks(t)};
    for (unsigned k = 0; k < 3; ++k) {
      const CornerNumber corner = delaunay::corner_of(t, k);
      record.vertices[k] = vertices.place_of(mesh.mesh.vertex(corner));
      record.neighbours[k] = corner_id(mesh.mesh.neighbour(corner));
      if (!mesh.is_segment(corner)) continue;
      const auto [a, b] = cuts.segment_of(mesh.mesh.vertex(next_corner(corner)),
                                          mesh.mesh.vertex(previous_corner(corner)));
      const auto reach = mesh.reaches.find(ascending(a, b));
      if (reach == mesh.reaches.end() || reaches.contains(reach->first)) continue;
      reaches[reach->first] = {{vertices.place_of(a), vertices.place_of(b)},
                               vertices.place_of(reach->second.from),
                               reach->second.length};
    }
    records.push_back(record);
  }
  std::vector<ReachRecord> list;
  list.reserve(reaches.size());
  for (const auto& [segment, reach] : reaches) list.push_back(reach);
  to.list(vertices.records()).list(list).list(records);
}

std::vector<SimplexNumber> MeshPart::unpack(Unpacker& from) {
  std::vector<VertexNumber> numbers;
  const auto number_of = [&](std::uint64_t place) {
    if (place == kInfiniteVertex) return kInfiniteVertex;
    comm::check_message(place < numbers.size());
    return numbers[place];
  };
  const auto records = from.list<VertexRecord>();
  numbers.reserve(records.size());
  if (known_.empty()) known_.reserve(records.size());
  for (const VertexRecord& record : records) {  // ends before what lies between
    std::optional<VertexNumber> v = find_vertex(record.id);
    if (!v) {
      v = add_vertex(record.id);
      known_.emplace(key_of(record.id), *v);
      mesh.points[*v] = record.position;
      mesh.ends[*v] = {number_of(record.ends[0]), number_of(record.ends[1])};
      mesh.acute[*v] = static_cast<std::uint8_t>(record.acute);
    }
    numbers.push_back(*v);
  }
  for (const ReachRecord& record : from.list<ReachRecord>()) {
    const VertexNumber a = number_of(record.segment[0]), b = number_of(record.segment[1]);
    mesh.reaches[ascending(a, b)] = {number_of(record.from), record.length};
  }
  std::vector<SimplexNumber> triangles;
  for (const TriangleRecord& record : from.list<TriangleRecord>()) {
    const SimplexNumber t = slot_of(record.id);
    for (unsigned k = 0; k < 3; ++k) {
      const CornerNumber beyond = corner_of(record.neighbours[k]);
      mesh.mesh.set_vertex(t, k, number_of(record.vertices[k]));
      mesh.mesh.set_neighbour(t, k, beyond);
    }
    mesh.set_marks(t, static_cast<std::uint8_t>(record.marks));
    is_here_[t] = true;
    triangles.push_back(t);
  }
  return triangles;
}

}  // namespace delray::delaunay::internal
