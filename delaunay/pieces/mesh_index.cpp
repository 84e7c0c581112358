// The index as JSON, "delray.mesh/1". Nothing in it is believed that can be checked: names have one
// form, without folders, and counts add up; that pieces have what is counted is found by reading
// them.
#include "delaunay/pieces/mesh_index.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <unordered_set>

#include "delaunay/files/input.h"
#include "delaunay/pieces/piece_layout.h"

namespace delray::delaunay {
namespace {

using IndexJson = nlohmann::ordered_json;

constexpr std::string_view kIndexSchema = "delray.mesh/1";
constexpr std::string_view kTile = "tile-";

[[noreturn]] void refuse(const std::string& what) { throw std::invalid_argument(what); }

const IndexJson& member(const IndexJson& object, const char* key) {
  const auto found = object.is_object() ? object.find(key) : object.end();
  if (!object.is_object() || found == object.end()) refuse(std::string("has no \"") + key + "\"");
  return *found;
}

std::uint64_t count_at(const IndexJson& object, const char* key) {
  const IndexJson& value = member(object, key);
  constexpr std::uint64_t kMost = std::uint64_t{1} << 62;  // sums of two are numbers still
  if (!value.is_number_unsigned() || value.get<std::uint64_t>() > kMost) {
    refuse(std::string("\"") + key + "\" is no count");
  }
  return value.get<std::uint64_t>();
}

std::string text_at(const IndexJson& object, const char* key) {
  const IndexJson& value = member(object, key);
  if (!value.is_string()) refuse(std::string("\"") + key + "\" is no text");
  return value.get<std::string>();
}

Hash128 hash_at(const IndexJson& object) {
  const std::string text = text_at(object, "hash");
  Hash128 hash;
  const char* const begin = text.data();
  const auto half = [&](const char* first, std::uint64_t& to) {
    return std::from_chars(first, first + 16, to, 16).ptr == first + 16;
  };
  const bool fine = text.size() == 32 && half(begin, hash.high) && half(begin + 16, hash.low);
  if (!fine) refuse("\"hash\" is not 32 hex digits");
  return hash;
}

glm::dvec3 place_at(const IndexJson& object, const char* key) {
  const IndexJson& value = member(object, key);
  glm::dvec3 place;
  if (!value.is_array() || value.size() != 3) refuse(std::string("\"") + key + "\" is no place");
  for (int k = 0; k < 3; ++k) {
    const IndexJson& number = value[static_cast<std::size_t>(k)];
    if (!number.is_number() || !std::isfinite(number.get<double>())) {
      refuse(std::string("\"") + key + "\" is no place");
    }
    place[k] = number.get<double>();
  }
  return place;
}

IndexJson json_of(const MeshPiece& piece) {
  const auto place = [](const glm::dvec3& p) { return IndexJson::array({p.x, p.y, p.z}); };
  return {{"file", piece.file},           {"tile", piece.tile},
          {"points", piece.points},       {"simplices", piece.simplices},
          {"low", place(piece.box.low)},  {"high", place(piece.box.high)},
          {"hash", to_string(piece.hash)}};
}

MeshPiece piece_of(const IndexJson& json) {
  MeshPiece piece;
  piece.file = text_at(json, "file");
  if (!internal::is_piece_name(piece.file)) {
    refuse("\"file\" is not the name of a piece in the folder");
  }
  piece.tile = count_at(json, "tile");
  piece.points = count_at(json, "points");
  piece.simplices = count_at(json, "simplices");
  piece.box = {place_at(json, "low"), place_at(json, "high")};
  piece.hash = hash_at(json);
  if (piece.points == 0 || piece.simplices == 0 || piece.box.empty()) refuse("has an empty piece");
  if (piece.points > internal::kMostCorners || piece.simplices > internal::kMostCorners / 3) {
    refuse(piece.file + " is larger than pieces are");
  }
  return piece;
}

// An index has three levels; whatever is deeper is none.
IndexJson parsed(std::string_view text) {
  constexpr int kDeepest = 5;
  const auto shallow = [](int depth, nlohmann::detail::parse_event_t, IndexJson&) {
    if (depth > kDeepest) refuse("is nested too deeply");
    return true;
  };
  return IndexJson::parse(text.begin(), text.end(), shallow);
}

MeshIndex index_of(const IndexJson& json) {
  if (text_at(json, "schema") != kIndexSchema) refuse("is not the index of a mesh folder");
  MeshIndex index;
  index.format = text_at(json, "format");
  const internal::PieceCodec* codec = internal::find_piece_codec(index.format);
  if (codec == nullptr) refuse("\"format\" is none that pieces have");
  const std::uint64_t dim = count_at(json, "dim");
  if (dim != 2 && dim != 3) refuse("\"dim\" is neither 2 nor 3");
  if (dim == 3 && !codec->format.tetrahedra) refuse("its pieces cannot hold tetrahedra");
  index.dim = static_cast<int>(dim);
  index.points = count_at(json, "points");
  index.distinct = count_at(json, "distinct");
  index.simplices = count_at(json, "simplices");
  index.hull_facets = count_at(json, "hull_facets");
  index.hash = hash_at(json);
  const IndexJson& pieces = member(json, "pieces");
  if (!pieces.is_array()) refuse("\"pieces\" is no list");
  std::unordered_set<std::string> names;
  std::uint64_t simplices = 0;
  Hash128 sum;
  for (const IndexJson& each : pieces) {
    index.pieces.push_back(piece_of(each));
    const MeshPiece& piece = index.pieces.back();
    if (!piece.file.ends_with(codec->suffix)) refuse(piece.file + " is of another format");
    if (!names.insert(piece.file).second) refuse(piece.file + " is named twice");
    if (piece.simplices * (dim + 1) > internal::kMostCorners) {
      refuse(piece.file + " is larger than pieces are");
    }
    simplices += piece.simplices;
    sum = sum + piece.hash;
  }
  if (simplices != index.simplices)
    refuse("the simplices of its pieces are not as many as it says");
  if (sum != index.hash) refuse("the hashes of its pieces do not add up to its hash");
  if (index.distinct > index.points) refuse("has more distinct points than points");
  return index;
}

}  // namespace

MeshIndex parse_mesh_index(const Input& input) {
  constexpr std::uint64_t kBytesPerByte = 20;  // a parsed text, measured
  input.require_memory(input.content.size() * kBytesPerByte);
  try {
    return index_of(parsed(input.content));
  } catch (const nlohmann::json::exception&) {
    fail(input, "", "is no JSON");
  } catch (const std::invalid_argument& error) {
    fail(input, "", error.what());
  }
}

geometry::Box3d MeshIndex::box() const {
  geometry::Box3d box;
  for (const MeshPiece& piece : pieces) box.include(piece.box);
  return box;
}

namespace internal {

std::string mesh_index_text(const MeshIndex& index) {
  IndexJson json = {{"schema", kIndexSchema},
                    {"format", index.format},
                    {"dim", index.dim},
                    {"points", index.points},
                    {"distinct", index.distinct},
                    {"simplices", index.simplices},
                    {"hull_facets", index.hull_facets},
                    {"hash", to_string(index.hash)}};
  std::string text = json.dump(2);
  text.resize(text.size() - 2);  // the end of the object
  text += ",\n  \"pieces\": [";
  for (std::size_t i = 0; i < index.pieces.size(); ++i) {
    text += (i == 0 ? "\n    " : ",\n    ") + piece_text(index.pieces[i]);
  }
  return text + "\n  ]\n}\n";
}

std::string piece_text(const MeshPiece& piece) { return json_of(piece).dump(); }

MeshPiece parse_piece(const std::string& text) {
  try {
    return piece_of(parsed(text));
  } catch (const nlohmann::json::exception&) {
    refuse("is no JSON");
  }
}

bool is_piece_name(std::string_view name) {
  constexpr std::size_t kLongest = 64;
  return name.starts_with(kTile) && name.size() <= kLongest && !name.ends_with('.') &&
         std::ranges::all_of(name.substr(kTile.size()), [](char c) {
           return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || c == '-' || c == '.';
         });
}

std::string piece_name(std::uint64_t tile, std::uint64_t part, std::string_view suffix) {
  std::string number = std::to_string(tile);
  constexpr std::size_t kDigits = 6;  // so that usual names sort as numbers
  number.insert(0, kDigits - std::min(kDigits, number.size()), '0');
  return std::string(kTile) + number + (part == 0 ? "" : "-" + std::to_string(part)) +
         std::string(suffix);
}

}  // namespace internal
}  // namespace delray::delaunay
