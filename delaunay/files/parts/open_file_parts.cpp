// Opens files of points by a table of the formats that can be read in parts; all others are read
// whole, by the table of readers.
#include <algorithm>
#include <array>
#include <stdexcept>

#include "delaunay/files/line_ends.h"
#include "delaunay/files/parts/file_parts.h"
#include "delaunay/files/parts/las_parts.h"
#include "delaunay/files/parts/pcd_parts.h"
#include "delaunay/files/parts/ply_parts.h"
#include "delaunay/files/parts/text_parts.h"
#include "delaunay/files/point_readers.h"
#include "files/error_hint.h"
#include "files/read_file.h"

namespace delray::delaunay {
namespace {

using files::Format;

struct PartReader {
  Format format;
  // Null if the file cannot be cut. Throws FileError.
  std::unique_ptr<FileParts> (*open)(const ByteSource& source, const PointFilter& filter);
};
constexpr std::array kPartReaders = {
    PartReader{Format::text, [](const ByteSource& source,
                                const PointFilter&) { return open_text_parts(source); }},
    PartReader{Format::ply,
               [](const ByteSource& source, const PointFilter&) { return open_ply_parts(source); }},
    PartReader{Format::pcd,
               [](const ByteSource& source, const PointFilter&) -> std::unique_ptr<FileParts> {
                 return std::make_unique<PcdParts>(source);
               }},
    PartReader{
        Format::las,
        [](const ByteSource& source, const PointFilter& filter) -> std::unique_ptr<FileParts> {
          return std::make_unique<LasParts>(source, filter);
        }},
};

std::string known_formats() {
  std::string list;
  for (const PointReader& reader : kPointReaders) {
    list += (list.empty() ? "" : ", ") + std::string(reader.name);
  }
  return list;
}

// All of a file as one part, in memory.
class WholeFile : public FileParts {
 public:
  WholeFile(std::string name, PointCloud cloud) {
    facts_.told.file = std::move(name);
    facts_.has_z = cloud.has_z;
    facts_.has_classes = !cloud.classification.empty();
    facts_.geographic = cloud.geographic;
    facts_.warnings = std::move(cloud.warnings);
    cloud.warnings.clear();
    points_.cloud = std::move(cloud);
  }
  std::size_t parts() const override { return 1; }
  std::uint64_t most_rows(std::size_t) const override { return points_.size(); }
  void read(std::size_t, PartPoints& points) const override { points = points_; }

 private:
  PartPoints points_;
};

// What no reader can cut: `path` is empty for a stream, which `source` has.
std::unique_ptr<FileParts> read_whole(const ByteSource& source, const PointReader& reader,
                                      const std::filesystem::path& path) {
  const std::string name(source.name());
  try {
    std::string buffer;
    const std::string content = with_line_feeds(
        reader.format, path.empty() ? std::string(source.read(0, source.size(), buffer))
                                    : files::read_file(path, source.memory()));
    return std::make_unique<WholeFile>(name, reader.read({name, content, source.memory()}));
  } catch (const files::FileError& error) {
    if (error.cause() != files::Cause::memory) throw;
    throw with_hint(error,
                    "such a file is read as a whole: text, LAS, LAZ, PCD and binary PLY without "
                    "faces need not be");
  }
}

// Throws std::invalid_argument where the filter asks for what the file does not have.
void check_filter(const FileFacts& facts, const PointFilter& filter) {
  const std::string& file = facts.told.file;
  const auto refuse = [&](const std::string& what) { throw std::invalid_argument(what); };
  if (filter.classes && !facts.has_classes) refuse("--class: the points of " + file + " have none");
  if (filter.returns && !facts.has_returns) {
    refuse("--returns: " + file + " does not number its returns, as LAS does");
  }
  if (filter.resolution > 0 && !facts.has_nodes) {
    refuse("--resolution: " + file + " has no octree, as COPC has");
  }
  if (filter.bounds && filter.bounds_z && !facts.has_z) {
    refuse("--bounds: the points of " + file + " have no z");
  }
}

std::unique_ptr<FileParts> open_unchecked(const std::filesystem::path& given,
                                          const PointFilter& filter, const ReadOptions& options) {
  // The points of a mesh in two files are in the other one.
  const std::filesystem::path path =
      given.extension() == ".ele" ? std::filesystem::path(given).replace_extension(".node") : given;
  const std::string name = path == "-" ? "standard input" : path.string();
  constexpr std::size_t kMark = 4;  // bytes of a mark that no other format begins with
  const std::string start = files::read_start(path, kMark, options.memory);
  if (start.empty()) fail({name, ""}, "", "the file is empty");
  Format format = options.format;
  if (format == Format::unknown && start == "LASF") format = Format::las;
  if (format == Format::unknown) format = files::identify_format(path, options.memory);
  const auto reader = std::ranges::find(kPointReaders, format, &PointReader::format);
  // A stream of something else need not be read to its end, if it has one.
  if (reader == kPointReaders.end()) {
    fail({name, ""}, "", "not a file of points; known formats: " + known_formats());
  }
  const auto cut = std::ranges::find(kPartReaders, format, &PartReader::format);
  const bool stream = files::is_stream(path);
  const ByteSource source =
      stream ? ByteSource(name, files::read_file(path, options.memory), options.memory)
             : ByteSource(path, options.memory);
  std::unique_ptr<FileParts> parts;
  if (cut != kPartReaders.end()) parts = cut->open(source, filter);
  if (parts == nullptr) {
    parts = read_whole(source, *reader, stream ? std::filesystem::path() : path);
  }
  parts->tell_format(reader->name);
  return parts;
}

}  // namespace

std::unique_ptr<FileParts> open_file_parts(const std::filesystem::path& path,
                                           const PointFilter& filter, const ReadOptions& options) {
  std::unique_ptr<FileParts> file = open_unchecked(path, filter, options);
  check_filter(file->facts(), filter);
  return file;
}

}  // namespace delray::delaunay
