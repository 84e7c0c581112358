// Options of outputs, and the way of a triangulation to each kind of them.
#include "apps/output/triangulation_output.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstring>
#include <utility>
#include <vector>

#include "apps/input/point_choice.h"
#include "apps/options/help.h"
#include "apps/options/list.h"
#include "apps/options/outputs.h"
#include "apps/output/raster_output.h"
#include "delaunay/terrain_raster.h"
#include "delaunay/triangulation_pieces.h"
#include "delaunay/write_mesh.h"
#include "files/format.h"
#include "files/output_path.h"

namespace delray::apps {
namespace {

constexpr const char* kNaturalNeighbour = "natural-neighbour";

bool is_raster_name(const std::string& path) {
  constexpr std::array kSuffixes = {".tif", ".tiff"};
  return std::ranges::any_of(kSuffixes, [&](const char* suffix) { return path.ends_with(suffix); });
}

const delaunay::MeshWriter* mesh_writer_of(const std::string& path) {
  const files::Format format = files::format_of_suffix(path);
  const auto writers = delaunay::mesh_writers();
  const auto found = std::ranges::find(writers, format, &delaunay::MeshWriter::format);
  return found == writers.end() ? nullptr : &*found;
}

// Throws UsageError for a name that says nothing of what is wanted.
void require_known_name(const std::string& path) {
  if (path == "-" || mesh_writer_of(path) != nullptr) return;
  std::string suffixes;
  for (const delaunay::MeshWriter& writer : delaunay::mesh_writers()) {
    suffixes += (suffixes.empty() ? "" : " ") + std::string(writer.suffixes);
  }
  throw UsageError(
      fmt::format("-o {0}: the name ends neither as that of a mesh ({1}) nor as that of a raster "
                  "of heights (.tif); -o {0}/ writes a folder of pieces",
                  path, suffixes));
}

// Pieces and blocks that processes send to that of rank 0.
enum OutputTag : comm::Tag { kTagPieces = 1, kTagBlock, kTagWaiting };

class FolderOutput : public SimplexOutput {
 public:
  FolderOutput(const TriangulationOutput& output, const OutputFacts& facts)
      : writer_(output.path, {facts.dim, output.pieces.empty() ? "vtu" : output.pieces,
                              facts.resume, facts.writer}) {}
  delaunay::TileSink& sink() override { return writer_; }
  void keep_tiles(const std::function<bool(std::uint64_t tile)>& finished) override {
    writer_.keep_tiles(finished);
  }
  void keep_unfinished() override { writer_.keep_unfinished(); }
  void send_to_first(comm::Communicator& communicator) override {
    const std::string pieces = writer_.pieces();
    communicator.send(0, kTagPieces, comm::Buffer::of(std::span<const char>(pieces)));
  }
  void receive(comm::Communicator& communicator, int from) override {
    const comm::Buffer pieces = communicator.receive(from, kTagPieces);
    const auto text = pieces.as<char>();
    writer_.add_pieces({text.begin(), text.end()});
  }
  Json commit(const delaunay::MeshFolderWriter::Counts& counts) override {
    writer_.commit(counts);
    return nullptr;
  }

 private:
  delaunay::MeshFolderWriter writer_;
};

class FileOutput : public SimplexOutput {
 public:
  FileOutput(const TriangulationOutput& output, const OutputFacts& facts)
      : writer_(output.path, facts.file) {}
  delaunay::TileSink& sink() override { return writer_; }
  void keep_tiles(const std::function<bool(std::uint64_t tile)>&) override {}
  void keep_unfinished() override {}
  void send_to_first(comm::Communicator&) override {}
  void receive(comm::Communicator&, int) override {}
  void write(comm::Communicator& communicator,
             const delaunay::MeshFileWriter::Source& points) override {
    writer_.write(communicator, points);
  }
  Json commit(const delaunay::MeshFolderWriter::Counts&) override {
    writer_.commit();
    return nullptr;
  }

 private:
  delaunay::MeshFileWriter writer_;
};

class RasterOutput : public SimplexOutput {
 public:
  RasterOutput(const TriangulationOutput& output, const OutputFacts& facts)
      : output_(output), facts_(facts), raster_(make_raster(output, facts)) {
    if (output.interpolate == kNaturalNeighbour) smooth_.emplace(*raster_);
  }
  delaunay::TileSink& sink() override {
    if (smooth_) return *smooth_;
    return *raster_;
  }
  void keep_tiles(const std::function<bool(std::uint64_t tile)>&) override {}
  void keep_unfinished() override {}
  // A message for each block: its number, then its cells; one that is empty ends them. Then one of
  // what waits for other processes' triangles.
  void send_to_first(comm::Communicator& communicator) override {
    raster_->for_blocks([&](std::uint64_t block, std::span<const float> cells) {
      comm::Buffer message(sizeof block + cells.size_bytes());
      std::memcpy(message.data(), &block, sizeof block);
      std::memcpy(message.data() + sizeof block, cells.data(), cells.size_bytes());
      communicator.send(0, kTagBlock, std::move(message));
    });
    communicator.send(0, kTagBlock, comm::Buffer());
    if (!smooth_) return;
    const std::vector<delaunay::WaitingTriangle> waiting = smooth_->give_waiting();
    communicator.send(0, kTagWaiting,
                      comm::Buffer::of(std::span<const delaunay::WaitingTriangle>(waiting)));
  }
  void receive(comm::Communicator& communicator, int from) override {
    std::vector<float> cells(delaunay::TerrainRaster::kBlock * delaunay::TerrainRaster::kBlock);
    for (;;) {
      const comm::Buffer message = communicator.receive(from, kTagBlock);
      if (message.size() == 0) break;
      std::uint64_t block = 0;
      std::memcpy(&block, message.data(), sizeof block);
      std::memcpy(cells.data(), message.data() + sizeof block, cells.size() * sizeof(float));
      raster_->merge(block, cells);
    }
    if (!smooth_) return;
    const comm::Buffer waiting = communicator.receive(from, kTagWaiting);
    smooth_->add_waiting(waiting.as<delaunay::WaitingTriangle>());
  }
  Json commit(const delaunay::MeshFolderWriter::Counts&) override {
    if (smooth_) smooth_->finish();
    return write_raster(output_, facts_, *raster_);
  }

 private:
  TriangulationOutput output_;
  OutputFacts facts_;
  std::unique_ptr<delaunay::TerrainRaster> raster_;
  std::optional<delaunay::NaturalNeighbourRaster> smooth_;
};

OutputFacts facts_of(const PointInput& input, const delaunay::PointCloud& points, int dim) {
  OutputFacts facts;
  facts.dim = dim;
  for (const glm::dvec3& p : points.positions) facts.box.include(p);
  facts.coordinate_system = coordinate_system_of(input);
  facts.bounds = filter_of(input.choice).bounds;
  return facts;
}

}  // namespace

OutputKind TriangulationOutput::kind() const {
  if (path.empty()) return OutputKind::none;
  if (path == "-") return OutputKind::file;
  if (path.ends_with('/')) return OutputKind::folder;
  // A folder that is called as a file is none of ours, unless it is written with a slash.
  if (is_raster_name(path)) return OutputKind::raster;
  if (mesh_writer_of(path) != nullptr) return OutputKind::file;
  return delaunay::names_folder(path) ? OutputKind::folder : OutputKind::file;
}

bool TriangulationOutput::takes_parts(int dim) const {
  return kind() != OutputKind::file || delaunay::can_write_in_parts(path, dim);
}

delaunay::SinkDiskUse TriangulationOutput::disk_use(int dim) const {
  delaunay::SinkDiskUse use;
  if (kind() == OutputKind::folder) {
    use.folder = std::filesystem::absolute(files::output_folder(path)).parent_path();
    use.result_bytes =
        delaunay::MeshFolderWriter::bytes_of_point(pieces.empty() ? "vtu" : pieces, dim);
  } else if (kind() == OutputKind::file && path != "-") {
    const files::OutputPath target = files::output_path(path);
    const delaunay::MeshFileBytes bytes = delaunay::mesh_file_bytes_of_point(path, dim);
    if (!target.in_place) {
      use = {std::filesystem::absolute(target.path).parent_path(), bytes.file, bytes.scratch};
    }
  }
  return use;
}

void add_output_options(CLI::App& command, TriangulationOutput& output) {
  command
      .add_option("-o,--output", output.path,
                  "Mesh to write: .ply, .obj, .off, .stl, .vtu or .node; - for PLY on standard "
                  "output; a name that ends in / for a folder of pieces; .tif for the heights of a "
                  "terrain as a GeoTIFF, a cell of --cell-size each")
      ->type_name("FILE")
      ->group(group::kOutput);
  command
      .add_option(
          "--pieces", output.pieces,
          "Format of a folder's pieces: vtu (default), with a .pvtu that names them, or ply")
      ->group(group::kOutput);
  choose_from(command, "--pieces", names_in(delaunay::piece_formats()));
  command
      .add_option("--interpolate", output.interpolate,
                  "Heights of a .tif: linear in each triangle (default) or natural-neighbour, "
                  "which is smooth")
      ->group(group::kOutput);
  choose_from(command, "--interpolate", {"linear", kNaturalNeighbour});
}

void check_output(TriangulationOutput& output, PointInput& input, int dim) {
  const OutputKind kind = output.kind();
  if (kind == OutputKind::file) require_known_name(output.path);
  if (!output.pieces.empty() && kind != OutputKind::folder) {
    throw UsageError("--pieces: only a folder has pieces (-o FOLDER/)");
  }
  if (output.pieces == "ply" && dim == 3) {
    throw UsageError("--pieces ply: PLY has triangles only; tetrahedra are in pieces of vtu");
  }
  if (!output.interpolate.empty() && kind != OutputKind::raster) {
    throw UsageError("--interpolate: only a raster has heights between points (-o FILE.tif)");
  }
  if (kind != OutputKind::raster) return;
  if (dim != 2)
    throw UsageError("-o " + output.path + ": a raster is of terrains, which are --dim 2");
  if (input.cell_size == 0) throw UsageError("-o " + output.path + ": --cell-size is missing");
  output.cell_size = std::exchange(input.cell_size, 0);
}

void check_output_paths(const TriangulationOutput& output, const std::string& statistics,
                        const std::vector<std::string>& inputs) {
  if (output.kind() != OutputKind::folder) {
    return check_outputs({{"-o", output.path}, {"--stats", statistics}}, inputs);
  }
  check_outputs({{"--stats", statistics}}, inputs);
  // Whether an existing folder may be replaced is for its writer.
  [[maybe_unused]] const auto folder = files::output_folder(output.path);
}

void check_output_of(const TriangulationOutput& output, const PointInput& input,
                     const delaunay::PointCloud& points) {
  if (output.kind() != OutputKind::raster) return;
  if (!points.has_z) throw UsageError("-o " + output.path + ": " + input.path + " has no z");
  raster_grid_of(output, facts_of(input, points, 2));
}

std::unique_ptr<SimplexOutput> open_simplex_output(const TriangulationOutput& output,
                                                   const OutputFacts& facts) {
  if (output.kind() == OutputKind::folder) return std::make_unique<FolderOutput>(output, facts);
  if (output.kind() == OutputKind::file) return std::make_unique<FileOutput>(output, facts);
  return std::make_unique<RasterOutput>(output, facts);
}

Json write_triangulation(const TriangulationOutput& output, const PointInput& input,
                         const delaunay::PointCloud& points, const delaunay::Triangulation& result,
                         std::span<const std::uint16_t> created_by) {
  const OutputKind kind = output.kind();
  if (kind == OutputKind::none) return nullptr;
  if (kind == OutputKind::file) {
    write_mesh(output.path, points, result, created_by);
    return nullptr;
  }
  const OutputFacts facts = facts_of(input, points, result.dim);
  const auto positions = delaunay::view(points.positions);
  if (output.interpolate == kNaturalNeighbour) {
    const auto raster = make_raster(output, facts);
    fill_natural_neighbours(positions, result, *raster);
    return write_raster(output, facts, *raster);
  }
  const auto opened = open_simplex_output(output, facts);
  if (kind == OutputKind::raster) {
    constexpr std::uint64_t kTrianglesOfRun = 1 << 15;  // milliseconds of work
    give_runs(positions, result, kTrianglesOfRun, opened->sink());
  } else {
    give_pieces(positions, result, delaunay::kSimplicesOfPiece, opened->sink());
  }
  return opened->commit({points.size(), result.distinct, result.hull_facets, hash(result)});
}

}  // namespace delray::apps
