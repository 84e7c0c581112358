// Opens pieces and points on every rank; what they find is the same on all, and told by the first.
#include "apps/verify/verify_folder.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>

#include "apps/input/point_parts_input.h"
#include "apps/verify/verify_json.h"
#include "comm/agree_on_failure.h"
#include "delaunay/mesh_folder.h"
#include "delaunay/point_parts.h"
#include "delaunay/verify_pieces.h"
#include "files/error.h"
#include "parallel/arena.h"

namespace delray::apps {
namespace {

Json statistics_of(const VerifyOptions& options, const delaunay::PiecesVerdict& verdict,
                   const std::string& piece) {
  const Json checked = {{"points", verdict.points},
                        {"vertices", verdict.distinct},
                        {"matched", "rows"},
                        {"unused", 0},
                        {"heights", verdict.heights},
                        {"distinct", verdict.distinct},
                        {"simplices", verdict.simplices},
                        {"hash", to_string(verdict.hash)},
                        {"piece", verdict.piece ? Json(piece) : Json(nullptr)}};
  return verify_json(options, checked, verdict);
}

// What the index says of the mesh as a whole, which each of its pieces by itself does not show.
std::string wrong_in_index(const delaunay::MeshIndex& index,
                           const delaunay::PiecesVerdict& verdict) {
  if (!verdict.valid) return {};
  if (verdict.hash != index.hash) {
    return fmt::format("the hash of its simplices is {}, not {} as its index says",
                       to_string(verdict.hash), to_string(index.hash));
  }
  const auto differs = [](const char* what, std::uint64_t found, std::uint64_t told) {
    return found == told
               ? std::string()
               : fmt::format("there are {} {}, not {} as its index says", found, what, told);
  };
  std::string wrong = differs("points", verdict.points, index.points);
  if (wrong.empty()) wrong = differs("hull facets", verdict.hull_facets, index.hull_facets);
  if (wrong.empty() && verdict.canonical && verdict.simplices > 0) {
    wrong = differs("distinct points", verdict.distinct, index.distinct);
  }
  return wrong;
}

// What there is to say of the mesh as a whole.
struct FolderReport {
  std::string piece;  // that the verdict is about
  std::string wrong;  // in the index
  bool good = false;
};

FolderReport report_of(const VerifyOptions& options, const delaunay::MeshIndex& index,
                       const delaunay::PiecesVerdict& verdict) {
  FolderReport told;
  if (verdict.piece) told.piece = index.pieces[*verdict.piece].file;
  if (verdict.unknown_vertex) {
    throw files::FileError(
        files::Cause::input,
        verdict.piece ? (std::filesystem::path(options.mesh) / told.piece).string() : options.mesh,
        verdict.simplex ? fmt::format("simplex {}", *verdict.simplex) : "", verdict.reason);
  }
  told.wrong = wrong_in_index(index, verdict);
  told.good = (options.canonical ? verdict.canonical : verdict.delaunay) && told.wrong.empty() &&
              verdict.other_height.empty();
  return told;
}

void tell_of_folder(const VerifyOptions& options, const delaunay::MeshIndex& index,
                    const delaunay::PiecesVerdict& verdict, const FolderReport& told) {
  write_statistics(options.statistics, statistics_of(options, verdict, told.piece));
  if (!verdict.reason.empty()) {
    const std::string where =
        verdict.simplex ? fmt::format("{}: simplex {}: ", told.piece, *verdict.simplex) : "";
    spdlog::log(told.good ? spdlog::level::info : spdlog::level::err, "{}: {}{}", options.mesh,
                where, verdict.reason);
  }
  if (!told.wrong.empty()) spdlog::error("{}: {}", options.mesh, told.wrong);
  if (!verdict.other_height.empty()) spdlog::error("{}: {}", options.mesh, verdict.other_height);
  if (options.statistics == "-") return;
  fmt::print(
      "valid: {}\ndelaunay: {}\ncanonical: {}\nchecked: {} simplices in {} {}, {} points{}\n",
      verdict.valid ? "yes" : "no", verdict.delaunay ? "yes" : "no",
      verdict.canonical ? "yes" : "no", verdict.simplices, index.pieces.size(),
      index.pieces.size() == 1 ? "piece" : "pieces", verdict.points,
      verdict.heights.empty() ? "" : fmt::format("; heights are {}", verdict.heights));
}

}  // namespace

// Throws FileError for a folder that is no mesh, and for a file of one that is.
void refuse_parts_of_folders(const std::string& mesh) {
  const auto fail = [&](const std::string& what) {
    throw files::FileError(files::Cause::input, mesh, "", what);
  };
  std::error_code error;
  if (std::filesystem::is_directory(mesh, error)) {
    fail(fmt::format("is a folder without {}: no mesh in pieces, as triangulate -o FOLDER/ writes",
                     delaunay::kMeshIndex));
  }
  const std::filesystem::path path(mesh), folder = path.parent_path();
  const bool of_folder = path.filename() == delaunay::kMeshIndex || path.extension() == ".pvtu";
  if (!of_folder || !delaunay::is_mesh_folder(folder.empty() ? "." : folder)) return;
  fail(fmt::format("is a file of a mesh in pieces: name its folder, {}",
                   folder.empty() ? "." : folder.string()));
}

int verify_folder(Session& session, const VerifyOptions& options) {
  if (options.complete) {
    throw UsageError("--complete: a folder of pieces is always checked to have every point");
  }
  const delaunay::MeshFolder folder(options.mesh, options.points.limits.budget());
  const delaunay::MeshIndex& index = folder.index();
  if (index.dim != options.dim) {
    throw UsageError(fmt::format("--dim {}: {} has simplices of dimension {}", options.dim,
                                 options.mesh, index.dim));
  }
  delaunay::PieceSource pieces{
      index.dim, index.pieces.size(),
      [&](std::size_t piece, delaunay::PieceMesh& mesh) { folder.read(piece, mesh); }};
  for (const delaunay::MeshPiece& piece : index.pieces) pieces.simplices.push_back(piece.simplices);
  // Which of several heights counts is decided over all points; else they pass in parts.
  std::optional<delaunay::PointCloud> whole;
  if (!options.points.duplicates.empty()) whole = load_points(options.points, options.dim);
  const delaunay::VerifyPiecesOptions how{options.mesh, options.points.limits.budget(),
                                          options.scratch};
  const int ranks = std::max(1, options.launch.ranks);
  const parallel::AllowThreads allowed(ranks * threads_per_rank(options.launch, ranks));
  int code = kDone;
  run_ranks(session, options.launch, {options.points.path, options.mesh + "/mesh.json"},
            [&](comm::Communicator& communicator) {
              const auto points = comm::all_or_none(
                  communicator, comm::Phase::other, [&]() -> std::unique_ptr<delaunay::PointParts> {
                    if (whole) return std::make_unique<delaunay::CloudParts>(*whole);
                    return open_parts(options.points);
                  });
              const delaunay::PiecesVerdict verdict =
                  delaunay::verify_pieces(communicator, pieces, *points, how);
              comm::all_or_none(communicator, comm::Phase::other, [&] {
                const FolderReport told = report_of(options, index, verdict);
                if (communicator.rank() == 0) tell_of_folder(options, index, verdict, told);
                if (communicator.rank() == 0 || session.under_mpi) {
                  code = told.good ? kDone : kNotVerified;
                }
              });
            });
  return code;
}

}  // namespace delray::apps
