// The formats that are read, as their readers' tables have them.
#include "apps/options/formats.h"

#include <fmt/format.h>

#include "apps/options/list.h"
#include "delaunay/read_mesh.h"
#include "delaunay/read_points.h"
#include "files/format.h"
#include "scenes/load.h"

namespace delray::apps {
namespace {

std::string joined_names(const auto& readers) {
  std::string list;
  for (const auto& reader : readers) list += (list.empty() ? "" : ", ") + std::string(reader.name);
  return list;
}

std::vector<NameAndDescription> described(const auto& readers) {
  std::vector<NameAndDescription> entries;
  for (const auto& reader : readers) {
    entries.push_back({std::string(reader.name),
                       fmt::format("{} ({})", reader.description, files::suffixes(reader.format))});
  }
  return entries;
}

}  // namespace

void list_formats() {
  print_list("Scenes", described(scenes::scene_readers()));
  std::vector<NameAndDescription> points;
  for (const delaunay::PointReader& reader : delaunay::point_readers()) {
    points.push_back(
        {std::string(reader.name), fmt::format("{} ({})", reader.description, reader.suffixes)});
  }
  print_list("Points", points);
  print_list("Meshes, whose coordinates are kept exactly", described(delaunay::mesh_readers()));
  print_list("Packs", {{"pack", fmt::format("scene in pages, written by delray pack ({})",
                                            files::suffixes(files::Format::pack))}});
  print_list("Pictures", {{"picture", fmt::format("elevations, textures, layers to compose ({})",
                                                  files::suffixes(files::Format::image))}});
}

std::string format_names() {
  return fmt::format("scene ({}), points ({}), mesh ({}), pack ({}) or picture ({})",
                     joined_names(scenes::scene_readers()), joined_names(delaunay::point_readers()),
                     joined_names(delaunay::mesh_readers()), files::suffixes(files::Format::pack),
                     files::suffixes(files::Format::image));
}

}  // namespace delray::apps
