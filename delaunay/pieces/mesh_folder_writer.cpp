// Writes mesh folders. A piece is written under a hidden name, renamed when it is complete, and
// then noted in a journal, a line for each: what a killed run has finished can be told from the
// rest.
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <map>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <unordered_set>
#include <utility>

#include "delaunay/files/input.h"
#include "delaunay/mesh_folder.h"
#include "delaunay/pieces/mesh_index.h"
#include "delaunay/pieces/piece_layout.h"
#include "files/atomic_folder.h"
#include "files/error.h"

namespace delray::delaunay {
namespace {

using internal::PieceCodec;
using internal::PieceShape;

constexpr std::string_view kJournal = "pieces.journal-";  // and the number of the writer
constexpr std::string_view kHidden = ".part-";
constexpr std::size_t kWriteBlock = std::size_t{4} << 20;  // bytes of a system call
constexpr std::uint32_t kUnused = 0xffffffff;

// A file of the folder; writes in large blocks, and has the disk begin with what is written.
class FileSink : public internal::ByteSink {
 public:
  FileSink(const files::AtomicFolder& folder, const std::string& name)
      : name_((folder.path() / name).string()), descriptor_(folder.create(name)) {
    block_.reserve(kWriteBlock);
  }
  ~FileSink() override {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  FileSink(const FileSink&) = delete;
  FileSink& operator=(const FileSink&) = delete;

  void write(std::string_view bytes) override {
    if (block_.size() + bytes.size() > kWriteBlock) flush();
    if (bytes.size() >= kWriteBlock) return write_out(bytes);
    block_.append(bytes);
  }
  void close() {
    flush();
    if (::close(std::exchange(descriptor_, -1)) != 0 && errno != EINTR) fail(errno);
  }

 private:
  [[noreturn]] void fail(int error) const {
    throw files::FileError(files::Cause::device, name_, "",
                           std::string("cannot write: ") + std::strerror(error));
  }
  void flush() {
    write_out(block_);
    block_.clear();
  }
  void write_out(std::string_view bytes) {
    const std::size_t all = bytes.size();
    while (!bytes.empty()) {
      const ssize_t written =
          ::write(descriptor_, bytes.data(), std::min(bytes.size(), kWriteBlock));
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) fail(errno);
      bytes.remove_prefix(static_cast<std::size_t>(written));
    }
    // So that commit() need not wait for all of it. Not every file system can.
    if (all > 0) ::sync_file_range(descriptor_, at_, 0, SYNC_FILE_RANGE_WRITE);
    at_ += static_cast<off_t>(all);
  }

  std::string name_;
  int descriptor_;
  off_t at_ = 0;
  std::string block_;
};

// A part of a piece that fits the format, with the points that it has.
struct PiecePart {
  std::span<const RowPoint> points;
  std::span<const std::uint32_t> corners;
  std::optional<Hash128> hash = std::nullopt;  // of the simplices, where it is known
};

// Leaves out points that no simplex has. `part` stands for itself if there are none.
class CompactPart {
 public:
  explicit CompactPart(const PiecePart& part) : part_(part) {
    std::vector<std::uint32_t> numbers(part.points.size(), kUnused);
    for (const std::uint32_t corner : part.corners) numbers[corner] = 0;
    std::uint32_t used = 0;
    for (std::uint32_t& number : numbers) {
      if (number != kUnused) number = used++;
    }
    if (used == part.points.size()) return;
    points_.reserve(used);
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      if (numbers[i] != kUnused) points_.push_back(part.points[i]);
    }
    corners_.reserve(part.corners.size());
    for (const std::uint32_t corner : part.corners) corners_.push_back(numbers[corner]);
    part_ = {points_, corners_};
  }
  const PiecePart& get() const { return part_; }

 private:
  PiecePart part_;
  std::vector<RowPoint> points_;
  std::vector<std::uint32_t> corners_;
};

Hash128 hash_of_part(int dim, const PiecePart& part) {
  constexpr std::size_t kCornersAtOnce = 12 * 8192;  // whole simplices of either dimension
  Hash128 sum;
  std::vector<std::uint64_t> rows;
  for (std::size_t first = 0; first < part.corners.size(); first += kCornersAtOnce) {
    rows.clear();
    const std::size_t last = std::min(part.corners.size(), first + kCornersAtOnce);
    for (std::size_t i = first; i < last; ++i) rows.push_back(part.points[part.corners[i]].row);
    sum = sum + hash(dim, rows);
  }
  return sum;
}

bool is_name_of_folder(std::string_view name) {
  const auto is_summary = [name](const PieceFormat& format) {
    return name == internal::find_piece_codec(format.name)->summary;
  };
  return internal::is_piece_name(name) || std::ranges::any_of(piece_formats(), is_summary);
}

// The entries of lines; one that a killed run has not finished is none.
std::vector<MeshPiece> parse_pieces(const std::string& text, const std::string& name) {
  std::vector<MeshPiece> found;
  for (std::size_t at = 0, end = 0; (end = text.find('\n', at)) != std::string::npos;
       at = end + 1) {
    try {
      found.push_back(internal::parse_piece(text.substr(at, end - at)));
    } catch (const std::invalid_argument& error) {
      throw files::FileError(files::Cause::device, name, at_byte(at), error.what());
    }
  }
  return found;
}

std::vector<MeshPiece> read_pieces(const files::AtomicFolder& folder, const std::string& journal) {
  const int file = folder.append(journal);
  std::string text, block(std::size_t{1} << 16, '\0');
  ssize_t got = 0;
  while ((got = ::pread(file, block.data(), block.size(), static_cast<off_t>(text.size()))) > 0) {
    text.append(block, 0, static_cast<std::size_t>(got));
  }
  ::close(file);
  return parse_pieces(text, (folder.temporary() / journal).string());
}

}  // namespace

struct MeshFolderWriter::State {
  State(const std::filesystem::path& path, const MeshFolderOptions& given, const PieceCodec& used)
      : codec(used),
        options(given),
        folder(path, {std::string(kMeshIndex), &is_name_of_folder,
                      given.writer != 0 ? files::Unfinished::joined
                      : given.resume    ? files::Unfinished::resumed
                                        : files::Unfinished::removed,
                      [](std::string_view name) { return name.starts_with(kJournal); }}),
        journal_name(std::string(kJournal) + std::to_string(given.writer)),
        journal(folder.append(journal_name)) {}
  ~State() { ::close(journal); }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  void write(std::uint64_t tile, const PiecePart& given);
  void note(const MeshPiece& piece);
  void add(const MeshPiece& piece);
  void remove_strays() const;
  void rewrite_journal();

  const PieceCodec& codec;
  MeshFolderOptions options;
  files::AtomicFolder folder;
  std::string journal_name;
  int journal;  // to append to
  std::mutex mutex;
  std::vector<MeshPiece> pieces;
  std::map<std::uint64_t, std::uint64_t> begun;  // parts of each tile, so far
  std::uint64_t simplices = 0;
  Hash128 hash;
};

void MeshFolderWriter::State::note(const MeshPiece& piece) {
  const std::string line = internal::piece_text(piece) + "\n";
  const std::lock_guard lock(mutex);
  if (::write(journal, line.data(), line.size()) != static_cast<ssize_t>(line.size())) {
    throw files::FileError(files::Cause::device, (folder.path() / journal_name).string(), "",
                           std::string("cannot write: ") + std::strerror(errno));
  }
  add(piece);
}

void MeshFolderWriter::State::add(const MeshPiece& piece) {
  pieces.push_back(piece);
  simplices += piece.simplices;
  hash = hash + piece.hash;
}

void MeshFolderWriter::State::write(std::uint64_t tile, const PiecePart& given) {
  const CompactPart compact(given);
  const PiecePart& part = compact.get();
  MeshPiece piece;
  piece.tile = tile;
  piece.points = part.points.size();
  piece.simplices = part.corners.size() / (static_cast<std::size_t>(options.dim) + 1);
  for (const RowPoint& point : part.points) piece.box.include(point.position);
  piece.hash = given.hash ? *given.hash : hash_of_part(options.dim, part);
  {
    const std::lock_guard lock(mutex);
    piece.file = internal::piece_name(tile, begun[tile]++, codec.suffix);
  }
  const std::string hidden = std::string(kHidden) + piece.file;
  FileSink sink(folder, hidden);
  codec.write(sink, {options.dim, piece.points, piece.simplices}, part.points, part.corners);
  sink.close();
  folder.rename(hidden, piece.file);
  note(piece);
}

// Names that no journal has: of pieces that were not complete.
void MeshFolderWriter::State::remove_strays() const {
  const std::vector<std::string> names = folder.names();
  std::unordered_set<std::string> known;
  for (const std::string& name : names) {
    if (!name.starts_with(kJournal)) continue;
    known.insert(name);
    for (const MeshPiece& piece : read_pieces(folder, name)) known.insert(piece.file);
  }
  for (const std::string& name : names) {
    if (!known.contains(name)) folder.remove(name);
  }
}

// Whole or not at all: a run that is killed here has lost nothing.
void MeshFolderWriter::State::rewrite_journal() {
  const std::string fresh = std::string(kHidden) + journal_name;
  std::string text;
  for (const MeshPiece& piece : pieces) text += internal::piece_text(piece) + "\n";
  FileSink sink(folder, fresh);
  sink.write(text);
  sink.close();
  folder.rename(fresh, journal_name);
  ::close(std::exchange(journal, folder.append(journal_name)));
}

MeshFolderWriter::MeshFolderWriter(const std::filesystem::path& path,
                                   const MeshFolderOptions& options) {
  const PieceCodec* codec = internal::find_piece_codec(options.format);
  if (codec == nullptr)
    throw std::invalid_argument("'" + options.format + "' is no kind of pieces");
  if (options.dim == 3 && !codec->format.tetrahedra) {
    throw std::invalid_argument("pieces of " + options.format + " do not hold tetrahedra");
  }
  state_ = std::make_unique<State>(path, options, *codec);
  if (!options.resume) return;
  if (options.writer == 0) state_->remove_strays();
  keep_tiles([](std::uint64_t) { return true; });
}

MeshFolderWriter::~MeshFolderWriter() = default;

std::uint64_t MeshFolderWriter::bytes_of_point(const std::string& format, int dim) {
  constexpr std::uint64_t kPoints = 1 << 20;  // of a piece
  const PieceCodec* codec = internal::find_piece_codec(format);
  if (codec == nullptr) return 0;
  return codec->bytes({dim, kPoints, kPoints * internal::simplices_of_point(dim)}) / kPoints;
}

void MeshFolderWriter::take(const TilePiece& piece) {
  const std::size_t most = internal::kMostCorners / 12 * 12;  // whole simplices
  for (std::size_t first = 0; first < piece.simplices.size(); first += most) {
    const std::size_t n = std::min(most, piece.simplices.size() - first);
    const bool whole = n == piece.simplices.size();
    state_->write(piece.tile, {piece.points, piece.simplices.subspan(first, n),
                               whole ? piece.hash : std::nullopt});
  }
}

void MeshFolderWriter::keep_tiles(const std::function<bool(std::uint64_t tile)>& finished) {
  state_->pieces.clear();
  state_->begun.clear();
  state_->simplices = 0;
  state_->hash = {};
  std::vector<std::string> dropped;
  for (const MeshPiece& piece : read_pieces(state_->folder, state_->journal_name)) {
    if (piece.file.ends_with(state_->codec.suffix) && finished(piece.tile)) {
      state_->add(piece);
      ++state_->begun[piece.tile];
    } else {
      dropped.push_back(piece.file);
    }
  }
  // The journal first: pieces that it does not know are strays, should this run be killed here.
  state_->rewrite_journal();
  for (const std::string& file : dropped) state_->folder.remove(file);
}

std::string MeshFolderWriter::pieces() const {
  std::string text;
  for (const MeshPiece& piece : state_->pieces) text += internal::piece_text(piece) + "\n";
  return text;
}

void MeshFolderWriter::add_pieces(const std::string& pieces) {
  for (const MeshPiece& piece : parse_pieces(pieces, state_->folder.path().string())) {
    state_->add(piece);
  }
}

void MeshFolderWriter::keep_unfinished() { state_->folder.keep(); }

std::uint64_t MeshFolderWriter::simplices() const { return state_->simplices; }
Hash128 MeshFolderWriter::hash() const { return state_->hash; }

void MeshFolderWriter::commit(const Counts& counts) {
  if (counts.hash && *counts.hash != state_->hash) {
    throw files::FileError(files::Cause::device, state_->folder.path().string(), "",
                           "pieces of an earlier run are missing: it cannot be resumed");
  }
  MeshIndex index{state_->options.format, state_->options.dim, counts.points, counts.distinct,
                  state_->simplices,      counts.hull_facets,  state_->hash,  state_->pieces};
  std::ranges::sort(index.pieces, [](const MeshPiece& a, const MeshPiece& b) {
    return a.tile != b.tile ? a.tile < b.tile : a.file < b.file;
  });
  const auto write_text = [&](std::string_view name, const std::string& text) {
    FileSink sink(state_->folder, std::string(name));
    sink.write(text);
    sink.close();
  };
  if (!state_->codec.summary.empty()) {
    write_text(state_->codec.summary, state_->codec.write_summary(index));
  }
  write_text(kMeshIndex, internal::mesh_index_text(index));
  for (const std::string& name : state_->folder.names()) {
    if (name.starts_with(kJournal)) state_->folder.remove(name);
  }
  state_->folder.commit();
}

bool names_folder(const std::filesystem::path& path) {
  std::error_code ignored;
  return path.string().ends_with('/') || std::filesystem::is_directory(path, ignored);
}

}  // namespace delray::delaunay
