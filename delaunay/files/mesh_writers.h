// The writers that the tables of write_mesh.h and write_points.h are made of, one file each.
#pragma once

#include <filesystem>
#include <string>

#include "delaunay/write_mesh.h"

namespace delray::delaunay {

// Bare points are meshes without simplices to all of these.
void write_ply(const std::filesystem::path& path, const MeshView& mesh);
void write_obj(const std::filesystem::path& path, const MeshView& mesh);
void write_off(const std::filesystem::path& path, const MeshView& mesh);
void write_stl(const std::filesystem::path& path, const MeshView& mesh);
void write_vtu(const std::filesystem::path& path, const MeshView& mesh);
// Writes X.node and X.ele, whichever of them `path` names.
void write_node(const std::filesystem::path& path, const MeshView& mesh);

// The suffixes of a table of writers, as messages name them.
template <class Writers>
std::string known_suffixes(const Writers& writers) {
  std::string list;
  for (const auto& writer : writers) {
    list += (list.empty() ? "" : " ") + std::string(writer.suffixes);
  }
  return list;
}

// Points alone.
void write_node_points(const std::filesystem::path& path, const PointCloud& points);
void write_xyz(const std::filesystem::path& path, const PointCloud& points);
void write_csv(const std::filesystem::path& path, const PointCloud& points);
void write_json(const std::filesystem::path& path, const PointCloud& points);

}  // namespace delray::delaunay
