// Files of points for the tests of their readers.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>

#include "delaunay/read_points.h"
#include "files/error.h"
#include "tests/support/temporary_folder.h"

namespace delray::tests {

// Writes a file of that name and reads its points.
inline delaunay::PointCloud points_in(const std::string& name, const std::string& content) {
  const tests::TemporaryFolder folder;
  return delaunay::read_points(folder.write(name, content));
}

// Reads a broken file; the message must name the file.
inline std::string complaint_about_points(const std::string& name, const std::string& content) {
  try {
    points_in(name, content);
  } catch (const files::FileError& error) {
    EXPECT_EQ(error.cause(), files::Cause::input);
    EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
    return error.what();
  }
  ADD_FAILURE() << "no error from " << name << ": " << content.substr(0, 200);
  return "";
}

template <class T>
void append_bytes(std::string& bytes, T value, bool big_endian = false) {
  auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
  if (big_endian) std::ranges::reverse(raw);
  bytes.append(raw.data(), raw.size());
}

// A PLY with properties of all kinds, a list before the coordinates and an element before the
// vertices.
inline std::string ply_of_points(const char* encoding, bool lists) {
  std::string text = std::string("ply\nformat ") + encoding +
                     " 1.0\ncomment c\nelement camera 2\nproperty list uchar short a\n"
                     "property char b\nelement vertex 3\nproperty uchar blue\n";
  if (lists) text += "property list ushort int skipped\n";
  text +=
      "property float z\nproperty double x\nproperty int16 y\nproperty uchar red\n"
      "property uchar green\nproperty ushort intensity\nelement face 1\n"
      "property list uchar uint vertex_indices\nend_header\n";
  if (std::strcmp(encoding, "ascii") == 0) {
    text += "2 -1 -2 5\n0 7\n";
    for (int i = 0; i < 3; ++i) {
      const std::string n = std::to_string(i);
      text += n + (lists ? (i == 1 ? " 2 100000 -5 " : " 0 ") : " ") + "0.5 0.1 -" + n +
              " 254 7 65535\n";
    }
    return text + "3 0 1 2\n";
  }
  const bool big = std::strcmp(encoding, "binary_big_endian") == 0;
  append_bytes(text, std::uint8_t{2});
  append_bytes(text, std::int16_t{-1}, big);
  append_bytes(text, std::int16_t{-2}, big);
  append_bytes(text, std::int8_t{5});
  append_bytes(text, std::uint8_t{0});
  append_bytes(text, std::int8_t{7});
  for (int i = 0; i < 3; ++i) {
    append_bytes(text, static_cast<std::uint8_t>(i));
    if (lists) {
      append_bytes(text, static_cast<std::uint16_t>(i == 1 ? 2 : 0), big);
      for (int k = 0; i == 1 && k < 2; ++k) append_bytes(text, std::int32_t{100000}, big);
    }
    append_bytes(text, 0.5F, big);
    append_bytes(text, 0.1, big);
    append_bytes(text, static_cast<std::int16_t>(-i), big);
    append_bytes(text, std::uint8_t{254});
    append_bytes(text, std::uint8_t{7});
    append_bytes(text, std::uint16_t{65535}, big);
  }
  append_bytes(text, std::uint8_t{3});
  for (std::uint32_t i = 0; i < 3; ++i) append_bytes(text, i, big);
  return text;
}

// A LAS file of two points.
inline std::string las_of_points(int minor, unsigned format, std::size_t record,
                                 std::size_t colour) {
  std::string bytes(minor == 4 ? 375 : 227, '\0');
  const auto put = [&](std::size_t at, auto value) {
    std::memcpy(&bytes[at], &value, sizeof value);
  };
  bytes.replace(0, 4, "LASF");
  put(24, std::uint8_t{1});
  put(25, static_cast<std::uint8_t>(minor));
  put(94, static_cast<std::uint16_t>(bytes.size()));
  put(96, static_cast<std::uint32_t>(bytes.size()));
  put(104, static_cast<std::uint8_t>(format));
  put(105, static_cast<std::uint16_t>(record));
  if (minor == 4) {
    put(247, std::uint64_t{2});
  } else {
    put(107, std::uint32_t{2});
  }
  for (int k = 0; k < 3; ++k) {
    put(131 + 8 * k, 0.25);
    put(155 + 8 * k, 1000.0 * k);
  }
  for (int i = 0; i < 2; ++i) {
    std::string row(record, '\x7e');
    const auto put_row = [&](std::size_t at, auto value) {
      std::memcpy(&row[at], &value, sizeof value);
    };
    for (int k = 0; k < 3; ++k) put_row(4 * k, std::int32_t{-8 + 4 * i + k});
    put_row(12, static_cast<std::uint16_t>(65535 * i));
    put_row(format < 6 ? 15 : 16, static_cast<std::uint8_t>(format < 6 ? 0xe0 | 6 : 66));
    for (int k = 0; colour > 0 && k < 3; ++k) {
      put_row(colour + 2 * k, static_cast<std::uint16_t>(257 * (k + 1) * (i == 1 ? 80 : 1)));
    }
    bytes += row;
  }
  return bytes;
}

}  // namespace delray::tests
