// Recognizes formats by magic bytes, then by structure (binary STL by its size, JSON, XML, the
// first line with content), then by suffix, then as rows of numbers. PLY and OFF files say in their
// headers whether they have faces; an OBJ file is searched for the first one.
#include "files/format.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <limits>
#include <memory>
#include <string>
#include <utility>

#include "files/error.h"
#include "files/read_file.h"

namespace delray::files {
namespace {

constexpr std::size_t kStart = std::size_t{1} << 20;  // bytes; enough to know any format by

constexpr std::string_view kBlanks = " \t\r\n";

constexpr std::string_view kObjKeywords[] = {"v", "vn", "vt", "vp", "f",      "l",
                                             "p", "o",  "g",  "s",  "usemtl", "mtllib"};

std::string lower(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

bool ends_line(char c) { return c == '\n' || c == '\r'; }

// Takes the first line from `rest`, without its end; "\r\n" ends an empty line, too.
std::string_view take_line(std::string_view& rest) {
  const auto end = static_cast<std::size_t>(std::ranges::find_if(rest, ends_line) - rest.begin());
  const std::string_view line = rest.substr(0, end);
  rest.remove_prefix(std::min(end + 1, rest.size()));
  return line;
}

std::string_view take_word(std::string_view& rest) {
  rest.remove_prefix(std::min(rest.find_first_not_of(kBlanks), rest.size()));
  const std::string_view word = rest.substr(0, rest.find_first_of(kBlanks));
  rest.remove_prefix(word.size());
  return word;
}

// The first line that is neither blank nor a comment.
std::string_view first_content_line(std::string_view text) {
  while (!text.empty()) {
    const std::string_view line = take_line(text);
    std::string_view rest = line;
    const std::string_view word = take_word(rest);
    if (!word.empty() && word.front() != '#') return line;
  }
  return {};
}

bool is_count(std::string_view word, std::uint64_t& count) {
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), count);
  return error == std::errc() && end == word.data() + word.size();
}

// "ply" alone in its line, blanks aside.
bool is_ply(std::string_view start) {
  if (!start.starts_with("ply")) return false;
  const std::size_t end = start.find_first_not_of(" \t", 3);
  return end != std::string_view::npos && (start[end] == '\n' || start[end] == '\r');
}

bool ply_has_faces(std::string_view text) {
  while (!text.empty()) {
    std::string_view line = take_line(text);
    const std::string_view keyword = take_word(line);
    if (keyword == "end_header") return false;
    if (keyword != "element") continue;
    const std::string_view element = take_word(line);
    std::uint64_t count = 0;
    const bool surface = element == "face" || element == "tristrips";
    if (surface && is_count(take_word(line), count) && count > 0) return true;
  }
  return false;
}

// OFF, with the prefixes that say what else a vertex has.
bool is_off_keyword(std::string_view word) {
  return word.ends_with("OFF") && word.size() <= 7 &&
         word.substr(0, word.size() - 3).find_first_not_of("STCN4n") == std::string_view::npos;
}

// The three counts stand after the keyword, on its line or the next.
bool off_has_faces(std::string_view text) {
  std::uint64_t counts[2] = {};
  int found = 0;
  while (!text.empty() && found < 2) {
    std::string_view line = take_line(text);
    line = line.substr(0, line.find('#'));
    for (auto word = take_word(line); !word.empty() && found < 2; word = take_word(line)) {
      if (is_count(word, counts[found])) ++found;
    }
  }
  return found == 2 && counts[1] > 0;
}

bool is_face_line(std::string_view line) {
  return line.size() > 2 && line[0] == 'f' && (line[1] == ' ' || line[1] == '\t');
}

bool obj_has_faces(std::string_view text) {
  while (!text.empty()) {
    if (is_face_line(take_line(text))) return true;
  }
  return false;
}

bool obj_file_has_faces(const std::filesystem::path& path, const MemoryBudget& memory) {
  if (is_stream(path)) {
    return obj_has_faces(read_start(path, std::numeric_limits<std::size_t>::max(), memory));
  }
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"),
                                                             &std::fclose);
  if (!file) return false;
  std::string buffer(std::size_t{1} << 20, '\0');
  std::size_t kept = 0;  // bytes of an unfinished line at the front of the buffer
  while (true) {
    const std::size_t got = std::fread(buffer.data() + kept, 1, buffer.size() - kept, file.get());
    const std::string_view text(buffer.data(), kept + got);
    if (obj_has_faces(text)) return true;
    if (got == 0) return false;
    const std::size_t line = text.find_last_of("\r\n") + 1;  // 0 if there is none
    // A line that fills the whole buffer is no face: drop it.
    kept = line == 0 && text.size() == buffer.size() ? 0 : text.size() - line;
    std::memmove(buffer.data(), text.data() + line, kept);
  }
}

bool is_binary_stl(std::string_view start, std::uint64_t size) {
  constexpr std::size_t kHeader = 84, kTriangle = 50;
  if (start.size() < kHeader) return false;
  std::uint32_t count = 0;
  std::memcpy(&count, start.data() + kHeader - sizeof count, sizeof count);
  return size == kHeader + std::uint64_t{kTriangle} * count;
}

Format json_format(std::string_view start) {
  std::string_view rest = start.substr(std::min(start.find_first_not_of(kBlanks), start.size()));
  if (rest.starts_with('[')) return Format::json_points;
  const bool asset = rest.find("\"asset\"") != std::string_view::npos ||
                     rest.find("\"meshes\"") != std::string_view::npos ||
                     rest.find("\"buffers\"") != std::string_view::npos;
  return rest.starts_with('{') && asset ? Format::gltf : Format::unknown;
}

Format xml_format(std::string_view start) {
  std::string_view rest = start.substr(std::min(start.find_first_not_of(kBlanks), start.size()));
  const bool xml = rest.starts_with("<?xml") || rest.starts_with("<VTKFile");
  return xml && rest.substr(0, 4096).find("<VTKFile") != std::string_view::npos ? Format::vtu
                                                                                : Format::unknown;
}

// By its mark, or by the zeros that letters and digits have in it.
bool is_utf16(std::string_view start) {
  if (start.starts_with("\xff\xfe") || start.starts_with("\xfe\xff")) return true;
  constexpr std::size_t kLooked = 16;
  if (start.size() < kLooked) return false;
  const auto zero = [start](std::size_t i) { return start[i] == '\0'; };
  for (std::size_t i = 0; i < kLooked; i += 2) {
    if (zero(i) == zero(i + 1) || zero(i) != zero(0)) return false;
  }
  return true;
}

Format format_of_content(std::string_view start, std::uint64_t size) {
  for (const auto& [magic, format] : kFormatStarts) {
    if (start.starts_with(magic)) return format;
  }
  if (start.starts_with("\xef\xbb\xbf")) start.remove_prefix(3);  // UTF-8 byte order mark
  if (is_ply(start)) return Format::ply;
  if (is_binary_stl(start, size)) return Format::stl;
  if (const Format json = json_format(start); json != Format::unknown) return json;
  if (const Format xml = xml_format(start); xml != Format::unknown) return xml;
  std::string_view line = first_content_line(start);
  const std::string_view word = take_word(line);
  if (is_off_keyword(word)) return Format::off;
  if (word == "solid" && start.find("facet") != std::string_view::npos) return Format::stl;
  if (std::ranges::find(kObjKeywords, word) != std::end(kObjKeywords)) return Format::obj;
  return Format::unknown;
}

constexpr std::size_t kComments = 4096;  // bytes at the beginning that may tell about the file

// Files of older versions, which do not tell which way is up, too.
bool is_by_delray(std::string_view start) {
  constexpr std::string_view kMark = "written by delray";
  static_assert(kWrittenByDelray.starts_with(kMark));
  return start.substr(0, kComments).find(kMark) != std::string_view::npos;
}

// Nobody knows how much of a stream is to come.
std::uint64_t size_of(const std::filesystem::path& path, std::string_view start) {
  std::error_code error;
  const std::uintmax_t size = is_stream(path) ? 0 : std::filesystem::file_size(path, error);
  return error ? start.size() : std::max<std::uintmax_t>(size, start.size());
}

bool looks_like_number(std::string_view word) {
  word = word.substr(0, word.find_first_of(",;"));
  if (word.starts_with('+')) word.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error != std::errc::invalid_argument && end == word.data() + word.size();
}

bool has_faces(Format format, std::string_view start) {
  switch (format) {
    case Format::ply:
      return ply_has_faces(start);
    case Format::off:
      return off_has_faces(start);
    case Format::obj:
      return obj_has_faces(start);
    case Format::stl:
    case Format::gltf:
    case Format::glb:
    case Format::vtu:
      return true;
    default:
      return false;
  }
}

}  // namespace

std::string_view name(Format format) {
  if (format == Format::json_points) return "json";
  if (format == Format::text) return "text";
  if (format == Format::image) return "image";
  for (const auto& [suffix, known] : kFormatSuffixes) {
    if (known == format) return suffix.substr(1);
  }
  return "unknown";
}

std::string suffixes(Format format) {
  std::string list;
  for (const auto& [suffix, known] : kFormatSuffixes) {
    if (known == format) list += (list.empty() ? "" : " ") + std::string(suffix);
  }
  return list;
}

char up_axis(std::string_view start) {
  start = start.substr(0, kComments);
  bool is_first = true;
  while (!start.empty()) {
    const std::string_view line = take_line(start);
    std::string_view rest = line;
    const std::string_view word = take_word(rest);
    // All of an STL's header, and the name in the first line of its text, are comments.
    const bool is_comment = word.starts_with('#') || word == "comment" || word == "obj_info";
    for (std::string_view said : {"up: y", "up: z", "up:y", "up:z"}) {
      const std::size_t at = line.find(said);
      if ((is_comment || is_first) && at != std::string_view::npos) return said.back();
    }
    is_first = false;
  }
  return '\0';
}

Format format_of_suffix(const std::filesystem::path& path) {
  const std::string suffix = lower(path.extension().string());
  for (const auto& [known, format] : kFormatSuffixes) {
    if (known == suffix) return format;
  }
  return Format::unknown;
}

Format identify_format(const std::filesystem::path& path, const MemoryBudget& memory) {
  const std::string start = read_start(path, kStart, memory);
  return identify(start, size_of(path, start), path).format;
}

FileKind identify(std::string_view start, std::uint64_t size, const std::filesystem::path& path) {
  FileKind kind;
  kind.format = format_of_content(start, size);
  if (kind.format == Format::unknown && is_utf16(start)) {
    throw FileError(Cause::input, path == "-" ? "standard input" : path.string(), "",
                    "UTF-16 text is not read; save it as UTF-8");
  }
  if (kind.format == Format::unknown) kind.format = format_of_suffix(path);
  if (kind.format == Format::unknown) {
    std::string_view line = first_content_line(start);
    if (looks_like_number(take_word(line))) kind.format = Format::text;
  }
  kind.has_faces = has_faces(kind.format, start);
  kind.by_delray = is_by_delray(start);
  // A .node of an .ele is a mesh only together with it; the name says which one the user means.
  if (kind.format == Format::node) kind.has_faces = lower(path.extension().string()) == ".ele";
  return kind;
}

FileKind identify(const std::filesystem::path& path, const MemoryBudget& memory) {
  const std::string start = read_start(path, kStart, memory);
  FileKind kind = identify(start, size_of(path, start), path);
  if (kind.format == Format::obj && !kind.has_faces && start.size() == kStart) {
    kind.has_faces = obj_file_has_faces(path, memory);
  }
  return kind;
}

}  // namespace delray::files
