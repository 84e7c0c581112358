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
#include "files/error.h"
#include "packs/build/cut_pages.h"
#include "packs/build/encoded_page.h"
#include "packs/build/levels.h"
#include "packs/format/page_bytes.h"
#include "packs/format/scene_bytes.h"
#include "packs/format/trailer.h"
#include "parallel/arena.h"
#include "parallel/parallel_for.h"

namespace delray::packs {
namespace {

constexpr std::uint32_t kBlockTriangles = PackWriter::kBlockTriangles;  // cut by one thread
constexpr std::size_t kBlocksPerThread = 4;

using internal::EncodedPage;

// Triangles [begin, end) of a part of a mesh, of which the first has the number `first`.
std::vector<EncodedPage> encode_block(const scenes::Mesh& mesh, std::uint32_t first,
                                      std::uint32_t begin, std::uint32_t end) {
  std::vector<EncodedPage> pages;
  for (const Page& page : internal::cut_pages(mesh, begin, end)) {
    PageRow row;
    row.first = first + begin;
    pages.push_back(internal::encode_page(page, row));
    begin += pages.back().row.triangles;
  }
  return pages;
}

}  // namespace

struct PackWriter::State {
  State(const std::filesystem::path& path, const WriteOptions& how)
      : options(how),
        scratch(std::filesystem::absolute(path).parent_path()),
        name(path.string()),
        file(path) {}

  const WriteOptions options;
  const std::filesystem::path scratch;  // the folder of the file
  const std::string name;
  files::AtomicFile file;
  std::uint64_t written = 0;
  internal::Table table;
  MeshRow mesh;              // the one at hand, without name
  std::uint32_t first = 0;   // page of it
  std::vector<char> buffer;  // of pages on their way

  void write(std::span<const char> bytes) {
    file.write({bytes.data(), bytes.size()});
    written += bytes.size();
  }
  void append(std::vector<EncodedPage>& pages) {
    for (EncodedPage& page : pages) {
      page.row.offset = written + buffer.size();
      buffer.insert(buffer.end(), page.bytes.begin(), page.bytes.end());
      table.pages.push_back(page.row);
      mesh.box.include(page.row.box);
    }
  }
  void flush() {
    write(buffer);
    buffer.clear();
  }
  Page read(std::uint32_t number) const {
    const PageRow& row = table.pages[number];
    std::vector<char> bytes(row.bytes);
    file.read_back(row.offset, bytes);
    Page page;
    internal::decode(bytes, row, mesh, "", "page " + std::to_string(number), page);
    return page;
  }
  internal::Section section(std::span<const char> bytes) {
    const internal::Section result{written, bytes.size(), XXH3_64bits(bytes.data(), bytes.size())};
    write(bytes);
    return result;
  }
};

PackWriter::PackWriter(const std::filesystem::path& path, const WriteOptions& options)
    : state_(std::make_unique<State>(path, options)) {
  if (options.levels && state_->file.is_in_place()) {
    throw files::FileError(files::Cause::device, path.string(), "",
                           "a pack with levels is written to a file, not to a pipe or device");
  }
  internal::ByteWriter header;
  header.raw(kMagic, sizeof kMagic);
  header.value(kVersion);
  header.value(std::uint32_t{0});
  state_->write(header.bytes());
}
PackWriter::~PackWriter() = default;

void PackWriter::append_part(const scenes::Mesh& part) {
  MeshRow& row = state_->mesh;
  const std::uint64_t before = row.triangles;
  if (before + part.triangles.size() > 0xFFFFFFFFU)
    throw std::invalid_argument("a mesh of a pack has 2^32 - 1 triangles at most");
  row.attributes = attributes_of(part);
  row.shape = part.shape;
  row.material = part.material;
  row.triangles += part.triangles.size();
  const auto all = static_cast<std::uint32_t>(part.triangles.size());
  const std::size_t blocks = (std::size_t{all} + kBlockTriangles - 1) / kBlockTriangles;
  const std::size_t wave = kBlocksPerThread * static_cast<std::size_t>(parallel::arena_threads());
  std::vector<std::vector<EncodedPage>> done(std::min(wave, blocks));
  for (std::size_t first = 0; first < blocks; first += wave) {
    const std::size_t count = std::min(wave, blocks - first);
    parallel::parallel_for(0, count, 1, [&](std::size_t i) {
      const auto begin = static_cast<std::uint32_t>((first + i) * kBlockTriangles);
      done[i] = encode_block(part, static_cast<std::uint32_t>(before), begin,
                             begin + std::min(kBlockTriangles, all - begin));
    });
    for (std::size_t i = 0; i < count; ++i) state_->append(done[i]);
    state_->flush();
    if (state_->options.progress != nullptr) state_->options.progress->advance(0);
  }
}

std::uint32_t PackWriter::end_mesh(const std::string& name, std::uint32_t material,
                                   std::uint64_t vertices, const scenes::Shape& shape) {
  State& state = *state_;
  if (state.mesh.triangles == 0) throw std::invalid_argument("a mesh of a pack has triangles");
  const auto pages = static_cast<std::uint32_t>(state.table.pages.size());
  state.mesh.name = name;
  state.mesh.material = material;
  state.mesh.vertices = vertices;
  state.mesh.shape = shape;
  state.mesh.levels.push_back({state.first, pages - state.first});
  if (state.options.levels && state.mesh.shape.kind != scenes::Shape::Kind::line) {
    internal::build_levels(
        {[&](std::uint32_t page) { return state.read(page); },
         [&](std::vector<EncodedPage>&& made) {
           state.append(made);
           state.flush();
         },
         state.scratch, state.options.progress, state.options.memory, state.name},
        state.table.pages, state.table.groups, state.mesh);
  }
  state.first = static_cast<std::uint32_t>(state.table.pages.size());
  state.table.meshes.push_back(std::move(state.mesh));
  state.mesh = {};
  return static_cast<std::uint32_t>(state.table.meshes.size() - 1);
}

std::uint32_t PackWriter::add_mesh(const scenes::Mesh& mesh) {
  append_part(mesh);
  return end_mesh(mesh.name, mesh.material, mesh.positions.size(), mesh.shape);
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

void write_pack(const std::filesystem::path& path, const scenes::Scene& scene,
                const WriteOptions& options) {
  PackWriter writer(path, options);
  for (const scenes::Mesh& mesh : scene.meshes) writer.add_mesh(mesh);
  writer.commit(scene, scenes::is_lit_by_emission(scene));
}

}  // namespace delray::packs
