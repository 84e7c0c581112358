// Writes the arrays of a page one after the other, and trusts nothing of what it reads: sizes
// follow from the row's counts, and what is an index has to be one. O(bytes).
#include "packs/format/page_bytes.h"

#include <algorithm>

#include "packs/format/bytes.h"
#include "packs/format/within.h"
#include "packs/word_planes.h"

namespace delray::packs::internal {
namespace {

constexpr std::size_t kClusterBytes = 2 + 2 + 24 + 20 + 1;

// Calls f(array) for each attribute.
template <class Mesh, class F>
void for_each_attribute(Mesh& mesh, F&& f) {
  f(mesh.normals);
  f(mesh.uvs);
  f(mesh.uvs2);
  f(mesh.tangents);
  f(mesh.colours);
}

template <class Vector>
void append_vectors(const std::vector<Vector>& values, std::vector<char>& bytes) {
  if (values.empty()) return;
  const auto* const words = reinterpret_cast<const std::uint32_t*>(values.data());
  for (int k = 0; k < Vector::length(); ++k)
    append_planes(words + k, values.size(), static_cast<std::size_t>(Vector::length()), bytes);
}

template <class Vector>
void read_vectors(ByteReader& from, std::size_t n, std::vector<Vector>& values) {
  values.resize(n);
  if (n == 0) return;
  read_planes(from.take(sizeof(Vector) * n).data(), n, Vector::length(),
              reinterpret_cast<std::uint32_t*>(values.data()));
}

void read_clusters(ByteReader& from, const PageRow& row, Page& page) {
  page.clusters.resize(row.clusters);
  std::uint32_t triangles = 0, references = 0, corners = 0;
  for (PageCluster& cluster : page.clusters) {
    std::uint16_t count = 0, vertices = 0;
    from.value(count);
    from.value(vertices);
    from.value(cluster.box);
    from.value(cluster.cone);
    from.flag(cluster.normals_agree);
    if (count == 0 || count > kClusterTriangles || vertices == 0 || vertices > kClusterVertices)
      from.fail("a cluster has no triangles or too many");
    cluster.first = triangles;
    cluster.count = count;
    cluster.first_vertex = references;
    cluster.vertices = vertices;
    cluster.first_corner = corners;
    triangles += count;
    references += vertices;
    corners += 3 * cluster.corner_stride();
  }
  if (triangles != row.triangles || references != row.references)
    from.fail("its clusters do not have the triangles of the table");
  page.vertices.resize(references);
  page.corners.assign(corners, 0);
}

void read_references(ByteReader& from, const PageRow& row, Page& page) {
  const std::span<const char> bytes = from.take(2 * page.vertices.size());
  const char* const packed = bytes.data();
  std::uint32_t* const vertices = page.vertices.data();
  const std::size_t count = page.vertices.size();
  const std::uint32_t limit = row.vertices;
  std::uint32_t wrong = 0;
  for (std::size_t i = 0; i < count; ++i) {
    std::uint16_t vertex = 0;
    std::memcpy(&vertex, packed + 2 * i, sizeof vertex);
    vertices[i] = vertex;
    wrong |= limit - 1 - vertex;  // its highest bit, where it is larger
  }
  if (count > 0 && (wrong >> 31) != 0) from.fail("a vertex of a cluster is none of the page");
}

void read_corners(ByteReader& from, Page& page) {
  for (const PageCluster& cluster : page.clusters) {
    std::uint8_t largest = 0;
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::span<const char> bytes = from.take(cluster.count);
      std::uint8_t* const to =
          page.corners.data() + cluster.first_corner + k * cluster.corner_stride();
      std::memcpy(to, bytes.data(), bytes.size());
      for (std::uint32_t t = 0; t < cluster.count; ++t) largest = std::max(largest, to[t]);
    }
    if (largest >= cluster.vertices) from.fail("a corner is none of the cluster's vertices");
  }
}

void make_triangles(Page& page) {
  std::size_t count = 0;
  for (const PageCluster& cluster : page.clusters) count += cluster.count;
  page.mesh.triangles.resize(count);
  for (const PageCluster& cluster : page.clusters) {
    const std::uint32_t* const vertices = page.vertices.data() + cluster.first_vertex;
    const std::size_t stride = cluster.corner_stride();
    const std::uint8_t* const a = page.corners.data() + cluster.first_corner;
    const std::uint8_t *const b = a + stride, *const c = b + stride;
    glm::uvec3* const triangles = page.mesh.triangles.data() + cluster.first;
    for (std::uint32_t t = 0; t < cluster.count; ++t)
      triangles[t] = {vertices[a[t]], vertices[b[t]], vertices[c[t]]};
  }
}

}  // namespace

std::vector<char> encode(const Page& page) {
  ByteWriter geometry;
  for (const PageCluster& cluster : page.clusters) {
    geometry.value(static_cast<std::uint16_t>(cluster.count));
    geometry.value(static_cast<std::uint16_t>(cluster.vertices));
    geometry.value(cluster.box);
    geometry.value(cluster.cone);
    geometry.flag(cluster.normals_agree);
  }
  for (const std::uint32_t vertex : page.vertices)
    geometry.value(static_cast<std::uint16_t>(vertex));
  for (const PageCluster& cluster : page.clusters) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      geometry.raw(page.corners.data() + cluster.first_corner + k * cluster.corner_stride(),
                   cluster.count);
    }
  }
  append_vectors(page.mesh.positions, geometry.bytes());
  std::vector<char> attributes;
  for_each_attribute(page.mesh, [&](const auto& values) { append_vectors(values, attributes); });

  const std::vector<char> first = compress(geometry.bytes()), second = compress(attributes);
  ByteWriter bytes;
  bytes.value(static_cast<std::uint32_t>(first.size()));
  bytes.raw(first.data(), first.size());
  bytes.raw(second.data(), second.size());
  return std::move(bytes.bytes());
}

void decode(std::span<const char> bytes, const PageRow& row, const MeshRow& mesh,
            const std::string& file, const std::string& place, Page& page) {
  thread_local std::vector<char> unpacked;
  ByteReader packed(bytes, file, place);
  std::uint32_t first_size = 0;
  packed.value(first_size);
  const std::span<const char> first = packed.take(first_size);
  const std::span<const char> second = bytes.subspan(sizeof first_size + first_size);

  page.mesh.shape = mesh.shape;
  page.mesh.material = mesh.material;
  const std::size_t n = row.vertices;
  unpacked.resize(row.clusters * kClusterBytes + std::size_t{2} * row.references +
                  std::size_t{3} * row.triangles + 12 * n);
  if (!decompress(first, unpacked)) packed.fail("it does not unpack to what the table says");
  ByteReader geometry(unpacked, file, place);
  read_clusters(geometry, row, page);
  read_references(geometry, row, page);
  read_corners(geometry, page);
  read_vectors(geometry, n, page.mesh.positions);
  if (!are_within(row.box, page.mesh.positions))
    packed.fail("a vertex is outside of the page's box");
  make_triangles(page);

  unpacked.resize(mesh.attributes.bytes() * n);
  if (!decompress(second, unpacked)) packed.fail("its attributes do not unpack");
  ByteReader attributes(unpacked, file, place);
  const Attributes& has = mesh.attributes;
  read_vectors(attributes, has.normals ? n : 0, page.mesh.normals);
  read_vectors(attributes, has.uvs ? n : 0, page.mesh.uvs);
  read_vectors(attributes, has.uvs2 ? n : 0, page.mesh.uvs2);
  read_vectors(attributes, has.tangents ? n : 0, page.mesh.tangents);
  read_vectors(attributes, has.colours ? n : 0, page.mesh.colours);
}

}  // namespace delray::packs::internal
