#include "delaunay/mesh_folder.h"

#include <gtest/gtest.h>

#include <atomic>
#include <fstream>
#include <optional>
#include <sstream>
#include <thread>

#include "delaunay/files/input.h"
#include "delaunay/generate.h"
#include "tests/delaunay/pieces_in_memory.h"
#include "tests/support/temporary_folder.h"

namespace delray::delaunay {
namespace {

namespace fs = std::filesystem;

// Writes pieces by several threads, each as a tile of its own.
void write(const fs::path& path, const MeshFolderOptions& options,
           const std::vector<PieceMesh>& pieces, const MeshFolderWriter::Counts& counts) {
  MeshFolderWriter writer(path, options);
  std::atomic<std::size_t> next{0};
  {
    std::vector<std::jthread> threads;
    for (int i = 0; i < 4; ++i) {
      threads.emplace_back([&] {
        for (std::size_t at = 0; (at = next++) < pieces.size();) {
          writer.take({options.dim, at, pieces[at].points, pieces[at].simplices});
        }
      });
    }
  }
  writer.commit(counts);
}

std::string content_of_piece(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return (std::ostringstream() << file.rdbuf()).str();
}

void replace(std::string& text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  ASSERT_NE(at, std::string::npos) << from;
  text.replace(at, from.size(), to);
}

// The error of reading everything that a folder has.
std::string error_of(const fs::path& path) {
  try {
    const MeshFolder folder(path);
    PieceMesh mesh;
    for (std::size_t i = 0; i < folder.index().pieces.size(); ++i) folder.read(i, mesh);
  } catch (const files::FileError& error) {
    EXPECT_EQ(error.cause(), files::Cause::input) << error.what();
    return error.what();
  }
  return "";
}

struct Sample {
  Sample(int of_dim, const std::string& format)
      : dim(of_dim), cloud(generate_points("uniform", 400, of_dim, 3)) {
    Options options;
    options.dim = dim;
    whole = triangulate(view(cloud.positions), options).triangulation;
    pieces = tests::in_pieces(cloud, dim, 6);
    for (PieceMesh& piece : pieces) {  // rows above 32 bits
      for (RowPoint& point : piece.points) point.row += kOffset;
    }
    write(path(), {dim, format}, pieces, {cloud.size(), whole.distinct, whole.hull_facets});
  }
  fs::path path() const { return folder / "mesh"; }

  static constexpr std::uint64_t kOffset = std::uint64_t{5} << 32;
  tests::TemporaryFolder folder;
  int dim;
  PointCloud cloud;
  Triangulation whole;
  std::vector<PieceMesh> pieces;
};

Hash128 hash_of(const Sample& sample) { return MeshFolder(sample.path()).index().hash; }

TEST(MeshFolder, ReadsWhatItWrites) {
  for (const PieceFormat& format : piece_formats()) {
    for (const int dim : {2, 3}) {
      if (dim == 3 && !format.tetrahedra) continue;
      const Sample sample(dim, std::string(format.name));
      const MeshFolder folder(sample.path());
      const MeshIndex& index = folder.index();
      EXPECT_EQ(index.dim, dim);
      EXPECT_EQ(index.simplices, sample.whole.size());
      EXPECT_EQ(index.points, 400U);
      EXPECT_EQ(index.distinct, sample.whole.distinct);
      EXPECT_EQ(index.hull_facets, sample.whole.hull_facets);
      ASSERT_EQ(index.pieces.size(), sample.pieces.size());
      PieceMesh mesh;
      for (std::size_t i = 0; i < index.pieces.size(); ++i) {
        folder.read(i, mesh);
        EXPECT_EQ(mesh.simplices, sample.pieces[i].simplices);
        ASSERT_EQ(mesh.points.size(), sample.pieces[i].points.size());
        for (std::size_t k = 0; k < mesh.points.size(); ++k) {
          EXPECT_EQ(mesh.points[k].row, sample.pieces[i].points[k].row);
          EXPECT_EQ(mesh.points[k].position, sample.pieces[i].points[k].position);
        }
      }
      const PointMesh all = read_mesh(sample.path());
      EXPECT_EQ(all.triangulation.dim, dim);
      EXPECT_EQ(all.points.positions, sample.cloud.positions);
      EXPECT_EQ(hash(all.triangulation), hash(sample.whole));
    }
  }
}

TEST(MeshFolder, PiecesArePlainFiles) {
  const Sample vtu(2, "vtu"), ply(2, "ply");
  for (const auto& path : {vtu.path() / "tile-000002.vtu", ply.path() / "tile-000002.ply"}) {
    const PointMesh mesh = read_mesh(path);
    EXPECT_EQ(mesh.triangulation.vertices, vtu.pieces[2].simplices);
    EXPECT_EQ(mesh.points.size(), vtu.pieces[2].points.size());
  }
  const std::string summary = content_of_piece(vtu.path() / "mesh.pvtu");
  const MeshFolder folder(vtu.path());
  for (const MeshPiece& piece : folder.index().pieces) {
    EXPECT_NE(summary.find("<Piece Source=\"" + piece.file + "\"/>"), std::string::npos);
  }
}

TEST(MeshFolder, LeavesOutPointsWithoutSimplices) {
  const tests::TemporaryFolder folder;
  PieceMesh piece{{{{9, 9, 9}, 1}, {{0, 0, 1}, 2}, {{8, 8, 8}, 3}, {{1, 0, 2}, 4}, {{0, 1, 3}, 5}},
                  {1, 3, 4}};
  write(folder / "mesh/", {2, "vtu"}, {piece, {}}, {5, 5, 3});
  const MeshFolder read(folder / "mesh");
  EXPECT_EQ(read.index().pieces.size(), 1U);
  PieceMesh mesh;
  read.read(0, mesh);
  EXPECT_EQ(mesh.simplices, (std::vector<std::uint32_t>{0, 1, 2}));
  EXPECT_EQ(mesh.points.size(), 3U);
  EXPECT_EQ(mesh.points[1].row, 4U);
  EXPECT_EQ(read.index().box().high, glm::dvec3(1, 1, 3));
}

TEST(MeshFolder, OfNoSimplicesHasNoPieces) {
  const tests::TemporaryFolder folder;
  write(folder / "mesh", {3, "vtu"}, {}, {7, 7, 0});
  EXPECT_EQ(MeshFolder(folder / "mesh").index().pieces.size(), 0U);
  EXPECT_EQ(error_of(folder / "mesh"), "");
}

TEST(MeshFolder, RefusesWhatPiecesAreNot) {
  const tests::TemporaryFolder folder;
  EXPECT_THROW(MeshFolderWriter(folder / "m", {2, "obj"}), std::invalid_argument);
  EXPECT_THROW(MeshFolderWriter(folder / "m", {3, "ply"}), std::invalid_argument);
  EXPECT_EQ(folder.entries(), 0U);
}

// An index is believed in nothing that can be checked.
TEST(MeshFolder, RefusesIndexesThatLie) {
  for (const std::string format : {"vtu", "ply"}) {
    const Sample sample(2, format);
    const std::string good = content_of_piece(sample.path() / "mesh.json");
    ASSERT_EQ(error_of(sample.path()), "");
    const MeshIndex index = MeshFolder(sample.path()).index();
    const std::string points = "\"points\":" + std::to_string(index.pieces[1].points);
    const std::string simplices = "\"simplices\":" + std::to_string(index.pieces[1].simplices);
    const std::string total = "\"simplices\": " + std::to_string(index.simplices);
    const std::string name = "tile-000001." + format;
    const std::vector<std::pair<std::string, std::string>> lies = {
        {points, "\"points\":4000000000"},
        {points, "\"points\":" + std::to_string(index.pieces[1].points + 1)},
        {points, "\"points\":-1"},
        {points, "\"points\":1e3"},
        {points, "\"points\":18446744073709551616"},
        {simplices, "\"simplices\":" + std::to_string(index.pieces[1].simplices - 1)},
        {total, "\"simplices\": 7"},
        {name, "../" + name},
        {name, "/etc/passwd"},
        {name, "tile-000001/../x." + format},
        {name, "tile-000000." + format},
        {name, "mesh.json"},
        {name, "tile-000001\\u0000." + format},
        {name, "tile-9." + format},
        {"\"dim\": 2", "\"dim\": 3"},
        {"\"dim\": 2", "\"dim\": 2.5"},
        {"\"format\": \"" + format, "\"format\": \"obj"},
        {"delray.mesh/1", "delray.mesh/2"},
        {"\"hash\": \"", "\"hash\": \"z"},
        {to_string(index.hash), std::string(32, '0')},
        {to_string(index.pieces[2].hash), std::string(32, '0')},
        {"\"low\":[", "\"low\":[1e999,"},
        {"\"low\":[", "\"low\":[[[[[[[["},
        {"\"pieces\": [", "\"pieces\": 3, \"x\": ["},
    };
    for (const auto& [from, to] : lies) {
      std::string bad = good;
      replace(bad, from, to);
      std::ofstream(sample.path() / "mesh.json") << bad;
      EXPECT_NE(error_of(sample.path()), "") << from << " -> " << to;
    }
    for (std::size_t size = 0; size + 2 < good.size(); size += 37) {
      std::ofstream(sample.path() / "mesh.json") << good.substr(0, size);
      EXPECT_NE(error_of(sample.path()), "") << size << " bytes";
    }
  }
}

TEST(MeshFolder, RefusesPiecesThatAreDamaged) {
  for (const std::string format : {"vtu", "ply"}) {
    const Sample sample(2, format);
    const fs::path piece = sample.path() / ("tile-000003." + format);
    const std::string good = content_of_piece(piece);
    const auto expect_bad = [&](const std::string& bad, const std::string& why) {
      std::ofstream(piece, std::ios::binary) << bad;
      const std::string error = error_of(sample.path());
      EXPECT_NE(error.find(piece.filename().string()), std::string::npos) << why << ": " << error;
    };
    expect_bad(good.substr(0, good.size() - 1), "cut off");
    expect_bad(good + "x", "longer");
    std::string bad = good;
    bad[20] ^= 1;
    expect_bad(bad, "header");
    bad = good;
    // A corner beyond the points: the last bytes of the last face, or of the first offset.
    bad.replace(format == "ply" ? good.size() - 4 : good.find("AppendedData") + 40, 4,
                "\xff\xff\xff\xff");
    if (format == "ply") expect_bad(bad, "corner");
    bad = good;
    bad.replace(bad.size() - 13, 1, "\4");
    expect_bad(bad, "faces or types");
    fs::remove(piece);
    EXPECT_NE(error_of(sample.path()), "");
    fs::create_symlink("tile-000001." + format, piece);
    EXPECT_NE(error_of(sample.path()).find("is a link"), std::string::npos);
    fs::remove(piece);
    fs::create_directory(piece);
    EXPECT_NE(error_of(sample.path()), "");
  }
}

TEST(MeshFolder, RefusesAnIndexBehindALink) {
  const Sample sample(2, "vtu");
  fs::rename(sample.path() / "mesh.json", sample.folder / "elsewhere.json");
  fs::create_symlink(sample.folder / "elsewhere.json", sample.path() / "mesh.json");
  EXPECT_FALSE(is_mesh_folder(sample.path()));
  EXPECT_NE(error_of(sample.path()), "");
}

TEST(MeshFolder, ResumesFromFinishedTiles) {
  const Sample sample(2, "vtu");
  const fs::path path = sample.folder / "resumed";
  {
    MeshFolderWriter writer(path, {2, "vtu"});
    for (const std::size_t tile : {0U, 1U, 2U}) {
      writer.take({2, tile, sample.pieces[tile].points, sample.pieces[tile].simplices});
    }
    writer.keep_unfinished();
  }
  EXPECT_FALSE(fs::exists(path));
  // What a killed run leaves besides: a piece that is not whole, and half a line.
  const fs::path part = sample.folder / ".resumed.delray-part";
  std::ofstream(part / ".part-tile-000003.vtu") << "half";
  std::ofstream(part / "pieces.journal-0", std::ios::app) << "{\"file\":\"tile-00";
  MeshFolderWriter writer(path, {2, "vtu", true});
  // Tile 1 was not finished: its other pieces would have followed.
  writer.keep_tiles([](std::uint64_t tile) { return tile != 1; });
  for (const std::size_t tile : {1U, 3U, 4U, 5U}) {
    writer.take({2, tile, sample.pieces[tile].points, sample.pieces[tile].simplices});
  }
  for (std::size_t tile = 6; tile < sample.pieces.size(); ++tile) {
    writer.take({2, tile, sample.pieces[tile].points, sample.pieces[tile].simplices});
  }
  writer.commit({sample.cloud.size(), sample.whole.distinct, sample.whole.hull_facets});
  EXPECT_EQ(error_of(path), "");
  const MeshIndex resumed = MeshFolder(path).index(), whole = MeshFolder(sample.path()).index();
  EXPECT_EQ(resumed.hash, whole.hash);
  EXPECT_EQ(resumed.pieces.size(), whole.pieces.size());
  EXPECT_FALSE(fs::exists(path / "pieces.journal-0"));
}

TEST(MeshFolder, IsWrittenBySeveralProcesses) {
  const Sample sample(2, "vtu");
  const fs::path path = sample.folder / "joined";
  for (const bool resume : {false, true}) {
    std::optional<MeshFolderWriter> first(std::in_place, path, MeshFolderOptions{2, "vtu", resume});
    MeshFolderWriter second(path, {2, "vtu", resume, 1}), third(path, {2, "vtu", resume, 2});
    MeshFolderWriter* const writers[] = {&*first, &second, &third};
    for (std::size_t i = 0; i < sample.pieces.size(); ++i) {
      if (resume && i % 3 != 2) continue;  // the others have theirs still
      writers[i % 3]->take({2, i, sample.pieces[i].points, sample.pieces[i].simplices});
    }
    if (!resume) {
      third.keep_tiles([](std::uint64_t) { return false; });
      first->keep_unfinished();
      continue;
    }
    first->add_pieces(second.pieces());
    first->add_pieces(third.pieces());
    first->commit({sample.cloud.size(), sample.whole.distinct, sample.whole.hull_facets});
  }
  EXPECT_EQ(error_of(path), "");
  EXPECT_EQ(MeshFolder(path).index().hash, hash_of(sample));
}

TEST(MeshFolder, TakesATileInSeveralPieces) {
  const Sample sample(3, "vtu");
  const fs::path path = sample.folder / "one";
  MeshFolderWriter writer(path, {3, "vtu"});
  for (const PieceMesh& piece : sample.pieces) writer.take({3, 17, piece.points, piece.simplices});
  EXPECT_EQ(writer.simplices(), sample.whole.size());
  writer.commit({sample.cloud.size(), sample.whole.distinct, sample.whole.hull_facets});
  EXPECT_EQ(MeshFolder(path).index().hash, MeshFolder(sample.path()).index().hash);
  EXPECT_TRUE(fs::exists(path / "tile-000017-1.vtu"));
}

}  // namespace
}  // namespace delray::delaunay
