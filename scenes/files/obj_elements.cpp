// Indices may point to vertices that come later, so vertices are read before.
#include "scenes/files/obj_elements.h"

#include <algorithm>
#include <optional>

#include "scenes/files/growth_watch.h"
#include "scenes/scene.h"

namespace delray::scenes::internal {
namespace {

constexpr std::array kWhat = {"vertex", "texture coordinate", "normal"};

std::optional<ObjElement::Kind> kind_of(std::string_view key) {
  if (key == "f") return ObjElement::face;
  if (key == "l") return ObjElement::line;
  if (key == "p") return ObjElement::points;
  return std::nullopt;
}

// position/texture/normal, each counted from 1 or, if negative, back from the line.
ObjCorner read_corner(const ObjText& text, const Lines& lines, std::string_view corner,
                      const ObjCounts& before) {
  ObjCorner result = {kNone, kNone, kNone};
  for (std::size_t part = 0; part < 3 && !corner.empty(); ++part) {
    const std::string_view word = corner.substr(0, corner.find('/'));
    corner.remove_prefix(std::min(corner.size(), word.size() + 1));
    if (word.empty() && part > 0) continue;
    std::int64_t index = 0;
    if (!parse(word, index)) {
      text.source().fail(lines.place(),
                         "'" + std::string(word.substr(0, 40)) + "' is not an index");
    }
    if (index == 0 || index > text.all()[part] || index < -before[part]) {
      text.source().fail(lines.place(),
                         "there is no " + std::string(kWhat[part]) + " " + std::to_string(index) +
                             " (" + std::to_string(index < 0 ? before[part] : text.all()[part]) +
                             (index < 0 ? " so far)" : " in all)"));
    }
    result[part] = static_cast<std::uint32_t>(index < 0 ? before[part] + index : index - 1);
  }
  if (!corner.empty()) text.source().fail(lines.place(), "a corner has too many parts");
  return result;
}

void read_lines(const ObjText& text, std::size_t range, Lines& lines, ObjElements& to) {
  GrowthWatch watch(text.source());
  ObjCounts before = text.before(range);
  std::string_view line;
  while (lines.next(line)) {
    watch.step();
    Words words(line);
    const std::string_view key = words.next();
    const auto vertex = std::ranges::find(kObjVertexKeys, key);
    if (vertex != kObjVertexKeys.end()) {
      ++before[static_cast<std::size_t>(vertex - kObjVertexKeys.begin())];
    } else if (const auto kind = kind_of(key)) {
      const std::size_t size = to.corners.size();
      for (std::string_view word = words.next(); !word.empty() && word.front() != '#';
           word = words.next()) {
        watch.step();
        to.corners.push_back(read_corner(text, lines, word, before));
      }
      to.elements.push_back({*kind, static_cast<std::uint32_t>(to.corners.size() - size)});
    }
  }
}

}  // namespace

ObjElements read_obj_elements(const ObjText& text, std::size_t range) {
  ObjElements elements;
  text.with_lines(range, [&](Lines lines) {
    elements = {};
    read_lines(text, range, lines, elements);
  });
  return elements;
}

}  // namespace delray::scenes::internal
