#include <array>
#include <cmath>

#include "scenes/internal/check_file.h"
#include "scenes/internal/text_lines.h"

namespace delray::scenes::internal {
namespace {

void check_coordinates(const Source& source, const Lines& lines, Words& words, int count) {
  for (int i = 0; i < count; ++i) {
    const std::string_view word = words.next();
    double value = 0;
    if (word.empty()) source.fail(lines.place(), "a vertex needs three coordinates");
    if (!parse(word, value)) {
      source.fail(lines.place(), "'" + std::string(word.substr(0, 40)) + "' is not a number");
    }
    if (!std::isfinite(value)) source.fail(lines.place(), "a coordinate is not finite");
    if (std::abs(value) > kLargestCoordinate) {
      source.fail(lines.place(), "a coordinate is larger than 1e18");
    }
  }
}

// One corner of an OBJ face: position/texture/normal, each counted from 1, or from the end if
// negative.
void check_corner(const Source& source, const Lines& lines, std::string_view corner,
                  const std::array<std::int64_t, 3>& counts) {
  constexpr std::array kWhat = {"vertex", "texture coordinate", "normal"};
  for (std::size_t part = 0; part < 3 && !corner.empty(); ++part) {
    const std::string_view word = corner.substr(0, corner.find('/'));
    corner.remove_prefix(std::min(corner.size(), word.size() + 1));
    if (word.empty() && part > 0) continue;
    std::int64_t index = 0;
    if (!parse(word, index)) {
      source.fail(lines.place(), "'" + std::string(word.substr(0, 40)) + "' is not an index");
    }
    const std::int64_t count = counts[part];
    if (index == 0 || index > count || index < -count) {
      source.fail(lines.place(), "there is no " + std::string(kWhat[part]) + " " +
                                     std::to_string(index) + " (" + std::to_string(count) +
                                     " so far)");
    }
  }
}

}  // namespace

void check_obj(const Source& source) {
  // Indices may point to vertices that come later, so they are checked against all of the file;
  // relative ones against what precedes them.
  std::array<std::int64_t, 3> all{};
  std::string_view line;
  for (Lines lines(source.content); lines.next(line);) {
    Words words(line);
    const std::string_view key = words.next();
    if (key == "v") {
      ++all[0];
      check_coordinates(source, lines, words, 3);
    } else if (key == "vt") {
      ++all[1];
      check_coordinates(source, lines, words, 1);
    } else if (key == "vn") {
      ++all[2];
      check_coordinates(source, lines, words, 3);
    }
  }
  std::array<std::int64_t, 3> before{};
  for (Lines lines(source.content); lines.next(line);) {
    Words words(line);
    const std::string_view key = words.next();
    before[0] += key == "v" ? 1 : 0;
    before[1] += key == "vt" ? 1 : 0;
    before[2] += key == "vn" ? 1 : 0;
    if (key != "f" && key != "l" && key != "p") continue;
    for (std::string_view corner = words.next(); !corner.empty(); corner = words.next()) {
      if (corner.starts_with('#')) break;
      check_corner(source, lines, corner, corner.starts_with('-') ? before : all);
    }
  }
}

void check_off(const Source& source) {
  Lines lines(source.content);
  std::string_view line;
  const auto need_line = [&](const std::string& what) {
    if (!lines.next_with_words(line, '#')) {
      source.fail("line " + std::to_string(lines.number() + 1),
                  "the file ends where " + what + " should be");
    }
  };
  const auto need_count = [&](Words& words, const char* what) {
    std::int64_t count = 0;
    if (!parse(words.next(), count) || count < 0) {
      source.fail(lines.place(), std::string("the number of ") + what + " is missing");
    }
    // A vertex or face takes at least two characters.
    if (count > static_cast<std::int64_t>(source.content.size() / 2)) {
      source.fail(lines.place(), "the header claims " + std::to_string(count) + " " + what +
                                     ", more than the file has room for");
    }
    return count;
  };
  need_line("the header");
  Words header(line);
  const std::string_view magic = header.next();
  if (magic.find("OFF") == std::string_view::npos)
    source.fail(lines.place(), "this is not an OFF file");
  if (magic != "OFF" && magic != "COFF" && magic != "NOFF" && magic != "CNOFF") {
    source.fail(lines.place(),
                "the variant " + std::string(magic.substr(0, 10)) + " is not supported");
  }
  std::string_view first = header.next();
  if (first == "BINARY") source.fail(lines.place(), "binary OFF is not supported");
  Words counts(line);
  if (first.empty()) {
    need_line("the counts");
    counts = Words(line);
  } else {
    counts.next();
  }
  const std::int64_t vertices = need_count(counts, "vertices");
  const std::int64_t faces = need_count(counts, "faces");
  if (vertices == 0 || faces == 0) source.fail(lines.place(), kNoTriangles);
  for (std::int64_t i = 0; i < vertices; ++i) {
    need_line("vertex " + std::to_string(i) + " of " + std::to_string(vertices));
    Words words(line);
    check_coordinates(source, lines, words, 3);
  }
  for (std::int64_t i = 0; i < faces; ++i) {
    need_line("face " + std::to_string(i) + " of " + std::to_string(faces));
    Words words(line);
    const std::int64_t corners = need_count(words, "corners");
    for (std::int64_t k = 0; k < corners; ++k) {
      std::int64_t index = 0;
      const std::string_view word = words.next();
      if (!parse(word, index)) source.fail(lines.place(), "an index of a face is missing");
      if (index < 0 || index >= vertices) {
        source.fail(lines.place(), "there is no vertex " + std::to_string(index) + " (" +
                                       std::to_string(vertices) + " vertices, from 0)");
      }
    }
  }
}

}  // namespace delray::scenes::internal
