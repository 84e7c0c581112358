// Small GeoTIFF files, byte by byte.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <string>
#include <vector>

namespace delray::tests {

// One channel of 32-bit floats in one strip.
struct GeoTiffFile {
  bool big_endian = false, big_tiff = false;
  int width = 3, height = 2;
  std::vector<float> values = {1, 2, 3, 4, 5, 6};
  std::vector<double> scale{}, tie{};  // tags that are empty are left out
  bool geographic = false, pixel_is_point = false;
  std::string no_data{};

  std::string bytes() const {
    std::vector<Tag> tags = {
        number(256, width), number(257, height), number(258, 32),
        number(259, 1),     number(262, 1),      number(273, 0),
        number(277, 1),     number(278, height), number(279, height * width * 4),
        number(339, 3)};
    if (!scale.empty()) tags.push_back({33550, 12, 3, doubles(scale)});
    if (!tie.empty())
      tags.push_back({33922, 12, static_cast<std::uint32_t>(tie.size()), doubles(tie)});
    if (!tie.empty()) {
      std::string keys;
      for (const int value :
           {1, 1, 0, 2, 1024, 0, 1, geographic ? 2 : 1, 1025, 0, 1, pixel_is_point ? 2 : 1}) {
        put(keys, static_cast<std::uint16_t>(value));
      }
      tags.push_back({34735, 3, 12, keys});
    }
    if (!no_data.empty()) {
      tags.push_back({42113, 2, static_cast<std::uint32_t>(no_data.size() + 1), no_data + '\0'});
    }
    std::string head = big_endian ? "MM" : "II";
    put(head, static_cast<std::uint16_t>(big_tiff ? 43 : 42));
    if (big_tiff) {
      put(head, std::uint16_t{8});
      put(head, std::uint16_t{0});
      put(head, std::uint64_t{16});
      put(head, static_cast<std::uint64_t>(tags.size()));
    } else {
      put(head, std::uint32_t{8});
      put(head, static_cast<std::uint16_t>(tags.size()));
    }
    const std::size_t entry = big_tiff ? 20 : 12, inlined = big_tiff ? 8 : 4;
    std::size_t free = head.size() + tags.size() * entry + inlined;
    const std::size_t strip = free;
    std::string pixels, far;
    for (const float value : values) put(pixels, value);
    free += pixels.size();
    for (const Tag& tag : tags) {
      put(head, tag.number);
      put(head, tag.type);
      put_size(head, tag.count);
      std::string content = tag.content;
      if (tag.number == 273) {
        content.clear();
        put(content, static_cast<std::uint32_t>(strip));
      }
      if (content.size() <= inlined) {
        head += content + std::string(inlined - content.size(), '\0');
      } else {
        put_size(head, free);
        far += content;
        free += content.size();
      }
    }
    put_size(head, 0);
    return head + pixels + far;
  }

 private:
  struct Tag {
    std::uint16_t number, type;
    std::uint32_t count;
    std::string content;
  };

  template <class T>
  void put(std::string& to, T value) const {
    auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
    if (big_endian) std::ranges::reverse(raw);
    to.append(raw.data(), raw.size());
  }
  void put_size(std::string& to, std::size_t value) const {
    if (big_tiff) {
      put(to, static_cast<std::uint64_t>(value));
    } else {
      put(to, static_cast<std::uint32_t>(value));
    }
  }
  std::string doubles(const std::vector<double>& numbers) const {
    std::string result;
    for (const double value : numbers) put(result, value);
    return result;
  }
  Tag number(std::uint16_t tag, int value) const {
    std::string content;
    // 32 bits everywhere but where readers want 16.
    const bool is_short = tag == 258 || tag == 259 || tag == 262 || tag == 277 || tag == 339;
    if (is_short) {
      put(content, static_cast<std::uint16_t>(value));
    } else {
      put(content, static_cast<std::uint32_t>(value));
    }
    return {tag, static_cast<std::uint16_t>(is_short ? 3 : 4), 1, content};
  }
};

}  // namespace delray::tests
