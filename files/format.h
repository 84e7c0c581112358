// What kind of file a file is: by its content, then by its suffix.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "files/memory_budget.h"

namespace delray::files {

enum class Format {
  unknown,
  ply,
  obj,
  off,
  stl,
  gltf,  // JSON
  glb,   // binary glTF
  las,
  vtu,
  node,         // points of Triangle and TetGen; the suffix .ele names the pair as well
  json_points,  // [[x, y(, z)], ...]
  text,         // rows of numbers: xyz, csv, txt ...
  image,        // anything that OpenImageIO might read
};

// The lower-case usual suffix without the dot ("ply"), or "unknown".
std::string_view name(Format format);

struct FileKind {
  Format format = Format::unknown;
  // PLY, OBJ and OFF hold bare points as well as meshes; true if this one has at least one face.
  // True for the formats that are always meshes or scenes, false for all others.
  bool has_faces = false;
};

// Finds out what a file is from its first bytes and, where they do not tell, from the suffix of
// `path`. A file whose content no format claims keeps the format of its suffix, so that the reader
// of that format can say what is wrong with it. `size` is the size of the whole file (binary STL
// has no other mark). `has_faces` of an OBJ is what `start` shows. O(start).
FileKind identify(std::string_view start, std::uint64_t size, const std::filesystem::path& path);

// The same for a file or stream: reads its first megabyte, and as much of an OBJ as is needed to
// find a face. Throws FileError (input) if it cannot be read.
FileKind identify(const std::filesystem::path& path, const MemoryBudget& memory = {});

// The format alone: what identify(path) finds, without looking for faces.
Format identify_format(const std::filesystem::path& path, const MemoryBudget& memory = {});

// The suffixes of a format: ".las .laz".
std::string suffixes(Format format);

// The format that a suffix stands for, by itself; `unknown` for none that is known.
Format format_of_suffix(const std::filesystem::path& path);

}  // namespace delray::files
