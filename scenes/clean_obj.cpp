#include <algorithm>
#include <array>
#include <cmath>

#include "scenes/internal/check_file.h"

namespace delray::scenes::internal {
namespace {

using Counts = std::array<std::int64_t, 3>;  // of v, vt and vn
constexpr std::array<std::string_view, 3> kKeys = {"v", "vt", "vn"};

std::size_t kind_of(std::string_view key) {
  return static_cast<std::size_t>(std::find(kKeys.begin(), kKeys.end(), key) - kKeys.begin());
}

Counts count(const Source& source) {
  Counts counts{};
  std::string_view line;
  for (Lines lines(source.content); lines.next(line);) {
    const std::size_t kind = kind_of(Words(line).next());
    if (kind < counts.size()) ++counts[kind];
  }
  return counts;
}

// One corner of a face: position/texture/normal, each counted from 1, or from the end if negative.
void check_corner(const Source& source, const Lines& lines, std::string_view corner,
                  const Counts& counts) {
  constexpr std::array kWhat = {"vertex", "texture coordinate", "normal"};
  for (std::size_t part = 0; part < 3 && !corner.empty(); ++part) {
    const std::string_view word = corner.substr(0, corner.find('/'));
    corner.remove_prefix(std::min(corner.size(), word.size() + 1));
    if (word.empty() && part > 0) continue;
    std::int64_t index = 0;
    if (!parse(word, index)) {
      source.fail(lines.place(), "'" + std::string(word.substr(0, 40)) + "' is not an index");
    }
    if (index == 0 || index > counts[part] || index < -counts[part]) {
      source.fail(lines.place(), "there is no " + std::string(kWhat[part]) + " " +
                                     std::to_string(index) + " (" + std::to_string(counts[part]) +
                                     " so far)");
    }
  }
  if (!corner.empty()) source.fail(lines.place(), "a corner has too many parts");
}

// Positions may be followed by a weight or a colour, texture coordinates have one to three numbers.
void copy_vertex(const Source& source, const Lines& lines, std::size_t kind, Words& words,
                 std::string& text) {
  text += kKeys[kind];
  copy_coordinates(source, lines, words, kind == 1 ? 1 : 3, text);
  Words look_ahead = words;
  int more = 0;
  double value = 0;
  const int most = kind == 0 ? 3 : kind == 1 ? 1 : 0;
  while (more < most && parse(look_ahead.next(), value) && std::isfinite(value)) ++more;
  // Three more are a colour, one is a weight; two are neither.
  copy_coordinates(source, lines, words, kind == 0 && more == 2 ? 0 : more, text);
  if (kind == 1 && more == 0) text += " 0";
  text += '\n';
}

// The number of corners; they are appended to `text`.
std::size_t copy_face(const Source& source, const Lines& lines, Words& words, const Counts& all,
                      const Counts& before, std::string& text) {
  std::size_t corners = 0;
  for (std::string_view corner = words.next(); !corner.empty() && corner.front() != '#';
       corner = words.next()) {
    // Indices may point to vertices that come later; relative ones count back from here.
    check_corner(source, lines, corner, corner.front() == '-' ? before : all);
    (text += ' ') += corner;
    ++corners;
  }
  return corners;
}

bool is_name(std::string_view key) {
  return key == "usemtl" || key == "mtllib" || key == "o" || key == "g";
}

}  // namespace

std::string clean_obj(const Source& source) {
  const Counts all = count(source);
  Counts before{};
  std::string text, face;
  text.reserve(source.content.size());
  std::uint64_t faces = 0, left_out = 0;
  std::string_view line;
  for (Lines lines(source.content); lines.next(line);) {
    Words words(line);
    const std::string_view key = words.next();
    const std::size_t kind = kind_of(key);
    if (kind < kKeys.size()) {
      ++before[kind];
      copy_vertex(source, lines, kind, words, text);
    } else if (key == "f") {
      face = "f";
      const bool is_face = copy_face(source, lines, words, all, before, face) >= 3;
      ++(is_face ? faces : left_out);
      if (is_face) text += face + "\n";
    } else if (key == "l" || key == "p") {
      ++left_out;
    } else if (is_name(key) && !Words(words).next().empty()) {
      (text += line.substr(static_cast<std::size_t>(key.data() - line.data()))) += '\n';
    }
  }
  if (faces == 0) source.fail("", kNoTriangles);
  if (left_out > 0) source.warn(std::to_string(left_out) + " points and lines left out");
  return text;
}

}  // namespace delray::scenes::internal
