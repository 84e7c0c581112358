#include <cmath>

#include "scenes/internal/check_file.h"

namespace delray::scenes::internal {
namespace {

// The words of a file, line by line, without comments.
class Reader {
 public:
  explicit Reader(const Source& source) : source_(source), lines_(source.content) {}

  Words next_line(const std::string& what) {
    if (!lines_.next_with_words(line_, '#')) {
      source_.fail("line " + std::to_string(lines_.number() + 1),
                   "the file ends where " + what + " should be");
    }
    return Words(line_);
  }
  std::int64_t count(Words& words, const char* what) const {
    std::int64_t count = 0;
    if (!parse(words.next(), count) || count < 0) {
      fail(std::string("the number of ") + what + " is missing");
    }
    // A vertex, face or corner takes at least two characters.
    if (count > static_cast<std::int64_t>(source_.content.size() / 2)) {
      fail("the header claims " + std::to_string(count) + " " + what +
           ", more than the file has room for");
    }
    return count;
  }
  const Lines& lines() const { return lines_; }
  [[noreturn]] void fail(const std::string& what) const { source_.fail(lines_.place(), what); }

 private:
  const Source& source_;
  Lines lines_;
  std::string_view line_;
};

// The words after the kind of the file, which stand on its line or the next.
Words read_header(Reader& reader) {
  Words words = reader.next_line("the header");
  const std::string_view magic = words.next();
  if (magic.find("OFF") == std::string_view::npos) reader.fail("this is not an OFF file");
  if (magic != "OFF" && magic != "COFF" && magic != "NOFF" && magic != "CNOFF") {
    reader.fail("the variant " + std::string(magic.substr(0, 10)) + " is not supported");
  }
  const std::string_view next = Words(words).next();
  if (next == "BINARY") reader.fail("binary OFF is not supported");
  return next.empty() ? reader.next_line("the counts") : words;
}

std::int64_t copy_face(const Reader& reader, Words& words, std::int64_t vertices,
                       std::string& text) {
  const std::int64_t corners = reader.count(words, "corners");
  text += std::to_string(corners);
  for (std::int64_t k = 0; k < corners; ++k) {
    std::int64_t index = 0;
    if (!parse(words.next(), index)) reader.fail("an index of a face is missing");
    if (index < 0 || index >= vertices) {
      reader.fail("there is no vertex " + std::to_string(index) + " (" + std::to_string(vertices) +
                  " vertices, from 0)");
    }
    (text += ' ') += std::to_string(index);
  }
  text += '\n';
  return corners;
}

}  // namespace

void copy_coordinates(const Source& source, const Lines& lines, Words& words, int count,
                      std::string& text) {
  for (int i = 0; i < count; ++i) {
    const std::string_view word = words.next();
    double value = 0;
    if (word.empty()) source.fail(lines.place(), "a vertex needs more numbers");
    if (!parse(word, value)) {
      source.fail(lines.place(), "'" + std::string(word.substr(0, 40)) + "' is not a number");
    }
    if (!std::isfinite(value)) source.fail(lines.place(), "a coordinate is not finite");
    if (std::abs(value) > kLargestCoordinate) {
      source.fail(lines.place(), "a coordinate is larger than 1e18");
    }
    (text += ' ') += word;
  }
}

std::string clean_off(const Source& source) {
  Reader reader(source);
  Words counts = read_header(reader);
  const std::int64_t vertices = reader.count(counts, "vertices");
  const std::int64_t faces = reader.count(counts, "faces");
  std::string positions, triangles, face;
  positions.reserve(source.content.size());
  for (std::int64_t i = 0; i < vertices; ++i) {
    Words words =
        reader.next_line("vertex " + std::to_string(i) + " of " + std::to_string(vertices));
    copy_coordinates(source, reader.lines(), words, 3, positions);
    positions += '\n';
  }
  std::int64_t kept = 0;
  for (std::int64_t i = 0; i < faces; ++i) {
    Words words = reader.next_line("face " + std::to_string(i) + " of " + std::to_string(faces));
    face.clear();
    if (copy_face(reader, words, vertices, face) < 3) continue;
    triangles += face;
    ++kept;
  }
  if (kept == 0) source.fail("", kNoTriangles);
  if (kept < faces) source.warn(std::to_string(faces - kept) + " points and lines left out");
  return "OFF\n" + std::to_string(vertices) + " " + std::to_string(kept) + " 0\n" + positions +
         triangles;
}

}  // namespace delray::scenes::internal
