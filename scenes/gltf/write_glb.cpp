// Writes binary glTF in one pass over the scene: JSON and binary data grow side by side and are
// joined behind a header. Instances, lights and cameras are turned to y up, and bright colours are
// divided by a power of two, which keeps all their bits.
#include "scenes/write_glb.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <numbers>
#include <span>
#include <string>
#include <string_view>

#include "files/atomic_file.h"
#include "files/error.h"
#include "geometry/box.h"
#include "image/io.h"
#include "scenes/gltf/gltf_extras.h"
#include "scenes/gltf/write_animation.h"
#include "scenes/gltf/write_material.h"

namespace delray::scenes {
namespace {

using internal::Json;
using internal::json_of;
using internal::power_of_two_above;

constexpr std::uint64_t kLargestFile = 0xFFFFFFFFU;  // sizes in the header have 32 bits
enum : int {
  kFloat = 5126,
  kUnsigned = 5125,
  kShort = 5123,
  kVertexBuffer = 34962,
  kIndexBuffer = 34963
};

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& why) {
  throw files::FileError(files::Cause::device, path.string(), "", why);
}

std::uint64_t least_size(const Scene& scene) {
  std::uint64_t size = 0;
  const auto bytes = [](const auto& values) { return values.size() * sizeof(values[0]); };
  for (const Mesh& m : scene.meshes) {
    size += bytes(m.positions) + bytes(m.normals) + bytes(m.uvs) + bytes(m.uvs2) +
            bytes(m.tangents) + bytes(m.colours) + bytes(m.triangles);
  }
  return size;
}

// glTF is y up: z becomes y, y becomes -z.
glm::vec3 upright(const glm::vec3& v, bool z_up) { return z_up ? glm::vec3(v.x, v.z, -v.y) : v; }

// The document while it grows: JSON and, at 4-byte boundaries, the binary chunk.
class Writer {
 public:
  explicit Writer(const Scene& scene) : scene_(scene) {
    document_["asset"] = {{"version", "2.0"}, {"generator", "delray"}};
    binary_.reserve(least_size(scene) + 4096);
  }

  std::string write() {
    const internal::AccessorWriter accessors = accessor_writer();
    add_textures();
    for (const Material& material : scene_.materials) {
      document_["materials"].push_back(internal::write_material(material, scene_, document_));
    }
    std::vector<const DeformedMesh*> bends(scene_.meshes.size(), nullptr);
    for (const DeformedMesh& deformed : scene_.animations.meshes) bends[deformed.mesh] = &deformed;
    for (std::size_t i = 0; i < bends.size(); ++i) add_mesh(scene_.meshes[i], bends[i], accessors);
    std::vector<std::uint8_t> placed(scene_.instances.size(), 0);
    if (!scene_.animations.empty())
      top_nodes_ = internal::write_nodes(scene_, accessors, document_, placed);
    for (std::size_t i = 0; i < placed.size(); ++i)
      if (placed[i] == 0) add_instance(scene_.instances[i]);
    for (const Light& light : scene_.lights) add_light(light);
    for (const Camera& camera : scene_.cameras) add_camera(camera);
    add_scene();
    return assemble();
  }

 private:
  std::size_t add_view(const void* data, std::size_t size, int target) {
    Json view = {{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", size}};
    if (target != 0) view["target"] = target;
    binary_.append(static_cast<const char*>(data), size);
    binary_.resize((binary_.size() + 3) / 4 * 4, '\0');
    document_["bufferViews"].push_back(std::move(view));
    return document_["bufferViews"].size() - 1;
  }

  template <int N>
  Json add_accessor(std::span<const glm::vec<N, float>> values) {
    static const char* const kTypes[] = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};
    const std::size_t view = add_view(values.data(), values.size_bytes(), kVertexBuffer);
    document_["accessors"].push_back({{"bufferView", view},
                                      {"componentType", static_cast<int>(kFloat)},
                                      {"count", values.size()},
                                      {"type", kTypes[N]}});
    return document_["accessors"].size() - 1;
  }

  Json add_indices(std::span<const glm::uvec3> triangles) {
    const std::size_t view = add_view(triangles.data(), triangles.size_bytes(), kIndexBuffer);
    document_["accessors"].push_back({{"bufferView", view},
                                      {"componentType", static_cast<int>(kUnsigned)},
                                      {"count", triangles.size() * 3},
                                      {"type", "SCALAR"}});
    return document_["accessors"].size() - 1;
  }

  internal::AccessorWriter accessor_writer() {
    const auto add = [this](const void* data, std::size_t bytes, int component, std::size_t count,
                            const char* type) {
      const std::size_t view = add_view(data, bytes, 0);
      document_["accessors"].push_back(
          {{"bufferView", view}, {"componentType", component}, {"count", count}, {"type", type}});
      return Json(document_["accessors"].size() - 1);
    };
    const auto components = [](std::string_view type) -> std::size_t {
      if (type == "MAT4") return 16;
      return type == "SCALAR" ? 1 : static_cast<std::size_t>(type.back() - '0');
    };
    return {[add, components](std::span<const float> values, const char* type) {
              return add(values.data(), values.size_bytes(), kFloat,
                         values.size() / components(type), type);
            },
            [add](std::span<const std::uint16_t> fours) {
              return add(fours.data(), fours.size_bytes(), kShort, fours.size() / 4, "VEC4");
            }};
  }

  // Of a mesh that bends what it is before.
  void add_mesh(const Mesh& posed, const DeformedMesh* deformed,
                const internal::AccessorWriter& accessors) {
    if (deformed == nullptr) return add_mesh(posed, {});
    Mesh mesh = posed;
    mesh.positions = deformed->positions;
    mesh.normals = deformed->normal_groups.empty() ? deformed->normals : std::vector<glm::vec3>();
    mesh.tangents = mesh.normals.empty() ? std::vector<glm::vec4>() : deformed->tangents;
    add_mesh(mesh, [&](Json& primitive) {
      internal::write_deformation(*deformed, accessors, primitive);
    });
  }

  void add_mesh(const Mesh& mesh, const std::function<void(Json&)>& deform) {
    const auto filled = [](const auto& values) { return !values.empty(); };
    Json primitive = {{"attributes", Json::object()}, {"material", mesh.material}};
    if (filled(mesh.positions)) {
      Json& attributes = primitive["attributes"];
      attributes["POSITION"] = add_accessor<3>(mesh.positions);
      geometry::Box3 box;
      for (const glm::vec3& p : mesh.positions) box.include(p);
      Json& accessor = document_["accessors"].back();
      accessor["min"] = json_of(box.low);
      accessor["max"] = json_of(box.high);
      if (filled(mesh.normals)) attributes["NORMAL"] = add_accessor<3>(mesh.normals);
      if (filled(mesh.tangents)) attributes["TANGENT"] = add_accessor<4>(mesh.tangents);
      if (filled(mesh.uvs)) attributes["TEXCOORD_0"] = add_accessor<2>(mesh.uvs);
      if (filled(mesh.uvs2)) attributes["TEXCOORD_1"] = add_accessor<2>(mesh.uvs2);
      if (filled(mesh.colours)) attributes["COLOR_0"] = add_accessor<4>(mesh.colours);
      if (filled(mesh.triangles)) primitive["indices"] = add_indices(mesh.triangles);
      if (deform) deform(primitive);
    }
    Json json = {{"primitives", Json::array({std::move(primitive)})}};
    if (!mesh.name.empty()) json["name"] = mesh.name;
    document_["meshes"].push_back(std::move(json));
  }

  static int wrap_code(Texture::Wrap wrap) {
    if (wrap == Texture::Wrap::clamp) return 33071;
    return wrap == Texture::Wrap::mirror ? 33648 : 10497;
  }

  void add_textures() {
    for (std::size_t i = 0; i < scene_.textures.size(); ++i) {
      const Texture& texture = scene_.textures[i];
      const std::vector<std::byte> png =
          image::encode_png(texture.width, texture.height, texture.texels);
      const std::size_t view = add_view(png.data(), png.size(), 0);
      document_["images"].push_back(
          {{"bufferView", view}, {"mimeType", "image/png"}, {"name", texture.name}});
      document_["samplers"].push_back(
          {{"wrapS", wrap_code(texture.wrap_u)}, {"wrapT", wrap_code(texture.wrap_v)}});
      document_["textures"].push_back({{"source", i}, {"sampler", i}});
    }
  }

  void add_node(Json&& node, const glm::mat4x3& transform) {
    if (transform != glm::mat4x3(1.0F)) {
      Json& matrix = node["matrix"];
      for (int column = 0; column < 4; ++column) {
        const glm::vec3& v = transform[column];
        for (int row = 0; row < 3; ++row) matrix.push_back(v[row]);
        matrix.push_back(column == 3 ? 1 : 0);
      }
    }
    top_nodes_.push_back(document_["nodes"].size());
    document_["nodes"].push_back(std::move(node));
  }

  void add_instance(const Instance& instance) {
    glm::mat4x3 transform;
    for (int k = 0; k < 4; ++k) transform[k] = upright(instance.transform[k], scene_.z_up);
    add_node({{"mesh", instance.mesh}}, transform);
  }

  // The frame of a camera, which looks along -z as lights do.
  glm::mat4x3 frame_of(const Camera& camera) const {
    const View view = make_view(camera, 1, 1);
    return {upright(view.right, scene_.z_up), upright(view.up, scene_.z_up),
            -upright(view.forward, scene_.z_up), upright(view.eye, scene_.z_up)};
  }

  void add_light(const Light& light) {
    if (light.kind == Light::Kind::area) return;  // among the extras
    internal::use_extension("KHR_lights_punctual", document_);
    const bool is_point = light.kind == Light::Kind::point;
    const float brightest = std::max({light.colour.x, light.colour.y, light.colour.z});
    const float intensity = brightest > 0 ? power_of_two_above(brightest) : 1.0F;
    Json& lights = document_["extensions"]["KHR_lights_punctual"]["lights"];
    lights.push_back({{"type", is_point ? "point" : "directional"},
                      {"color", json_of(light.colour / intensity)},
                      {"intensity", intensity}});
    Json node;
    node["extensions"]["KHR_lights_punctual"] = {{"light", lights.size() - 1}};
    Camera towards;
    towards.eye = is_point ? light.position : glm::vec3(0);
    towards.at = is_point ? light.position - glm::vec3(0, 0, 1) : light.direction;
    add_node(std::move(node), frame_of(towards));
  }

  void add_camera(const Camera& camera) {
    const View view = make_view(camera, 1, 1);
    const char* const type = camera.orthographic() ? "orthographic" : "perspective";
    Json lens = {{"znear", view.near}};
    if (camera.orthographic()) {
      lens["xmag"] = lens["ymag"] = camera.height * 0.5F;
      lens["zfar"] = view.far;
    } else {
      lens["yfov"] = static_cast<double>(camera.vertical_fov) * (std::numbers::pi / 180);
    }
    document_["cameras"].push_back({{"type", type}, {type, lens}});
    Json node = {{"camera", document_["cameras"].size() - 1}};
    if (!camera.name.empty()) node["name"] = camera.name;
    add_node(std::move(node), frame_of(camera));
  }

  void add_scene() {
    Scene rest;  // what has no place in glTF proper
    rest.origin = scene_.origin;
    if (scene_.z_up) rest.origin = {rest.origin.x, rest.origin.z, -rest.origin.y};
    rest.environment = scene_.environment;
    rest.environment.up = upright(scene_.environment.up, scene_.z_up);
    for (Light light : scene_.lights) {
      for (glm::vec3* v : {&light.position, &light.edge_u, &light.edge_v}) {
        *v = upright(*v, scene_.z_up);
      }
      rest.lights.push_back(light);
    }
    if (rest.origin != glm::dvec3(0)) {
      const glm::dvec3& o = rest.origin;
      document_["nodes"].push_back({{"translation", {o.x, o.y, o.z}}, {"children", top_nodes_}});
      top_nodes_ = {document_["nodes"].size() - 1};
    }
    Json json = {{"nodes", top_nodes_}};
    if (Json extras = internal::extras_of(rest); !extras.is_null()) json["extras"] = extras;
    document_["scenes"].push_back(std::move(json));
    document_["scene"] = 0;
    if (!binary_.empty()) document_["buffers"].push_back({{"byteLength", binary_.size()}});
  }

  std::string assemble() {
    std::string json = document_.dump(-1, ' ', false, Json::error_handler_t::replace);
    json.resize((json.size() + 3) / 4 * 4, ' ');
    std::string file;
    const auto add_word = [&file](std::uint64_t word) {
      const auto narrow = static_cast<std::uint32_t>(word);
      file.append(reinterpret_cast<const char*>(&narrow), sizeof narrow);
    };
    const std::uint64_t binary_part = binary_.empty() ? 0 : 8 + binary_.size();
    const std::uint64_t length = 12 + 8 + json.size() + binary_part;
    if (length > kLargestFile) return {};
    file.reserve(length);
    file += "glTF";
    add_word(2);
    add_word(length);
    add_word(json.size());
    file += "JSON";
    file += json;
    if (binary_.empty()) return file;
    add_word(binary_.size());
    file.append("BIN\0", 4);
    file += binary_;
    return file;
  }

  const Scene& scene_;
  Json document_;
  std::string binary_;
  std::vector<std::size_t> top_nodes_;
};

}  // namespace

void write_glb(const std::filesystem::path& path, const Scene& scene) {
  const std::string too_large = "a GLB file cannot be larger than 4 GiB";
  if (least_size(scene) > kLargestFile) refuse(path, too_large);
  const std::string file = Writer(scene).write();
  if (file.empty()) refuse(path, too_large);
  files::write_file(path, file);
}

}  // namespace delray::scenes
