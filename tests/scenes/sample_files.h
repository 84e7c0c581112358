// Small files of every format, as text.
#pragma once

#include <cstring>
#include <string>
#include <vector>

namespace delray::scenes {

struct SampleFile {
  std::string name, content;
  std::size_t triangles;
};

template <class T>
void append(std::string& bytes, T value, bool swap = false) {
  std::string raw(reinterpret_cast<const char*>(&value), sizeof value);
  if (swap) raw.assign(raw.rbegin(), raw.rend());
  bytes += raw;
}

// A square of two triangles and a third one above it, in every format.
inline std::string sample_obj() {
  return "mtllib sample.mtl\no thing\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\n"
         "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl red\nf 1/1 2/2 3/3 4/4\nusemtl grey\nf -5 -4 -1\n";
}

inline std::string sample_ply_text() {
  return "ply\nformat ascii 1.0\ncomment made by hand\nelement vertex 5\nproperty float x\n"
         "property float y\nproperty float z\nproperty uchar red\nproperty uchar green\n"
         "property uchar blue\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n"
         "0 0 0 255 0 0\n1 0 0 0 255 0\n1 1 0 0 0 255\n0 1 0 255 255 255\n0 0 1 0 0 0\n"
         "4 0 1 2 3\n3 0 1 4\n";
}

inline std::string sample_ply_binary(bool big_endian) {
  std::string ply = std::string("ply\nformat binary_") + (big_endian ? "big" : "little") +
                    "_endian 1.0\nelement vertex 5\nproperty float x\nproperty float y\n"
                    "property float z\nelement face 3\nproperty list uchar int vertex_indices\n"
                    "end_header\n";
  const float positions[] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 0, 1};
  const int triangles[] = {0, 1, 2, 0, 2, 3, 0, 1, 4};
  for (const float x : positions) append(ply, x, big_endian);
  for (int i = 0; i < 9; ++i) {
    if (i % 3 == 0) ply.push_back(3);
    append(ply, triangles[i], big_endian);
  }
  return ply;
}

inline std::string sample_off() {
  return "OFF\n# a comment\n5 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n4 0 1 2 3\n3 0 1 4\n";
}

inline std::string sample_stl_text() {
  const char* const facets[] = {"0 0 0\nvertex 1 0 0\nvertex 1 1 0",
                                "0 0 0\nvertex 1 1 0\nvertex 0 1 0",
                                "0 0 0\nvertex 1 0 0\nvertex 0 0 1"};
  std::string stl = "solid thing\n";
  for (const char* facet : facets) {
    stl += std::string("facet normal 0 0 1\nouter loop\nvertex ") + facet + "\nendloop\nendfacet\n";
  }
  return stl + "endsolid thing\n";
}

inline std::string sample_stl_binary() {
  std::string stl(80, ' ');
  append(stl, std::uint32_t{3});
  const float corners[3][9] = {
      {0, 0, 0, 1, 0, 0, 1, 1, 0}, {0, 0, 0, 1, 1, 0, 0, 1, 0}, {0, 0, 0, 1, 0, 0, 0, 0, 1}};
  for (const auto& triangle : corners) {
    for (int i = 0; i < 3; ++i) append(stl, 0.0F);
    for (const float x : triangle) append(stl, x);
    append(stl, std::uint16_t{0});
  }
  return stl;
}

inline std::string base64(const std::string& bytes) {
  static const char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      bits = bits << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += i + k > bytes.size() ? '=' : kDigits[bits >> (18 - 6 * k) & 63];
    }
  }
  return text;
}

// The same three triangles with 16-bit indices, the buffer as a data URI.
inline std::string sample_gltf() {
  std::string bytes;
  for (const float x : {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 0, 1}) append(bytes, x);
  for (const int i : {0, 1, 2, 0, 2, 3, 0, 1, 4}) append(bytes, static_cast<std::uint16_t>(i));
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
"nodes":[{"mesh":0,"translation":[1,2,3],"children":[1]},{"mesh":0,"scale":[2,2,2]}],
"meshes":[{"name":"thing","primitives":[{"attributes":{"POSITION":0},"indices":1,"material":0}]}],
"materials":[{"name":"red","pbrMetallicRoughness":{"baseColorFactor":[1,0,0,1],"metallicFactor":0}}],
"accessors":[{"bufferView":0,"componentType":5126,"count":5,"type":"VEC3"},
{"bufferView":1,"componentType":5123,"count":9,"type":"SCALAR"}],
"bufferViews":[{"buffer":0,"byteLength":60},{"buffer":0,"byteOffset":60,"byteLength":18}],
"buffers":[{"byteLength":78,"uri":"data:application/octet-stream;base64,)" +
         base64(bytes) + "\"}]}";
}

inline std::vector<SampleFile> sample_files() {
  return {{"sample.obj", sample_obj(), 3},
          {"text.ply", sample_ply_text(), 3},
          {"little.ply", sample_ply_binary(false), 3},
          {"big.ply", sample_ply_binary(true), 3},
          {"sample.off", sample_off(), 3},
          {"text.stl", sample_stl_text(), 3},
          {"binary.stl", sample_stl_binary(), 3},
          {"sample.gltf", sample_gltf(), 6}};
}

}  // namespace delray::scenes
