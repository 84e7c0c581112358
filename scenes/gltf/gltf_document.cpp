// Splits the binary container into chunks, parses the JSON within the memory budget, refuses
// unknown required extensions, and finds buffers in the container, in files or as base64. Of files
// no more is read here than the JSON.
#include "scenes/gltf/gltf_document.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "files/error.h"
#include "scenes/gltf/gltf_material.h"

namespace delray::scenes::internal {
namespace {

constexpr std::string_view kMagic = "glTF";
constexpr std::uint32_t kJsonChunk = 0x4E4F534A, kBinaryChunk = 0x004E4942;

bool is_supported(std::string_view extension) {
  constexpr std::array<std::string_view, 5> kKnown = {
      "KHR_draco_mesh_compression", "KHR_lights_punctual", "KHR_mesh_quantization",
      "KHR_texture_transform", "EXT_texture_webp"};
  return is_material_extension(extension) ||
         std::find(kKnown.begin(), kKnown.end(), extension) != kKnown.end();
}

std::uint32_t word_at(const files::FileBytes& bytes, std::uint64_t offset) {
  std::uint32_t value = 0;
  std::string buffer;
  std::memcpy(&value, bytes.read(offset, sizeof value, buffer).data(), sizeof value);
  return value;
}

struct Chunks {
  GltfBytes json, binary;
  bool has_binary = false;
};

Chunks split_chunks(const Source& source) {
  const files::FileBytes bytes = source.bytes();
  std::string buffer;
  const std::uint64_t start = std::min<std::uint64_t>(bytes.size(), kMagic.size());
  Chunks chunks{{bytes, 0, bytes.size()}, {bytes, 0, 0}, false};
  if (bytes.read(0, start, buffer) != kMagic) return chunks;
  if (bytes.size() < 20) source.fail("byte 0", "the file ends within its header");
  if (word_at(bytes, 4) != 2) {
    source.fail("byte 4", "this is version " + std::to_string(word_at(bytes, 4)) +
                              " of glTF; only 2 can be read");
  }
  const std::uint32_t length = word_at(bytes, 8);
  if (length > bytes.size()) {
    source.fail("byte 8", "the header says " + std::to_string(length) + " bytes; the file has " +
                              std::to_string(bytes.size()));
  }
  chunks.json.size = 0;
  for (std::uint64_t at = 12; at + 8 <= length;) {
    const std::uint64_t size = word_at(bytes, at);
    const std::uint32_t type = word_at(bytes, at + 4);
    if (size > length - at - 8) source.fail("byte " + std::to_string(at), "a chunk is cut short");
    if (type == kJsonChunk && chunks.json.size == 0) chunks.json = {bytes, at + 8, size};
    if (type == kBinaryChunk && !chunks.has_binary) {
      chunks.binary = {bytes, at + 8, size};
      chunks.has_binary = true;
    }
    at += 8 + size;
  }
  if (chunks.json.size == 0) source.fail("byte 12", "the file has no JSON chunk");
  return chunks;
}

// Values of arrays and members of objects take far more memory than the few bytes that they may
// have in the text.
std::uint64_t parsed_size(std::string_view text) {
  constexpr std::uint64_t kValue = 64;
  const auto values = std::count_if(text.begin(), text.end(), [](char c) {
    return c == ',' || c == ':' || c == '[' || c == '{';
  });
  return text.size() + kValue * static_cast<std::uint64_t>(values);
}

Json parse_json(const Source& source, std::string_view text) {
  source.require_memory(parsed_size(text));
  try {
    return Json::parse(text);
  } catch (const Json::parse_error& e) {
    source.fail("byte " + std::to_string(e.byte), "the JSON is malformed or cut short");
  } catch (const Json::exception& e) {
    source.fail("", std::string("the JSON cannot be read: ") + e.what());
  }
}

void check_version(const GltfDocument& document) {
  const JsonView root = document.root();
  const std::string version = root["asset"]["version"].text();
  if (!version.starts_with("2.")) {
    root["asset"]["version"].fail("should be 2.0; this is not a glTF 2.0 file");
  }
  const JsonView required = root["extensionsRequired"];
  for (std::size_t i = 0; i < required.size(); ++i) {
    const std::string name = required[i].text();
    if (!is_supported(name)) {
      required[i].fail("the extension " + name + " is required and not supported");
    }
  }
}

// Notes images, also those that no material uses.
void note_images(const GltfDocument& document) {
  const JsonView images = document.root()["images"];
  for (std::size_t i = 0; i < images.size(); ++i) {
    const JsonView uri = images[i]["uri"];
    if (uri && !uri.text().starts_with("data:")) {
      document.source.note_named(decode_percent(uri.text()));
    }
  }
}

GltfBytes find_buffer(const GltfDocument& document, const JsonView& buffer, std::size_t number,
                      const Chunks& chunks) {
  const Source& source = document.source;
  if (!buffer["uri"]) {
    if (number > 0 || !chunks.has_binary) buffer.fail("has no data");
    return chunks.binary;
  }
  const std::string uri = buffer["uri"].text();
  std::string own;
  if (decode_data_uri(uri, own)) {
    const files::FileBytes bytes(source.path.string(), std::move(own), source.memory);
    return {bytes, 0, bytes.size()};
  }
  if (uri.starts_with("data:")) buffer["uri"].fail("is a malformed data URI");
  try {
    const files::FileBytes bytes(source.resolve(decode_percent(uri)), source.memory);
    return {bytes, 0, bytes.size()};
  } catch (const files::FileError& e) {
    if (e.cause() == files::Cause::memory) throw;
    buffer["uri"].fail(e.what());
  }
}

void find_buffers(GltfDocument& document, const Chunks& chunks) {
  const JsonView buffers = document.root()["buffers"];
  for (std::size_t i = 0; i < buffers.size(); ++i) {
    const JsonView buffer = buffers[i];
    const GltfBytes found = find_buffer(document, buffer, i, chunks);
    const std::uint64_t length = buffer["byteLength"].whole();
    if (length > found.size) {
      buffer["byteLength"].fail("says " + std::to_string(length) + " bytes; there are " +
                                std::to_string(found.size));
    }
    document.buffers.push_back({found.bytes, found.begin, length});
  }
}

int base64_digit(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  if (c == '+' || c == '-') return 62;
  return c == '/' || c == '_' ? 63 : -1;
}

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

}  // namespace

bool decode_data_uri(std::string_view uri, std::string& bytes) {
  constexpr std::string_view kMark = ";base64,";
  const std::size_t mark = uri.find(kMark);
  if (!uri.starts_with("data:") || mark == std::string_view::npos) return false;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : uri.substr(mark + kMark.size())) {
    if (c == '=') break;
    const int digit = base64_digit(c);
    if (digit < 0) return false;
    bits = bits << 6 | static_cast<std::uint32_t>(digit);
    count += 6;
    if (count >= 8) {
      count -= 8;
      bytes.push_back(static_cast<char>(bits >> count & 0xFF));
    }
  }
  return true;
}

std::string decode_percent(std::string_view uri) {
  std::string path;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const bool escape = uri[i] == '%' && i + 2 < uri.size() && hex_digit(uri[i + 1]) >= 0 &&
                        hex_digit(uri[i + 2]) >= 0;
    path.push_back(escape ? static_cast<char>(hex_digit(uri[i + 1]) * 16 + hex_digit(uri[i + 2]))
                          : uri[i]);
    i += escape ? 2 : 0;
  }
  return path;
}

GltfBytes buffer_view(const GltfDocument& document, std::size_t number) {
  const JsonView view = document.root()["bufferViews"][number];
  const std::uint32_t buffer = view["buffer"].reference(document.buffers.size());
  if (buffer == kNone) view["buffer"].fail("is missing");
  const std::uint64_t offset = view["byteOffset"].whole(0), length = view["byteLength"].whole();
  const GltfBytes& all = document.buffers[buffer];
  if (offset > all.size || length > all.size - offset) {
    view.fail("reaches beyond its buffer of " + std::to_string(all.size) + " bytes");
  }
  return {all.bytes, all.begin + offset, length};
}

GltfDocument read_document(const Source& source) {
  const Chunks chunks = split_chunks(source);
  std::string buffer;
  GltfDocument document{
      source, parse_json(source, chunks.json.read(0, chunks.json.size, buffer)), {}};
  check_version(document);
  note_images(document);
  find_buffers(document, chunks);
  return document;
}

}  // namespace delray::scenes::internal
