// Opens a pack from its end: trailer, table, scene. Nothing is trusted before its checksum was
// looked at, and nothing after it either, since whoever changes a file can make checksums right.
#include "packs/pack_reader.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>
#include <xxhash.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>

#include "files/error.h"
#include "files/read_file.h"
#include "packs/format/page_bytes.h"
#include "packs/format/scene_bytes.h"
#include "packs/format/trailer.h"
#include "packs/pack_writer.h"

namespace delray::packs {
namespace {

using files::Cause;
using files::FileError;

scenes::Mesh mesh_without_triangles(const MeshRow& row) {
  scenes::Mesh mesh;
  mesh.name = row.name;
  mesh.shape = row.shape;
  mesh.material = row.material;
  if (row.attributes.normals) mesh.normals.emplace_back(0, 0, 1);
  if (row.attributes.uvs) mesh.uvs.emplace_back(0, 0);
  if (row.attributes.uvs2) mesh.uvs2.emplace_back(0, 0);
  if (row.attributes.tangents) mesh.tangents.emplace_back(1, 0, 0, 1);
  if (row.attributes.colours) mesh.colours.emplace_back(1, 1, 1, 1);
  return mesh;
}

}  // namespace

bool is_pack(const std::filesystem::path& path) {
  if (files::is_stream(path)) return false;
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return false;
  return files::read_start(path, sizeof kMagic) == std::string_view(kMagic, sizeof kMagic);
}

PackReader::PackReader(const std::filesystem::path& path, const files::MemoryBudget& memory)
    : name_(path.string()) {
  descriptor_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  struct stat status {};
  if (descriptor_ < 0 || ::fstat(descriptor_, &status) != 0) {
    const int error = errno;
    if (descriptor_ >= 0) ::close(descriptor_);
    throw FileError(Cause::input, name_, "", std::strerror(error));
  }
  try {
    open(static_cast<std::uint64_t>(status.st_size), memory);
  } catch (...) {
    ::close(descriptor_);
    throw;
  }
}

PackReader::~PackReader() { ::close(descriptor_); }

void PackReader::open(std::uint64_t bytes, const files::MemoryBudget& memory) {
  file_bytes_ = bytes;
  const auto fail = [&](const std::string& what) {
    throw FileError(Cause::input, name_, "", what);
  };
  std::vector<char> start(std::min<std::uint64_t>(bytes, internal::kHeaderBytes));
  read_bytes(0, start);
  if (start.size() < sizeof kMagic || std::memcmp(start.data(), kMagic, sizeof kMagic) != 0)
    fail("this is not a pack");
  if (bytes < internal::kHeaderBytes + internal::kTrailerBytes)
    fail("the pack is cut short: its end is missing");
  std::uint32_t version = 0;
  std::memcpy(&version, start.data() + sizeof kMagic, sizeof version);
  if (version != kVersion) {
    fail("the pack is of version " + std::to_string(version) + ", of which only " +
         std::to_string(kVersion) + " is known: pack its scene again");
  }
  std::uint32_t nothing = 0;
  std::memcpy(&nothing, start.data() + sizeof kMagic + sizeof version, sizeof nothing);
  if (nothing != 0) fail("the pack is damaged: its header");
  std::vector<char> end(internal::kTrailerBytes);
  read_bytes(bytes - end.size(), end);
  const internal::Trailer trailer =
      internal::read_trailer(internal::ByteReader(end, name_, ""), end, bytes);

  const auto section = [&](const internal::Section& where, const std::string& what) {
    memory.require(where.bytes, name_, what);
    std::vector<char> content(where.bytes);
    read_bytes(where.offset, content);
    if (XXH3_64bits(content.data(), content.size()) != where.checksum)
      fail("the pack is damaged: " + what + " has another checksum");
    return content;
  };
  internal::Table table;
  {
    const std::vector<char> content = section(trailer.table, "its table");
    memory.require(content.size(), name_, "its table");
    internal::ByteReader from(content, name_, "table");
    internal::read_table(from, trailer.scene.offset, table);
  }
  {
    const std::vector<char> content = section(trailer.scene, "its scene");
    internal::ByteReader from(content, name_, "scene");
    internal::read_scene(from, table.meshes.size(), memory, name_, scene_);
  }
  lit_by_emission_ = table.lit_by_emission;
  meshes_ = std::move(table.meshes);
  pages_ = std::move(table.pages);
  groups_ = std::move(table.groups);
  for (const MeshRow& row : meshes_) scene_.meshes.push_back(mesh_without_triangles(row));
  first_primitives_ = {0};
  for (const scenes::Instance& instance : scene_.instances) {
    const MeshRow& mesh = meshes_[instance.mesh];
    first_primitives_.push_back(first_primitives_.back() + mesh.triangles);
    if (mesh.shape.kind != scenes::Shape::Kind::triangle) splats_ += mesh.triangles;
    vertices_ += mesh.vertices;
  }
}

scenes::Scene PackReader::take_scene() {
  std::vector<scenes::Texture> textures = std::move(scene_.textures);
  scene_.textures.clear();
  scenes::Scene taken = scene_;
  taken.textures = std::move(textures);
  return taken;
}

std::uint32_t PackReader::mesh_of(std::uint32_t page) const {
  const auto after = std::upper_bound(
      meshes_.begin(), meshes_.end(), page,
      [](std::uint32_t p, const MeshRow& mesh) { return p < mesh.levels.front().first; });
  return static_cast<std::uint32_t>(after - meshes_.begin()) - 1;
}

void PackReader::read_bytes(std::uint64_t begin, std::span<char> bytes) const {
  std::size_t read = 0;
  while (read < bytes.size()) {
    const ssize_t got = ::pread(descriptor_, bytes.data() + read, bytes.size() - read,
                                static_cast<off_t>(begin + read));
    if (got > 0) {
      read += static_cast<std::size_t>(got);
    } else if (got == 0) {
      throw FileError(Cause::input, name_, "byte " + std::to_string(begin + read),
                      "the file ends here, though it was longer before");
    } else if (errno != EINTR) {
      throw FileError(Cause::device, name_, "byte " + std::to_string(begin + read),
                      std::string("cannot read: ") + std::strerror(errno));
    }
  }
}

double PackReader::read_and_time(std::uint64_t begin, std::span<char> bytes) const {
  const iovec where{bytes.data(), bytes.size()};
  const ssize_t got = ::preadv2(descriptor_, &where, 1, static_cast<off_t>(begin), RWF_NOWAIT);
  const std::size_t read = got > 0 ? static_cast<std::size_t>(got) : 0;
  if (read == bytes.size()) return 0;
  const bool waits = got > 0 || (got < 0 && errno == EAGAIN);
  const auto start = std::chrono::steady_clock::now();
  read_bytes(begin + read, bytes.subspan(read));
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  return waits ? seconds.count() : 0;
}

Page PackReader::read(std::uint32_t page) const {
  Page result;
  read(page, result);
  return result;
}

double PackReader::read(std::uint32_t page, Page& into) const {
  const PageRow& row = pages_[page];
  thread_local std::vector<char> bytes;
  bytes.resize(row.bytes);
  const double waited = read_and_time(row.offset, bytes);
  const std::string place = "page " + std::to_string(page);
  if (XXH3_64bits(bytes.data(), bytes.size()) != row.checksum) {
    throw FileError(Cause::input, name_, place + ", byte " + std::to_string(row.offset),
                    "the pack is damaged: the page has another checksum");
  }
  internal::decode(bytes, row, meshes_[mesh_of(page)], name_, place, into);
  return waited;
}

void PackReader::will_need(std::span<const std::uint32_t> pages) const {
  constexpr std::uint64_t kGap = 64 << 10;  // takes no longer to read than to begin anew
  for (std::size_t i = 0; i < pages.size();) {
    const std::uint64_t begin = pages_[pages[i]].offset;
    std::uint64_t end = begin;
    for (; i < pages.size(); ++i) {
      const PageRow& row = pages_[pages[i]];
      if (row.offset < begin || row.offset > end + kGap) break;
      end = std::max(end, row.offset + row.bytes);
    }
    ::posix_fadvise(descriptor_, static_cast<off_t>(begin), static_cast<off_t>(end - begin),
                    POSIX_FADV_WILLNEED);
  }
}

}  // namespace delray::packs
