// The format of a file: by its content, then by its suffix.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "files/memory_budget.h"

namespace delray::files {

// The formats that the readers and writers of all layers know.
enum class Format {
  unknown,
  ply,
  obj,
  off,
  stl,
  gltf,  // JSON
  glb,   // binary glTF
  las,
  pcd,  // of the Point Cloud Library
  vtu,
  node,         // points of Triangle and TetGen; the suffix .ele names the pair as well
  poly,         // points and segments of Triangle
  json_points,  // [[x, y(, z)], ...]
  text,         // rows of numbers: xyz, csv, txt ...
  pack,         // a scene in pages
  image,        // anything that OpenImageIO might read
};

// The sign that a format is known by: a suffix, in lower case with its dot, or the bytes that its
// files begin with.
struct FormatSign {
  std::string_view text;
  Format format;
};
// The usual suffix of a format comes first.
inline constexpr std::array kFormatSuffixes = {
    FormatSign{".ply", Format::ply},          FormatSign{".obj", Format::obj},
    FormatSign{".off", Format::off},          FormatSign{".stl", Format::stl},
    FormatSign{".gltf", Format::gltf},        FormatSign{".glb", Format::glb},
    FormatSign{".las", Format::las},          FormatSign{".laz", Format::las},
    FormatSign{".pcd", Format::pcd},          FormatSign{".vtu", Format::vtu},
    FormatSign{".node", Format::node},        FormatSign{".ele", Format::node},
    FormatSign{".poly", Format::poly},        FormatSign{".xyz", Format::text},
    FormatSign{".json", Format::json_points}, FormatSign{".csv", Format::text},
    FormatSign{".txt", Format::text},         FormatSign{".pts", Format::text},
    FormatSign{".asc", Format::text},         FormatSign{".tsv", Format::text},
    FormatSign{".png", Format::image},        FormatSign{".jpg", Format::image},
    FormatSign{".jpeg", Format::image},       FormatSign{".tif", Format::image},
    FormatSign{".tiff", Format::image},       FormatSign{".exr", Format::image},
    FormatSign{".hdr", Format::image},        FormatSign{".bmp", Format::image},
    FormatSign{".tga", Format::image},        FormatSign{".pgm", Format::image},
    FormatSign{".ppm", Format::image},        FormatSign{".webp", Format::image},
    FormatSign{".pack", Format::pack},
};

// Formats without a mark of their own are recognized by what they hold.
inline constexpr std::array kFormatStarts = {
    FormatSign{"LASF", Format::las},
    FormatSign{"glTF", Format::glb},
    FormatSign{"DELRAYPK", Format::pack},
    FormatSign{"# .PCD", Format::pcd},
    FormatSign{"\x89PNG", Format::image},
    FormatSign{"\xff\xd8\xff", Format::image},
    FormatSign{std::string_view("II*\0", 4), Format::image},
    FormatSign{std::string_view("MM\0*", 4), Format::image},
    FormatSign{std::string_view("II+\0", 4), Format::image},
    FormatSign{std::string_view("MM\0+", 4), Format::image},
    FormatSign{"\x76\x2f\x31\x01", Format::image},
    FormatSign{"#?RADIANCE", Format::image},
    FormatSign{"#?RGBE", Format::image},
};

// The lower-case usual suffix without the dot ("ply"), or "unknown".
std::string_view name(Format format);

// A format, and whether the file holds a surface or bare points.
struct FileKind {
  Format format = Format::unknown;
  // PLY, OBJ and OFF hold bare points as well as meshes; true if this one has at least one face.
  // True for the formats that are always meshes or scenes, false for all others.
  bool has_faces = false;
  // Whether an OBJ, OFF, STL or PLY says that delray wrote it: its points lie over x and y.
  bool by_delray = false;
};

// The comment, or header of an STL, in files that Delray wrote, which says too which way is up.
inline constexpr std::string_view kWrittenByDelray = "written by delray; up: z";
// The axis that a comment of an OBJ, OFF or PLY, or the header of an STL, calls up ("up: y"); 0 if
// none does. O(1): in the first kilobytes.
char up_axis(std::string_view start);

// Finds out what a file is from its first bytes and, where they do not tell, from the suffix of
// `path`. A file whose content no format claims keeps the format of its suffix, so that the reader
// of that format can say what is wrong with it. `size` is the size of the whole file (binary STL
// has no other mark). `has_faces` of an OBJ is what `start` shows. Throws FileError (input) for
// text in UTF-16. O(start).
FileKind identify(std::string_view start, std::uint64_t size, const std::filesystem::path& path);

// Identifies a file or stream: reads its first megabyte, and as much of an OBJ as is needed to
// find a face. Throws FileError (input) if it cannot be read.
FileKind identify(const std::filesystem::path& path, const MemoryBudget& memory = {});

// The format alone: what identify(path) finds, without looking for faces.
Format identify_format(const std::filesystem::path& path, const MemoryBudget& memory = {});

// The suffixes of a format: ".las .laz".
std::string suffixes(Format format);

// The format that a suffix stands for, by itself; `unknown` for none that is known.
Format format_of_suffix(const std::filesystem::path& path);

}  // namespace delray::files
