// OBJ (Wavefront): vertices, texture coordinates, normals and polygons of them.
//
// Ranges of lines are read at the same time, twice: indices may point to vertices that come later.
// Corners of equal indices share a vertex, numbered by its first corner. A hash table finds it;
// where faces are triangles of one material with positions alone, an array by position does, and
// corners are read into the scene's triangles. O(bytes).
#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <charconv>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <span>

#include "files/line_ranges.h"
#include "files/read_file.h"
#include "parallel/grow.h"
#include "parallel/parallel_for.h"
#include "scenes/files/for_each_block.h"
#include "scenes/files/growth_watch.h"
#include "scenes/files/read_mtl.h"
#include "scenes/files/readers.h"
#include "scenes/files/vertex_values.h"
#include "scenes/geometry/noise.h"
#include "scenes/geometry/origin.h"
#include "scenes/geometry/polygon.h"
#include "scenes/geometry/weld.h"

namespace delray::scenes::internal {
namespace {

using Counts = std::array<std::int64_t, 3>;  // of v, vt and vn
constexpr std::array<std::string_view, 3> kKeys = {"v", "vt", "vn"};
constexpr std::array kWhat = {"vertex", "texture coordinate", "normal"};

// A corner of a face: numbers of its position, texture coordinate and normal, from 0; kNone: none.
using Corner = std::array<std::uint32_t, 3>;

// The vertex of each corner met so far, in each mesh.
class CornerTable {
 public:
  // The vertex of `corner` in a mesh; `next` if it is new, which it is no longer then.
  std::uint32_t find(std::uint32_t mesh, const Corner& corner, std::uint32_t next) {
    if (2 * (count_ + 1) > slots_.size()) grow();
    Entry& entry = slots_[slot_of(mesh, corner)];
    if (entry.vertex == kNone) {
      entry = {mesh, next, corner};
      ++count_;
    }
    return entry.vertex;
  }

 private:
  struct Entry {
    std::uint32_t mesh = kNone, vertex = kNone;
    Corner corner{};
  };
  std::size_t slot_of(std::uint32_t mesh, const Corner& corner) const {
    const auto pair = [](std::uint64_t a, std::uint32_t b) { return a << 32 | b; };
    const std::uint64_t hash = scatter(scatter(pair(corner[0], corner[1])) ^ pair(corner[2], mesh));
    const std::size_t mask = slots_.size() - 1;
    std::size_t slot = hash & mask;
    while (slots_[slot].vertex != kNone &&
           (slots_[slot].corner != corner || slots_[slot].mesh != mesh)) {
      slot = (slot + 1) & mask;
    }
    return slot;
  }
  void grow() {
    std::vector<Entry> old(std::max<std::size_t>(1024, 2 * slots_.size()));
    std::swap(old, slots_);
    for (const Entry& entry : old) {
      if (entry.vertex != kNone) slots_[slot_of(entry.mesh, entry.corner)] = entry;
    }
  }

  std::vector<Entry> slots_;
  std::size_t count_ = 0;
};

// A backslash at the end of a line continues it; blanks instead leave one long line.
void join_continued_lines(std::string& text) {
  for (std::size_t i = text.find('\\'); i != std::string::npos; i = text.find('\\', i + 1)) {
    std::size_t end = i + 1;
    while (end < text.size() && text[end] == '\r') ++end;
    if (end < text.size() && text[end] == '\n') std::fill(&text[i], &text[end] + 1, ' ');
  }
}

// A line that is neither a vertex nor a face, and stands before a face of its range.
struct Command {
  enum Kind : std::uint8_t { library, material } kind;
  std::uint64_t faces_before;
  std::string name;
};

// What is in a range besides faces, and how many of those.
struct ObjRange {
  std::uint64_t lines = 0;
  Counts counts{};
  std::vector<glm::vec3> positions, normals;
  std::vector<glm::vec4> colours;  // of positions, as many as the last that has one
  std::vector<glm::vec2> uvs;
  geometry::Box3d box;  // of positions, in double precision
  std::vector<Command> commands;
  std::uint64_t faces = 0, left_out = 0, free_forms = 0;
};

// The faces of a range, where they are not all triangles of positions.
struct ObjFaces {
  std::vector<Corner> corners;
  std::vector<std::uint32_t> sizes;
};

bool is_end(const char* at, const char* end) { return at == end || *at == ' ' || *at == '\t'; }

const char* skip_blanks(const char* at, const char* end) {
  while (at != end && (*at == ' ' || *at == '\t')) ++at;
  return at;
}

// Three numbers and nothing else, which is what most lines of vertices are.
bool read_three(std::string_view words, glm::dvec3& p) {
  const char *at = words.data(), *const end = at + words.size();
  for (int k = 0; k < 3; ++k) {
    at = files::read_short_decimal(skip_blanks(at, end), end, p[k]);
    if (at == nullptr || !is_end(at, end)) return false;
  }
  return skip_blanks(at, end) == end && wrong_with(p) == nullptr;
}

// Three whole numbers of 1 to `most` and nothing else, which is what most faces are. Less one.
bool read_triangle(std::string_view words, std::uint64_t most, std::uint32_t* corners) {
  const char *at = words.data(), *const end = at + words.size();
  for (int k = 0; k < 3; ++k) {
    constexpr std::ptrdiff_t kMostDigits = 18;
    const char* const first = at = skip_blanks(at, end);
    std::uint64_t index = 0;
    for (; at != end && static_cast<unsigned>(*at - '0') < 10; ++at) {
      index = index * 10 + static_cast<unsigned>(*at - '0');
    }
    if (at - first > kMostDigits || index == 0 || index > most || !is_end(at, end)) return false;
    corners[k] = static_cast<std::uint32_t>(index - 1);
  }
  return skip_blanks(at, end) == end;
}

class ObjReader {
 public:
  explicit ObjReader(const Source& source)
      : source_(source),
        bytes_(source.bytes()),
        lines_(bytes_, 0, kRangeBytes, '\\'),
        ranges_(lines_.ranges()),
        textures_(source, scene_.textures) {}

  Scene run() {
    for_each_block(ranges_.size(), [&](std::size_t i) { read_vertices(i, glm::dvec3(0)); });
    for (const ObjRange& range : ranges_) {
      for (const Command& command : range.commands) {
        if (command.kind == Command::library) read_materials(command.name);
      }
    }
    join_vertices();
    count_lines();
    if (!read_triangles()) read_faces();
    if (scene_.meshes.empty()) source_.fail("", kNoTriangles);
    if (left_out_ > 0) source_.warn(std::to_string(left_out_) + " points and lines left out");
    if (free_forms_ > 0) {
      source_.warn(std::to_string(free_forms_) + " free-form curves and surfaces left out");
    }
    for (std::uint32_t m = 0; m < scene_.meshes.size(); ++m) {
      Mesh& mesh = scene_.meshes[m];
      normalize_or_clear(mesh.normals);
      weld(mesh);
      scene_.instances.push_back({m, glm::mat4x3(1.0F)});
    }
    return std::move(scene_);
  }

 private:
  static constexpr std::uint64_t kRangeBytes = std::uint64_t{1} << 19;  // some milliseconds

  static std::size_t kind_of(std::string_view key) {
    return static_cast<std::size_t>(std::find(kKeys.begin(), kKeys.end(), key) - kKeys.begin());
  }

  std::string_view text_of(std::size_t range, std::string& buffer) const {
    const std::string_view text = lines_.read(range, buffer);
    if (text.find('\\') == text.npos) return text;
    std::string joined(text);
    join_continued_lines(joined);
    buffer = std::move(joined);
    return buffer;
  }

  // The number of lines before a range; reads them again, for messages.
  std::uint64_t lines_before(std::size_t range) const {
    std::uint64_t before = 0;
    for (std::size_t i = 0; i < range; ++i) {
      std::string buffer;
      std::string_view line;
      Lines lines(text_of(i, buffer));
      while (lines.next(line)) {
      }
      before += lines.number();
    }
    return before;
  }

  // Calls f(lines) for the lines of a range, of which the numbers in messages are right although
  // they are not known: then the range is read once more.
  template <class F>
  void with_lines(std::size_t range, F&& f) const {
    std::string buffer;
    const std::string_view text = text_of(range, buffer);
    try {
      f(Lines(text));
    } catch (const files::FileError& error) {
      if (error.cause() == files::Cause::memory) throw;
      f(Lines(text, lines_before(range)));
      throw;
    }
  }

  // Relative to the origin.
  void read_vertices(std::size_t number, const glm::dvec3& origin) {
    with_lines(number, [&](Lines lines) {
      ObjRange& range = ranges_[number] = ObjRange();
      GrowthWatch watch(source_);
      const std::uint64_t before = lines.number();
      std::string_view line;
      while (lines.next(line)) {
        watch.step();
        if (line.starts_with("v ")) {
          glm::dvec3 p;
          if (read_three(line.substr(2), p)) {
            add_position(p, origin, range);
            continue;
          }
        }
        Words words(line);
        read_vertex(words.next(), words, lines, origin, range);
      }
      range.lines = lines.number() - before;
      range.counts = {static_cast<std::int64_t>(range.positions.size()),
                      static_cast<std::int64_t>(range.uvs.size()),
                      static_cast<std::int64_t>(range.normals.size())};
    });
  }

  static void add_position(const glm::dvec3& p, const glm::dvec3& origin, ObjRange& range) {
    range.box.include(p);
    if (range.positions.empty()) range.positions.reserve(kRangeBytes / 8);  // "v 0 0 0\n"
    range.positions.emplace_back(p - origin);
  }

  void read_vertex(std::string_view key, Words& words, const Lines& lines, const glm::dvec3& origin,
                   ObjRange& range) const {
    if (key == "v") {
      add_position(read_coordinates<3>(source_, lines, words), origin, range);
      read_vertex_colour(words, range);
    } else if (key == "vt") {
      const float u = static_cast<float>(read_coordinates<1>(source_, lines, words).x);
      const bool has_v = !Words(words).next().empty();
      const double v = has_v ? read_coordinates<1>(source_, lines, words).x : 0;
      range.uvs.emplace_back(u, 1 - v);  // v of OBJ grows upwards
    } else if (key == "vn") {
      range.normals.emplace_back(read_coordinates<3>(source_, lines, words));
    } else if (key == "f") {
      ++range.faces;
    } else if (key == "mtllib") {
      range.commands.push_back({Command::library, range.faces, std::string(words.rest())});
    } else if (key == "usemtl") {
      range.commands.push_back({Command::material, range.faces, std::string(words.rest())});
    } else if (key == "l" || key == "p") {
      ++range.left_out;
    } else if (key == "curv" || key == "curv2" || key == "surf") {
      ++range.free_forms;
    }
  }

  // Three more numbers are a colour; one is a weight, which polygons do not use.
  static void read_vertex_colour(Words words, ObjRange& range) {
    glm::dvec4 colour(1);
    for (int k = 0; k < 3; ++k) {
      if (!parse(words.next(), colour[k])) return;
    }
    range.colours.resize(range.positions.size() - 1, glm::vec4(1));
    range.colours.push_back(linear_colour(colour));
  }

  // Puts the vertices of all ranges behind each other, relative to the origin.
  void join_vertices() {
    geometry::Box3d box;
    for (const ObjRange& range : ranges_) box.include(range.box);
    scene_.origin = origin_of(box);
    // Far from 0 they are coarse so far.
    if (scene_.origin != glm::dvec3(0)) {
      for_each_block(ranges_.size(), [&](std::size_t i) { read_vertices(i, scene_.origin); });
    }
    bool colours = false;
    before_.assign(1, Counts{});
    for (const ObjRange& range : ranges_) {
      colours |= !range.colours.empty();
      before_.push_back(before_.back());
      for (std::size_t k = 0; k < kKeys.size(); ++k) before_.back()[k] += range.counts[k];
    }
    all_ = before_.back();
    if (*std::ranges::max_element(all_) >= std::int64_t{kNone}) {
      source_.fail("", "a mesh is too large");
    }
    source_.require_memory(static_cast<std::uint64_t>(all_[0]) * sizeof(glm::vec3));
    parallel::grow(positions_, static_cast<std::size_t>(all_[0]));
    parallel::grow(uvs_, static_cast<std::size_t>(all_[1]));
    parallel::grow(normals_, static_cast<std::size_t>(all_[2]));
    if (colours) colours_.resize(positions_.size(), glm::vec4(1));
    parallel::parallel_for(0, ranges_.size(), 1, [&](std::size_t i) {
      move_to(ranges_[i].positions, before_[i][0], positions_);
      move_to(ranges_[i].colours, before_[i][0], colours_);
      move_to(ranges_[i].uvs, before_[i][1], uvs_);
      move_to(ranges_[i].normals, before_[i][2], normals_);
    });
  }

  template <class T>
  static void move_to(std::vector<T>& from, std::int64_t at, std::vector<T>& to) {
    if (!from.empty()) std::ranges::copy(from, to.begin() + at);
    std::vector<T>().swap(from);
  }

  void count_lines() {
    for (const ObjRange& range : ranges_) {
      faces_before_.push_back(faces_);
      faces_ += range.faces;
      left_out_ += range.left_out;
      free_forms_ += range.free_forms;
    }
  }

  // Each file once, however often it is named.
  void read_materials(std::string_view name) {
    if (name.empty() || !named_.emplace(name).second) return;
    try {
      const std::filesystem::path path = source_.resolve(std::string(name));
      if (!libraries_.insert(path).second) return;
      const std::string content = files::read_file(path, source_.memory);
      for (Material& material : read_mtl(content, textures_)) {
        const auto number = static_cast<std::uint32_t>(scene_.materials.size());
        materials_.try_emplace(material.name, number);
        scene_.materials.push_back(std::move(material));
      }
    } catch (const files::FileError& e) {
      if (e.cause() == files::Cause::memory) throw;
      source_.warn(e.what());
    }
  }

  // Unknown ones are plain.
  std::uint32_t material_named(std::string_view name) {
    const auto [entry, is_new] = materials_.try_emplace(
        std::string(name), static_cast<std::uint32_t>(scene_.materials.size()));
    if (is_new) {
      scene_.materials.push_back(plain_material(!colours_.empty()));
      scene_.materials.back().name = name;
    }
    return entry->second;
  }

  // Where faces are triangles of one material with positions alone. False where they are not, or
  // where something is wrong, of which whoever reads line by line tells what.
  bool read_triangles() {
    if (faces_ == 0 || faces_ > kNone / 3 || all_[1] > 0 || all_[2] > 0) return false;
    std::optional<std::string> name;
    for (std::size_t i = 0; i < ranges_.size(); ++i) {
      for (const Command& command : ranges_[i].commands) {
        if (command.kind == Command::library) continue;
        if (name || faces_before_[i] + command.faces_before > 0) return false;
        name = command.name;
      }
    }
    source_.require_memory(faces_ * sizeof(glm::uvec3) + positions_.size() * sizeof(std::uint32_t));
    std::vector<glm::uvec3> triangles;
    parallel::grow(triangles, faces_);
    std::atomic<bool> good{true};
    parallel::parallel_for(0, ranges_.size(), 1, [&](std::size_t i) {
      if (good && !read_triangles(i, triangles.data() + faces_before_[i])) good = false;
    });
    if (!good) return false;
    const std::uint32_t material = material_named(name.value_or(""));
    Mesh& mesh = scene_.meshes[mesh_of(material, false)];
    mesh.triangles = std::move(triangles);
    mesh.positions = std::move(positions_);
    mesh.colours = std::move(colours_);
    number_by_first_corner(mesh);
    return true;
  }

  bool read_triangles(std::size_t range, glm::uvec3* to) const {
    std::string buffer;
    std::string_view line;
    const auto most = static_cast<std::uint64_t>(all_[0]);
    for (Lines lines(text_of(range, buffer)); lines.next(line);) {
      if (line.starts_with("f ")) {
        if (!read_triangle(line.substr(2), most, &to->x)) return false;
        ++to;
      } else if (!line.starts_with("v ") && Words(line).next() == "f") {
        return false;
      }
    }
    return true;
  }

  // Numbers vertices by their first corners and drops those that are none.
  static void number_by_first_corner(Mesh& mesh) {
    constexpr std::size_t kBlock = 1 << 14;  // triangles: some ten microseconds
    std::vector<std::uint32_t> number(mesh.positions.size(), kNone);
    parallel::parallel_for(0, mesh.triangles.size(), kBlock, [&](std::size_t t) {
      for (int k = 0; k < 3; ++k) {
        const auto corner = static_cast<std::uint32_t>(3 * t) + static_cast<std::uint32_t>(k);
        std::atomic_ref<std::uint32_t> first(number[mesh.triangles[t][k]]);
        std::uint32_t held = first.load(std::memory_order_relaxed);
        while (corner < held &&
               !first.compare_exchange_weak(held, corner, std::memory_order_relaxed)) {
        }
      }
    });
    // How many first corners there are before each block.
    const std::size_t count = mesh.triangles.size(), blocks = (count + kBlock - 1) / kBlock;
    std::vector<std::uint32_t> before(blocks + 1, 0);
    const auto for_first_corners = [&](std::size_t block, auto&& f) {
      for (std::size_t t = block * kBlock; t < std::min(count, (block + 1) * kBlock); ++t) {
        for (int k = 0; k < 3; ++k) {
          const std::uint32_t v = mesh.triangles[t][k];
          if (number[v] == 3 * t + static_cast<std::size_t>(k)) f(v);
        }
      }
    };
    parallel::parallel_for(0, blocks, 1, [&](std::size_t b) {
      for_first_corners(b, [&](std::uint32_t) { ++before[b + 1]; });
    });
    std::partial_sum(before.begin(), before.end(), before.begin());
    std::vector<std::uint32_t> order(before.back());
    parallel::parallel_for(0, blocks, 1, [&](std::size_t b) {
      std::uint32_t next = before[b];
      for_first_corners(b, [&](std::uint32_t v) { order[next++] = v; });
    });
    parallel::parallel_for(0, order.size(), kBlock, [&](std::size_t i) {
      number[order[i]] = static_cast<std::uint32_t>(i);
    });
    const auto used = order.size();
    std::vector<std::uint32_t>().swap(order);
    parallel::parallel_for(0, count, kBlock, [&](std::size_t t) {
      for (int k = 0; k < 3; ++k) mesh.triangles[t][k] = number[mesh.triangles[t][k]];
    });
    put_in_place(number, used, mesh);
  }

  // Gives each vertex its number, by swaps along the cycles of the permutation: there is no room
  // for the vertices twice.
  static void put_in_place(std::vector<std::uint32_t>& number, std::size_t used, Mesh& mesh) {
    auto next = static_cast<std::uint32_t>(used);
    for (std::uint32_t& n : number) {
      if (n == kNone) n = next++;
    }
    for (std::uint32_t i = 0; i < number.size(); ++i) {
      while (number[i] != i) {
        const std::uint32_t to = number[i];
        std::swap(mesh.positions[i], mesh.positions[to]);
        if (!mesh.colours.empty()) std::swap(mesh.colours[i], mesh.colours[to]);
        std::swap(number[i], number[to]);
      }
    }
    mesh.positions.resize(used);
    if (!mesh.colours.empty()) mesh.colours.resize(used);
  }

  void read_faces() {
    std::vector<ObjFaces> faces(ranges_.size());
    for_each_block(ranges_.size(), [&](std::size_t i) {
      with_lines(i, [&](Lines lines) { read_faces(i, lines, faces[i] = ObjFaces()); });
    });
    std::uint32_t material = kNone;
    for (std::size_t i = 0; i < faces.size(); ++i) {
      auto command = ranges_[i].commands.begin();
      const auto run_commands = [&](std::uint64_t face) {
        for (; command != ranges_[i].commands.end() && command->faces_before <= face; ++command) {
          if (command->kind == Command::material) material = material_named(command->name);
        }
      };
      Corner* corner = faces[i].corners.data();
      for (std::size_t face = 0; face < faces[i].sizes.size(); ++face) {
        run_commands(face);
        const std::uint32_t size = faces[i].sizes[face];
        if (size < 3) {
          ++left_out_;
        } else {
          if (material == kNone) material = material_named("");
          add_face(material, {corner, size});
        }
        corner += size;
      }
      run_commands(ranges_[i].faces);
      faces[i] = {};
    }
  }

  void read_faces(std::size_t range, Lines& lines, ObjFaces& faces) const {
    GrowthWatch watch(source_);
    Counts before = before_[range];
    std::string_view line;
    while (lines.next(line)) {
      watch.step();
      Words words(line);
      const std::string_view key = words.next();
      if (const std::size_t kind = kind_of(key); kind < kKeys.size()) {
        ++before[kind];
      } else if (key == "f") {
        const std::size_t size = faces.corners.size();
        for (std::string_view word = words.next(); !word.empty() && word.front() != '#';
             word = words.next()) {
          watch.step();
          faces.corners.push_back(read_corner(lines, word, before));
        }
        faces.sizes.push_back(static_cast<std::uint32_t>(faces.corners.size() - size));
      }
    }
  }

  // position/texture/normal, each counted from 1 or, if negative, back from the line.
  Corner read_corner(const Lines& lines, std::string_view corner, const Counts& before) const {
    Corner result = {kNone, kNone, kNone};
    for (std::size_t part = 0; part < 3 && !corner.empty(); ++part) {
      const std::string_view word = corner.substr(0, corner.find('/'));
      corner.remove_prefix(std::min(corner.size(), word.size() + 1));
      if (word.empty() && part > 0) continue;
      std::int64_t index = 0;
      if (!parse(word, index)) {
        source_.fail(lines.place(), "'" + std::string(word.substr(0, 40)) + "' is not an index");
      }
      if (index == 0 || index > all_[part] || index < -before[part]) {
        source_.fail(lines.place(), "there is no " + std::string(kWhat[part]) + " " +
                                        std::to_string(index) + " (" +
                                        std::to_string(index < 0 ? before[part] : all_[part]) +
                                        (index < 0 ? " so far)" : " in all)"));
      }
      result[part] = static_cast<std::uint32_t>(index < 0 ? before[part] + index : index - 1);
    }
    if (!corner.empty()) source_.fail(lines.place(), "a corner has too many parts");
    return result;
  }

  std::uint32_t mesh_of(std::uint32_t material, bool has_normals) {
    const std::size_t key = std::size_t{material} * 2 + (has_normals ? 1 : 0);
    if (key >= meshes_.size()) meshes_.resize(2 * scene_.materials.size(), kNone);
    if (meshes_[key] == kNone) {
      meshes_[key] = static_cast<std::uint32_t>(scene_.meshes.size());
      Mesh& mesh = scene_.meshes.emplace_back();
      mesh.name = scene_.materials[material].name;
      mesh.material = material;
    }
    return meshes_[key];
  }

  void add_face(std::uint32_t material, std::span<Corner> corners) {
    const bool has_normals =
        std::all_of(corners.begin(), corners.end(), [](const Corner& c) { return c[2] != kNone; });
    const std::uint32_t number = mesh_of(material, has_normals);
    Mesh& mesh = scene_.meshes[number];
    polygon_.clear();
    for (Corner& corner : corners) {
      watch_.step();
      if (!has_normals) corner[2] = kNone;
      if (mesh.positions.size() >= kNone) source_.fail("", "a mesh is too large");
      const auto next = static_cast<std::uint32_t>(mesh.positions.size());
      polygon_.push_back(table_.find(number, corner, next));
      if (polygon_.back() == next) add_vertex(corner, mesh);
    }
    triangulate_polygon(polygon_, mesh.positions, mesh.triangles);
  }

  void add_vertex(const Corner& corner, Mesh& mesh) const {
    mesh.positions.push_back(positions_[corner[0]]);
    if (!colours_.empty()) mesh.colours.push_back(colours_[corner[0]]);
    if (corner[2] != kNone) mesh.normals.push_back(normals_[corner[2]]);
    // Vertices before the first with texture coordinates, and those without, have 0.
    if (corner[1] == kNone && mesh.uvs.empty()) return;
    mesh.uvs.resize(mesh.positions.size() - 1, glm::vec2(0));
    mesh.uvs.push_back(corner[1] == kNone ? glm::vec2(0) : uvs_[corner[1]]);
  }

  const Source& source_;
  files::FileBytes bytes_;
  files::LineRanges lines_;
  std::vector<ObjRange> ranges_;
  std::vector<Counts> before_;               // of v, vt and vn, before each range
  std::vector<std::uint64_t> faces_before_;  // of faces
  GrowthWatch watch_{source_};
  Scene scene_;
  TextureFiles textures_;
  std::map<std::string, std::uint32_t, std::less<>> materials_;  // numbers by name
  std::set<std::string, std::less<>> named_;                     // by mtllib
  std::set<std::filesystem::path> libraries_;                    // that were
  std::vector<glm::vec3> positions_, normals_;
  std::vector<glm::vec4> colours_;  // of positions, if any has one
  std::vector<glm::vec2> uvs_;
  Counts all_{};
  std::vector<std::uint32_t> meshes_;  // numbers by material and normals
  CornerTable table_;
  std::vector<std::uint32_t> polygon_;  // vertices of a face
  std::uint64_t faces_ = 0, left_out_ = 0, free_forms_ = 0;
};

}  // namespace

Scene read_obj(const Source& source) { return ObjReader(source).run(); }

}  // namespace delray::scenes::internal
