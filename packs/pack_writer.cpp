// Writes header, pages, scene, table and trailer, in this order: whoever reads begins at the end.
//
// Meshes are cut in blocks of triangles, a few at a time in parallel, and written in order, so that
// the file is the same for every number of threads.
#include "packs/pack_writer.h"

#include <xxhash.h>

#include <algorithm>
#include <span>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "files/atomic_file.h"
#include "packs/build/cut_pages.h"
#include "packs/format/page_bytes.h"
#include "packs/format/scene_bytes.h"
#include "packs/format/trailer.h"
#include "parallel/arena.h"
#include "parallel/parallel_for.h"

namespace delray::packs {
namespace {

constexpr std::uint32_t kBlockTriangles = 1U << 14;  // cut by one thread: some 32 pages
constexpr std::size_t kBlocksPerThread = 4;

// A page that is only to be written, and its row but for where it will be.
struct EncodedPage {
  PageRow row;
  std::vector<char> bytes;
};

EncodedPage encoded(const Page& page, std::uint32_t first) {
  EncodedPage result;
  result.bytes = internal::encode(page);
  PageRow& row = result.row;
  row.checksum = XXH3_64bits(result.bytes.data(), result.bytes.size());
  row.bytes = static_cast<std::uint32_t>(result.bytes.size());
  row.first = first;
  row.triangles = static_cast<std::uint16_t>(page.mesh.triangles.size());
  row.vertices = static_cast<std::uint16_t>(page.mesh.positions.size());
  row.references = static_cast<std::uint16_t>(page.vertices.size());
  row.clusters = static_cast<std::uint8_t>(page.clusters.size());
  row.box = internal::box_of(page);
  row.cone = internal::cone_of(page);
  return result;
}

std::vector<EncodedPage> encode_block(const scenes::Mesh& mesh, std::uint32_t begin,
                                      std::uint32_t end) {
  std::vector<EncodedPage> pages;
  for (const Page& page : internal::cut_pages(mesh, begin, end)) {
    pages.push_back(encoded(page, begin));
    begin += pages.back().row.triangles;
  }
  return pages;
}

}  // namespace

struct PackWriter::State {
  explicit State(const std::filesystem::path& path) : file(path) {}

  files::AtomicFile file;
  std::uint64_t written = 0;
  internal::Table table;

  void write(std::span<const char> bytes) {
    file.write({bytes.data(), bytes.size()});
    written += bytes.size();
  }
  void append(EncodedPage&& page, std::vector<char>& buffer) {
    page.row.offset = written + buffer.size();
    buffer.insert(buffer.end(), page.bytes.begin(), page.bytes.end());
    table.pages.push_back(page.row);
  }
  internal::Section section(std::span<const char> bytes) {
    const internal::Section result{written, bytes.size(), XXH3_64bits(bytes.data(), bytes.size())};
    write(bytes);
    return result;
  }
};

PackWriter::PackWriter(const std::filesystem::path& path) : state_(std::make_unique<State>(path)) {
  internal::ByteWriter header;
  header.raw(kMagic, sizeof kMagic);
  header.value(kVersion);
  header.value(std::uint32_t{0});
  state_->write(header.bytes());
}
PackWriter::~PackWriter() = default;

std::uint32_t PackWriter::add_mesh(const scenes::Mesh& mesh) {
  if (mesh.triangles.empty() || mesh.triangles.size() > 0xFFFFFFFFU)
    throw std::invalid_argument("a mesh of a pack has from 1 to 2^32 - 1 triangles");
  internal::Table& table = state_->table;
  MeshRow row{mesh.name,
              mesh.material,
              attributes_of(mesh),
              mesh.triangles.size(),
              mesh.positions.size(),
              {},
              {}};
  PageRange range{static_cast<std::uint32_t>(table.pages.size()), 0};
  const auto all = static_cast<std::uint32_t>(mesh.triangles.size());
  const std::size_t blocks = (std::size_t{all} + kBlockTriangles - 1) / kBlockTriangles;
  const std::size_t wave = kBlocksPerThread * static_cast<std::size_t>(parallel::arena_threads());
  std::vector<std::vector<EncodedPage>> done(std::min(wave, blocks));
  std::vector<char> buffer;
  for (std::size_t first = 0; first < blocks; first += wave) {
    const std::size_t count = std::min(wave, blocks - first);
    parallel::parallel_for(0, count, 1, [&](std::size_t i) {
      const auto begin = static_cast<std::uint32_t>((first + i) * kBlockTriangles);
      done[i] = encode_block(mesh, begin, begin + std::min(kBlockTriangles, all - begin));
    });
    buffer.clear();
    for (std::size_t i = 0; i < count; ++i) {
      for (EncodedPage& page : done[i]) {
        row.box.include(page.row.box);
        state_->append(std::move(page), buffer);
      }
      done[i].clear();
    }
    state_->write(buffer);
  }
  range.count = static_cast<std::uint32_t>(table.pages.size()) - range.first;
  row.levels.push_back(range);
  table.meshes.push_back(std::move(row));
  return static_cast<std::uint32_t>(table.meshes.size() - 1);
}

void PackWriter::commit(const scenes::Scene& rest, bool lit_by_emission) {
  state_->table.lit_by_emission = lit_by_emission;
  internal::Trailer trailer;
  internal::ByteWriter scene, table, end;
  internal::write_scene(rest, scene);
  trailer.scene = state_->section(scene.bytes());
  internal::write_table(state_->table, table);
  trailer.table = state_->section(table.bytes());
  internal::write_trailer(trailer, end);
  state_->write(end.bytes());
  state_->file.commit();
}

std::uint64_t PackWriter::bytes() const { return state_->written; }

void write_pack(const std::filesystem::path& path, const scenes::Scene& scene) {
  PackWriter writer(path);
  for (const scenes::Mesh& mesh : scene.meshes) writer.add_mesh(mesh);
  writer.commit(scene, scenes::is_lit_by_emission(scene));
}

}  // namespace delray::packs
